"""Declaring, reading and refusing parameters."""

from __future__ import annotations

import json
import math
import re
from fractions import Fraction
from typing import Any, Literal

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from sandbox import units
from sandbox.errors import RequestError
from sandbox.parameters import (
    Accuracy,
    Group,
    Quantity,
    choice,
    every_key,
    group,
    groups,
    known_keys,
    merged,
    one_of,
    parse_assignment,
    quantity,
    switch,
    text,
    validate,
    vector,
    vectors,
    walk,
)
from sandbox.schema import json_schema
from sandbox.toml import read_toml


class Throw(Group):
    speed: float = quantity(76.44, "m/s", low=0, high=340, meaning="ball speed after impact")
    angle: float = quantity("0.2 rad", "deg", low=-90, high=180, meaning="above the horizontal")
    spin: float = quantity(2545, "rpm", low=-20000, high=20000, meaning="backspin")


class NoDrag(Group):
    model: Literal["none"] = choice("none", "no drag")


class ConstantDrag(Group):
    model: Literal["constant"] = choice("constant", "one number")
    coefficient: float = quantity(0.25, "", low=0, high=5, meaning="drag coefficient")
    velocity: Literal["air", "ground"] = choice("air", "relative to which the ball moves")


class FittedDrag(Group):
    model: Literal["fitted", "table"] = choice("fitted", "a curve")
    critical: float = quantity(1e5, "", low=0, high=1e7, meaning="critical Reynolds number")
    velocity: Literal["air", "ground"] = choice("air", "relative to which the ball moves")


class Ball(Group):
    mass: float = quantity(1.0, "kg", low=1e-6, high=100, meaning="mass")
    radius: float = quantity(0.1, "m", low=1e-6, high=1, meaning="radius")
    drag: NoDrag | ConstantDrag | FittedDrag = one_of(FittedDrag(), "drag of the air")


class Air(Group):
    temperature: float = quantity(20, "C", low=-90, high=60, meaning="of the air")
    wind: tuple[float, float] = vector((0.0, 0.0), "m/s", low=-100, high=100, meaning="along x and y")


class Place(Group):
    name: str = text("whose place it is")
    x: float = quantity(0.0, "m", low=0, high=1, meaning="along the table")


class Parameters(Group):
    gravity: float = quantity(9.81, "m/s^2", low=0, high=30, meaning="downwards")
    launch: Throw = group(Throw(), "how the ball starts")
    ball: Ball = group(Ball(mass=0.0459, drag=FittedDrag(critical=6e4)), "the ball")
    air: Air = group(Air(), "the air")
    holed: bool = switch(True, "whether there is a cup")
    balls: list[Place] = groups([], "where the balls lie")
    heights: list[tuple[float, float]] = vectors([], 2, "m", low=-1e3, high=1e3, meaning="of the ground")
    accuracy: Accuracy = group(Accuracy(), "speed against accuracy")


def refusal(values: dict[str, Any], **changes: Any) -> str:
    with pytest.raises(RequestError) as refused:
        validate(Parameters, values, "shot.toml", {k.replace("__", "."): v for k, v in changes.items()}, "--set")
    return str(refused.value)


def speed(value: Any) -> float:
    return validate(Parameters, {"launch": {"speed": value}}).launch.speed


# Values -------------------------------------------------------------------------------------------------------------


def test_what_a_file_leaves_out_takes_the_default_of_the_scene():
    parameters = validate(Parameters, {"ball": {"radius": 0.02}})
    assert parameters.ball.radius == 0.02
    assert parameters.ball.mass == 0.0459  # of the scene, not the 1.0 of the group Ball on its own
    assert parameters.ball.drag == FittedDrag(critical=6e4)
    assert validate(Parameters, {}) == Parameters()


class OwnBall(Group):
    shape: Literal["round", "long"] = choice(..., "seen from the side")
    drag: NoDrag | FittedDrag = one_of(FittedDrag(critical=6e4), "drag of the air")


class Needs(Group):
    ball: OwnBall = group(..., "the ball")
    place: Place = group(..., "where it lies")


