"""What holds in every scene: parameters have an effect, controls move the shot, cards and pictures show the run."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import suppress
from itertools import islice
from typing import Any

import pytest

from sandbox import units
from sandbox.engine.model.setup import Setup
from sandbox.errors import SandboxError
from sandbox.parameters import Parameter, value_at, walk
from sandbox.scene import Scene, listings, load
from sandbox.sport.amounts import shown_in
from sandbox.sport.facts import Fact
from tests.scenes.play import run_of

NAMES = [listing.name for listing in listings()]
SCENES = [name for name in NAMES if "/" not in name]

#: With what some others have an effect.
NEEDS: dict[str, dict[str, Any]] = {
    "billiards": {"rack": "nine-ball", "rack_scatter": 0.0002},
    "golf": {"air.gusts": 2.0},
    "soccer": {"air.gusts": 2.0},
}

#: Parameters that change only what a scene looks like.
LOOKS = {"tennis": "court.surface"}


def other_values(parameter: Parameter) -> Iterator[Any]:
    """Other values that a file may give: near by, then far."""
    value, (low, high) = parameter.value, parameter.bounds
    if isinstance(value, bool):
        yield not value
    elif parameter.choices:
        yield from (word for word in parameter.choices if word != value)
    elif parameter.unit is not None and not isinstance(value, list | tuple):
        low, high = max(low, -100.0), min(high, 100.0)
        near = () if value is None else (value + 1,) if isinstance(value, int) else (1.01 * value, value + 0.01)
        yield from (number for number in (*near, *(low + share * (high - low) for share in (0.1, 0.3, 0.9))))


def moved(scene: Scene, parameter: Parameter) -> Iterator[Scene]:
    """The scene with other values of a parameter, as far as they are valid."""
    for value in islice(other_values(parameter), None if scene.preset is None else 2):
        with suppress(SandboxError):
            yield scene.changed({parameter.key: value})


def key_of(parameter: Parameter) -> str:
    """Its key; one for the entries of a list."""
    return re.sub(r"\[\d+\]", "[*]", parameter.key)


def starts(name: str) -> Iterator[Scene]:
    """The scene, as a pull begins it too, and its presets."""
    scene = load(name)
    yield from (scene, scene.changed(scene.controls.set_on_pull | NEEDS.get(name, {})))
    yield from (load(preset) for preset in NAMES if preset.startswith(f"{name}/"))


def changes_setup(scene: Scene, setup: Setup, parameter: Parameter) -> bool:
    """True if another value makes another setup, or if each is refused as it needs more."""
    changed = list(moved(scene, parameter))
    for each in changed:
        with suppress(SandboxError):
            if each.build() != setup:
                return True
    return not changed


def without_effect(name: str) -> set[str]:
    """The parameters that change no setup, of the scene or a preset, and no fact of a run."""
    own = load(name)
    lost = {
        key_of(each): each.value
        for each in walk(own.parameters, entries=True)
        if not each.key.startswith("accuracy.") and any(True for _ in other_values(each))
    }
    if name in LOOKS:
        del lost[LOOKS[name]]
    for scatter in own.controls.spread:
        lost.pop(scatter.sd, None)  # of a player
    for scene in starts(name):
        setup = scene.build()
        for parameter in walk(scene.parameters, entries=True):
            key = key_of(parameter)
            if key in lost and changes_setup(scene, setup, parameter):
                lost.pop(key, None)
    likely = [each for each in starts(name) if any(value_at(each.parameters, key) != lost[key] for key in lost)]
    for scene in (own, *likely, *starts(name)):
        if not lost:
            break
        run = run_of(scene.title)
        for parameter in walk(scene.parameters, entries=True):
            key = key_of(parameter)
            if key in lost and any(changed.result(run) != run.result for changed in moved(scene, parameter)):
                del lost[key]
    return set(lost)


@pytest.mark.parametrize("name", SCENES)
def test_every_parameter_has_an_effect(name: str):
    """Nothing that a file sets is lost: no surface, no force, no part of the rules."""
    assert without_effect(name) == set()


@pytest.mark.parametrize("name", SCENES)
def test_controls_are_within_what_a_file_may_set(name: str):
    """What is pulled, scrolled and dragged."""
    scene = load(name)
    controls = scene.controls
    parameters = {each.key: each for each in walk(scene.parameters, entries=True)}
    low, high = parameters[controls.speed].bounds
    assert low <= controls.softest * controls.full_pull_speed < controls.full_pull_speed <= high
    assert parameters[controls.angle].unit == "deg"
    for spin in controls.spins:
        low, high = parameters[spin.key].bounds
        assert 0.0 < spin.step < 0.1 * (high - low)
    for handle in controls.handles:
        assert handle.x or handle.y
        for key in filter(None, (handle.x, handle.y, *handle.with_y)):
            assert key.startswith("air.wind") or "[*]" in key or parameters[key].unit == "m"


def number_in(text: str, fact: Fact) -> tuple[float, float]:
    """The number at the start of a card's text in the unit of its fact, and half of its last digit."""
    found = re.match(r"([−\d.]+) ?(°|N s|[^\s(]*)", text)
    assert found is not None, text
    digits, unit = found[1].replace("−", "-"), found[2].replace("°", "deg")
    half = 0.5 * 10.0 ** -len(digits.partition(".")[2])
    if not fact.unit:
        return float(digits), 0.005 * abs(float(digits)) + half
    scale = 1.0 if unit == fact.unit or not unit else units.convert(1.0, unit, fact.unit)
    return float(digits) * scale, 1.001 * half * scale


@pytest.mark.parametrize("system", ["si", "us"])
@pytest.mark.parametrize("name", SCENES)
def test_a_card_has_every_number_as_it_is(name: str, system: str):
    """Read back with its unit it is the result, to half of the last digit that is shown."""
    run = run_of(name)
    with shown_in(system):
        card = dict(run.scene.rows(run))
    for fact in run.scene.facts.values():
        value = run.result[fact.key]
        if not fact.label or value is None or (fact.where and not fact.where(run, run.scene.parameters)):
            assert value is None or fact.label not in card
        elif isinstance(value, int | float) and not isinstance(value, bool):
            shown, precision = number_in(card[fact.label], fact)
            assert shown == pytest.approx(abs(value) if fact.sides else value, abs=precision, rel=1e-9)
        elif value or isinstance(value, bool):
            assert card[fact.label]


@pytest.mark.parametrize("name", SCENES)
def test_a_picture_ends_its_story_in_the_run(name: str):
    """And what is aimed at are boxes with a size."""
    run = run_of(name)
    picture = run.scene.picture(run, (320, 180))
    assert 0.0 < picture.story_end <= run.duration
    assert 0.0 <= picture.moment <= run.duration
    for left, bottom, right, top in picture.aims:
        assert (left < right, bottom < top) == (True, True)