def test_a_group_that_must_be_there_has_defaults_inside():
    found = validate(Needs, {"ball": {"shape": "long", "drag": {"model": "table"}}, "place": {"name": "a"}})
    assert found.ball.drag == FittedDrag(model="table", critical=6e4)
    with pytest.raises(RequestError, match=r"place\.name: missing"):
        validate(Needs, {"ball": {"shape": "long"}}, "shot.toml")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("171 mph", 171 * 0.44704),
        ("171mph", 171 * 0.44704),
        ("  1.71e2   mph ", 171 * 0.44704),
        ("100 km/h", 100 / 3.6),
        ("10 kn", 10 * 1852 / 3600),
        ("100 ft/s", 30.48),
        ("+70 m/s", 70.0),
        (".5 m/s", 0.5),
        ("70", 70.0),
    ],
)
def test_a_string_may_carry_its_own_unit(text: str, expected: float):
    assert speed(text) == pytest.approx(expected, rel=1e-13)


@pytest.mark.parametrize(
    ("text", "unit", "expected"),
    [
        ("275 yd", "m", 251.46),
        ("6 ft", "m", 1.8288),
        ("4.25 in", "m", 0.10795),
        ("300 rad/s", "rpm", 300 * 30 / math.pi),
        ("1 rev/s", "rpm", 60),
        ("360 deg/s", "rpm", 60),
        ("1 g0", "m/s^2", 9.80665),
        ("9.81 m/s²", "m/s^2", 9.81),
        ("1.2 kg/m³", "kg/m^3", 1.2),
        ("10 °", "deg", 10),
        ("20 °C", "K", 293.15),
        ("70 F", "C", (70 - 32) / 1.8),
        ("-40 F", "C", -40),
        ("1.62 oz", "kg", 0.04592623),
        ("80 %", "", 0.8),
        ("14.32 cm^2", "m^2", 0.001432),
        ("1013.25 hPa", "Pa", 101325),
    ],
)
def test_units(text: str, unit: str, expected: float):
    assert units.parse(text, unit) == pytest.approx(expected, rel=1e-7, abs=1e-9)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("60,5 m/s", "has a decimal comma; write 60.5 m/s"),
        ("-60,5", "has a decimal comma; write -60.5"),
        ("1.234,5 m/s", "has a decimal comma; write 1234.5 m/s"),
        ("2,545 m/s", "has a decimal comma; write 2.545 m/s or 2545 m/s"),
        ("0,545", "has a decimal comma; write 0.545"),
        ("1,234.5", "has commas; write 1234.5"),
        ("1,234,567", "has commas; write 1234567"),
    ],
)
def test_a_decimal_comma_is_named_with_what_to_write(text: str, said: str):
    with pytest.raises(ValueError, match=f"^{re.escape(said)}$"):
        units.parse(text, "m/s")


def test_a_bound_may_be_given_in_another_unit():
    """140 F is 60 C exactly; rounding must not push it over the bound."""
    assert speed("1224 km/h") == 340.0
    assert validate(Parameters, {"air": {"temperature": "140 F"}}).air.temperature == 60.0


@given(
    number=st.floats(-1e6, 1e6),
    units_of_kind=st.sampled_from(list(units.KINDS.values())).flatmap(
        lambda kind: st.tuples(st.sampled_from(list(kind)), st.sampled_from(list(kind)))
    ),
)
def test_there_and_back(number: float, units_of_kind: tuple[str, str]):
    one, other = units_of_kind
    assert units.convert(units.convert(number, one, other), other, one) == pytest.approx(number, rel=1e-9, abs=1e-8)


@given(st.floats(0, 340))
def test_numbers_within_the_bounds_pass_unchanged(number: float):
    assert speed(number) == number


@given(
    st.one_of(st.floats(max_value=0, exclude_max=True), st.floats(min_value=340, exclude_min=True), st.just(math.nan))
)
def test_numbers_beyond_the_bounds_never_pass(number: float):
    with pytest.raises(RequestError):
        speed(number)


@pytest.mark.parametrize("value", [0, 340, Fraction(1, 2), 70])
def test_bounds_are_inclusive_and_integers_become_floats(value: Any):
    assert type(speed(value)) is float
    assert speed(value) == value


def test_vectors():
    def wind(value: Any) -> tuple[float, float]:
        return validate(Parameters, {"air": {"wind": value}}).air.wind

    assert wind([-3, "10 mph"]) == (-3.0, 4.4704)
    assert wind((1.0, 2.0)) == (1.0, 2.0)
    assert validate(Parameters, {"heights": [[0, "1 ft"], [5, 2]]}).heights == [(0.0, 0.3048), (5.0, 2.0)]


def test_groups_are_frozen_and_their_defaults_are_checked():
    with pytest.raises(ValidationError):
        Parameters().gravity = 3.0

    class Wrong(Group):
        speed: float = quantity(400.0, "m/s", low=0, high=340, meaning="too fast")

    with pytest.raises(ValidationError):
        Wrong()


def test_unknown_units_and_reversed_bounds_are_scene_errors():
    with pytest.raises(ValueError, match='"furlong" is not a known unit: use one of m, cm'):
        quantity(1.0, "furlong", low=0, high=1, meaning="")
    with pytest.raises(ValueError, match="the lowest value, 1, is above the highest, -1"):
        quantity(..., "m", low=1, high=-1, meaning="")


# Refusals -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (400, "shot.toml: launch.speed = 400: must be from 0 to 340 m/s"),
        (-1e-9, "shot.toml: launch.speed = -1e-09: must be from 0 to 340 m/s"),
        ("900 mph", 'shot.toml: launch.speed = "900 mph": must be from 0 to 340 m/s, and this is 402.336 m/s'),
        ("70 kg", 'shot.toml: launch.speed = "70 kg": kg is a unit of mass; use m/s, km/h, mph, kn or ft/s'),
        ("70 mp/h", "mp/h is not a known unit; use m/s, km/h, mph, kn or ft/s"),
        ("fast", "is not a number with a unit; use m/s, km/h, mph, kn or ft/s"),
        ("", "is not a number with a unit"),
        (math.nan, "shot.toml: launch.speed = nan: must be a finite number from 0 to 340 m/s"),
        (math.inf, "launch.speed = inf: must be a finite number"),
        ("nan", "must be a finite number"),
        ("1e999 mph", "must be a finite number"),
        (10**400, "must be a finite number"),
        (True, "launch.speed = true: must be a number from 0 to 340 m/s"),
        ([70], "must be a number"),
        ({"value": 70}, "must be a number"),
        (None, "must be a number"),
    ],
)
def test_a_bad_number_names_file_key_value_bound_and_unit(value: Any, expected: str):
    assert expected in refusal({"launch": {"speed": value}})


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        # an unknown key: with the nearest one
        ({"launch": {"sped": 1}}, "shot.toml: launch.sped: unknown key; did you mean launch.speed?"),
        ({"lunch": {"speed": 1}}, "shot.toml: lunch: unknown key; did you mean launch?"),
        ({"speed": 1}, "shot.toml: speed: unknown key; did you mean launch.speed?"),
        ({"ball": {"temperature": 1}}, "ball.temperature: unknown key; did you mean air.temperature?"),
        ({"qqqqqq": 1}, "qqqqqq: unknown key; the scene has gravity, launch, ball, air, holed, balls, heights, accur"),
        ({"ball": {"drag": {"qqq": 1}}}, "ball.drag.qqq: unknown key; ball.drag has model, critical, velocity"),
        (
            {"ball": {"drag": {"coefficient": 1}}},
            'coefficient: unknown key here; it belongs to ball.drag.model = "con',
        ),
        ({"balls": [{"nam": "one"}]}, "balls[0].nam: unknown key; did you mean balls[0].name?"),
        ({"balls": [{"name": "one", "y": 0}]}, "balls[0].y: unknown key; balls has name, x"),
        # a value of the wrong kind
        ({"launch": 3}, "launch = 3: must be a group of keys, not a single value"),
        ({"ball": {"drag": 3}}, "ball.drag = 3: must be a group of keys"),
        ({"accuracy": "fast"}, 'not a single value; did you mean accuracy.level = "fast"?'),
        ({"ball": {"drag": {"model": "ideal"}}}, 'ball.drag.model = "ideal": must be "none", "constant", "fitted" or'),
        ({"balls": [{"name": ""}]}, 'balls[0].name = "": must have at least 1 character'),
        ({"ball": {"drag": {"velocity": "water"}}}, 'ball.drag.velocity = "water": must be "air" or "ground"'),
        ({"air": {"wind": 3}}, "air.wind = 3: must be a list of 2 numbers, each from -100 to 100 m/s"),
        ({"air": {"wind": [1]}}, "air.wind = [1]: must be a list of 2 numbers"),
        ({"air": {"wind": "westerly"}}, "must be a list of 2 numbers"),
        ({"air": {"wind": [1, "5 kg"]}}, "kg is a unit of mass"),
        ({"air": {"wind": [1, math.nan]}}, "must be a finite number"),
        ({"heights": 3}, "heights = 3: must be a list such as [[0.0, 0.0], [1.0, 1.0]]"),
        ({"heights": [[0, 1], [1]]}, "heights = [[0, 1], [1]]: [1]: must be a list of 2 numbers, each from -1000"),
        ({"heights": [[0, math.nan]]}, "must be a finite number"),
        ({"holed": 1}, "holed = 1: must be true or false"),
        ({"holed": "yes"}, "must be true or false"),
        ({"balls": 4}, "balls = 4: must be a list"),
        ({"balls": [4]}, "balls[0] = 4: must be a group of keys"),
        ({"balls": [{"x": 0.5}]}, "balls[0].name: missing"),
        ({"balls": [{"name": "a"}, {"name": "b", "x": 3}]}, "balls[1].x = 3: must be from 0 to 1 m"),
        ({"balls": [{"name": 3}]}, "balls[0].name = 3: must be text in quotes"),
        ({"accuracy": {"level": "best"}}, 'accuracy.level = "best": must be "fast", "balanced" or "precise"'),
        ({"accuracy": {"integrator": "rk5"}}, 'accuracy.integrator = "rk5": must be "explicit-euler"'),
    ],
)
def test_unknown_keys_and_values_of_the_wrong_kind_are_refused(values: dict[str, Any], expected: str):
    assert expected in refusal(values)


def test_a_refusal_names_where_the_value_came_from():
    values = {"launch": {"speed": 400}}
    assert refusal(values, launch__angle=5).startswith("shot.toml: launch.speed")
    assert refusal(values, launch__speed=500).startswith("--set launch.speed = 500")
    assert refusal({}, balls=[{"x": 0}]).startswith("--set balls[0].name: missing")


def test_several_mistakes_take_two_lines():
    message = refusal({"gravity": 99, "holed": 3, "launch": {"speed": 400, "sped": 3}})
    assert message.splitlines() == [
        "shot.toml: gravity = 99: must be from 0 to 30 m/s^2",
        "(and 3 more: shot.toml: launch.speed = 400: must be from 0 to 340 m/s, ...)",
    ]


def test_a_long_value_is_shortened():
    assert all(len(line) < 200 for line in refusal({"launch": {"speed": list(range(1000))}}).splitlines())


# Choosing between groups --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("keys", "expected"),
    [
        ({"velocity": "ground"}, FittedDrag(critical=6e4, velocity="ground")),  # without a word: for the default
        ({"model": "constant"}, ConstantDrag()),  # another group has its own defaults
        ({"model": "table"}, FittedDrag(model="table", critical=6e4)),  # the same group keeps those of the scene
    ],
)
def test_a_choice_starts_from_its_defaults(keys: dict[str, Any], expected: Group):
    assert validate(Parameters, {"ball": {"drag": keys}}).ball.drag == expected


def test_a_changed_choice_drops_keys_of_the_old_one():
    in_file = {"ball": {"drag": {"model": "fitted", "critical": 5e4, "velocity": "ground"}}}
    changed = validate(Parameters, in_file, changes={"ball.drag.model": "constant", "ball.drag.coefficient": 0.3})
    assert changed.ball.drag == ConstantDrag(coefficient=0.3, velocity="ground")
    assert "critical: unknown key here" in refusal(in_file, ball__drag__model="constant", ball__drag__critical=3)


# Reading ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a.b=1", ("a.b", 1)),
        ("a.b = 1.5 ", ("a.b", 1.5)),
        ("a=true", ("a", True)),
        ('a="x y"', ("a", "x y")),
        ("a=[1, 2]", ("a", [1, 2])),
        ("a={b = 1}", ("a", {"b": 1})),
        ("launch.speed=171 mph", ("launch.speed", "171 mph")),
        ("ball.drag.model=constant", ("ball.drag.model", "constant")),
        ("a=", ("a", "")),
        ("a=b=c", ("a", "b=c")),
        ("a=1\nb=2", ("a", "1\nb=2")),
        ("a=" + "[" * 9999, ("a", "[" * 9999)),
        ("a=" + "9" * 9999, ("a", "9" * 9999)),
    ],
)
def test_assignments(text: str, expected: tuple[str, Any]):
    assert parse_assignment(text) == expected


@pytest.mark.parametrize("text", ["a", "", "=3", ".a=3", "a..b=3", "a.=3"])
def test_what_is_no_assignment_is_refused(text: str):
    with pytest.raises(RequestError, match=r"write it as key\.path=value"):
        parse_assignment(text)


def test_tables_are_merged_and_all_else_is_replaced():
    base = {"a": {"b": 1, "c": [1, 2, 3]}, "d": 4}
    assert merged(base, {"a": {"c": [9]}}) == {"a": {"b": 1, "c": [9]}, "d": 4}
    assert base["a"]["c"] == [1, 2, 3]


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        (b"speed = = 3", "broken TOML"),
        (b"[launch]\nspeed = 1\nspeed = 2\n", r"broken TOML: .*line 3"),
        (b"\xff\xfe\x00", "not a text file in UTF-8"),
        (b"a = " + b"[" * 5000, "lists or tables are nested too deeply"),
        (b"a = " + b"9" * 9999, "a number in it has 9,999 digits, too many"),
    ],
)
def test_a_broken_file_is_refused(tmp_path, content: bytes, expected: str):
    file = tmp_path / "shot.toml"
    file.write_bytes(content)
    with pytest.raises(RequestError, match=expected) as refused:
        read_toml(file)
    assert str(refused.value).startswith(str(file))
    assert len(str(refused.value).splitlines()) == 1


def test_byte_order_marks_are_read_and_unreadable_files_refused(tmp_path):
    (tmp_path / "shot.toml").write_bytes(b"\xef\xbb\xbfgravity = 3")
    assert read_toml(tmp_path / "shot.toml") == {"gravity": 3}
    with pytest.raises(RequestError, match="no such file"):
        read_toml(tmp_path / "none.toml")
    with pytest.raises(RequestError, match="is a folder"):
        read_toml(tmp_path)


# Looking ------------------------------------------------------------------------------------------------------------


def test_walk_gives_each_parameter_with_its_declaration():
    found = {parameter.key: parameter for parameter in walk(Parameters())}
    assert found["launch.speed"][1:] == (76.44, "m/s", 0.0, 340.0, (), "ball speed after impact", False)
    assert found["air.wind"].value == (0.0, 0.0)
    assert found["ball.drag.velocity"].choices == ("air", "ground")
    assert "ball.drag.critical" in found
    assert "ball.drag.coefficient" not in found
    assert found["accuracy.method"].choices == ("exact", "plain")
    assert found["accuracy.method"].optional
    assert set(found) <= set(known_keys(Parameters))


def test_every_key_is_one_that_some_choice_has_and_no_group():
    keys = list(every_key(Parameters))
    assert {"gravity", "ball.drag.coefficient", "ball.drag.critical", "air.wind", "balls"} <= set(keys)
    assert not {"ball", "ball.drag", "balls.x", "ball.drag.spin"} & set(keys)


def _properties(schema: dict[str, Any], *path: str) -> dict[str, Any]:
    node = schema
    for part in path:
        node = node["properties"][part]
        if "$ref" in node:
            node = schema["$defs"][node["$ref"].rpartition("/")[2]]
    return node


def test_json_schema():
    schema = json_schema(Parameters(), "shot")
    assert json.loads(json.dumps(schema)) == schema
    assert schema["$schema"] == "http://json-schema.org/draft-07/schema#"
    assert {"const": "shot"} in schema["properties"]["scene"]["anyOf"]
    assert schema["additionalProperties"] is False
    launch = _properties(schema, "launch", "speed")
    assert launch["anyOf"][0] == {"type": "number", "minimum": 0.0, "maximum": 340.0}
    assert launch["anyOf"][1]["type"] == "string"
    assert launch["unit"] == "m/s"
    assert "ball speed after impact" in launch["description"]
    wind = _properties(schema, "air", "wind")
    assert (wind["type"], wind["minItems"], wind["maxItems"]) == ("array", 2, 2)
    assert len(_properties(schema, "ball", "drag")["anyOf"]) == 3


@given(st.floats(0, 340).map(lambda x: f"{x!r} m/s"))
def test_the_schema_accepts_the_strings_that_are_accepted(text: str):
    import re

    schema: dict[str, Any] = {}
    Quantity("m/s", 0, 340)(schema)
    assert re.search(schema["anyOf"][1]["pattern"], text)
    speed(text)
