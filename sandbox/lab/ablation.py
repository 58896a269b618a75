"""Ablation: how far the ball shifts when a part of a scene's model is left out, simplified or added."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from math import hypot, isclose
from time import perf_counter
from typing import Any, NamedTuple

from sandbox import parameters as declared
from sandbox.engine import simulate
from sandbox.engine.accuracy import LEVELS
from sandbox.engine.acting import cause
from sandbox.engine.run import Run
from sandbox.engine.setup import Always, Ball, Bounce, Setup, Surface
from sandbox.errors import SandboxError
from sandbox.lab.reference import Reference, apart, looked_at, places, until
from sandbox.lab.tables import length_above, significant, table
from sandbox.lab.verdicts import verdict
from sandbox.physics.forces import Drag, Magnus, SpinDecay
from sandbox.scene import Scene

#: Shifts below this, in m, do not matter to a player.
NOTHING = 1e-4

#: Spin decay of a golf ball from radar, added if a scene has none.
_DECAY = 6e-5

#: Normal and tangential speed in m/s at which a surface is tested for deformation.
_BOUNCE = (10.0, 10.0)

#: Repeats to measure the time that a part costs. The shortest counts, since other load only adds time.
_REPEATS = 15

#: Result numbers shown for each part, and the relative change below which a number counts as the same.
_SHOWN, _SAME = 2, 1e-6


class Variant(NamedTuple):
    """The scene with one part of its model changed."""

    part: str
    change: str
    scene: Callable[[], Scene]
    setup: Callable[[Scene], Setup] = lambda scene: scene.build()
    touching: bool = False  # whether it matters only at a contact


@dataclass(frozen=True)
class Ablated:
    """The effect of one change. The shifts are None if the run could not be completed; ``problem`` says why."""

    part: str
    change: str
    shift_m: float | None  # by the scene's measure
    flight_m: float | None  # at the first contact of the ball, with the part or without
    verdict: tuple[str, str]  # with the part, and without
    saves: float | None  # fraction of the scene's time at the level "balanced"
    results: dict[str, tuple[float, float]]  # numbers of the result, with the part and without
    problem: str = ""
    idle: bool = False  # whether it concerns contact, and nothing was touched
    noise: float = 0.0  # relative difference of the shortest repeats
    resolution_m: float = 0.0  # error of the compared runs

    @property
    def is_nothing(self) -> bool:
        """Whether the change has no visible effect, in flight or at the end."""
        shifts = self.shift_m, self.flight_m
        return all(m is not None and m < NOTHING for m in shifts) and self.verdict[0] == self.verdict[1]

    def as_dict(self) -> dict[str, Any]:
        return {
            "part": self.part,
            "change": self.change,
            "shift_m": self.shift_m,
            "flight_m": self.flight_m,
            "nothing": self.is_nothing,
            "verdict": list(self.verdict),
            "saves": self.saves,
            "saves_noise": self.noise,
            "resolution_m": self.resolution_m,
            "results": {name: list(pair) for name, pair in self.results.items()},
            "problem": self.problem,
        }

    def cells(self) -> tuple[str, ...]:
        """A row of the table."""
        saves = self._saves()
        if self.problem:
            return self.part, self.change, "", "", saves, f"run failed: {self.problem}"
        shifts = [length_above(shift, self.resolution_m) for shift in (self.flight_m, self.shift_m)]
        if self.is_nothing:
            return self.part, self.change, *shifts, saves, "nothing: no contact" if self.idle else "nothing"
        shown = [
            f"{name} {significant(a, 4)} -> {significant(b, 4)}" for name, (a, b) in list(self.results.items())[:_SHOWN]
        ]
        if self.verdict[0] != self.verdict[1]:
            shown.append(_changed_words(*self.verdict))
        return self.part, self.change, *shifts, saves, ", ".join(shown)

    def _saves(self) -> str:
        if self.saves is None:
            return ""
        least = max(1.0, 200.0 * self.noise)
        return f"{100.0 * self.saves:.0f} %" if 100.0 * abs(self.saves) >= least else f"< {least:.0f} %"


def _changed_words(before: str, after: str) -> str:
    """Two verdicts, without the words they share."""
    a, b = before.split(", "), after.split(", ")
    return " -> ".join(
        ", ".join(word for word in own if word not in other) or "none" for own, other in ((a, b), (b, a))
    )


def as_text(rows: list[Ablated], time: float) -> list[str]:
    """A table; ``time`` (s) is when the shift is measured."""
    cells = [row.cells() for row in rows]
    headings = ("part", "", "shift at first touch", f"after {time:.4g} s", "saves")
    found = [(f"{part} {change}", results) for part, change, *_, results in cells if results]
    return [
        "effect of each part of the model",
        *table(headings, [row[:-1] for row in cells], "llrrr"),
        "",
        "changes in the result",
        *table(("", ""), found, "ll"),
    ]


def ablation(reference: Reference) -> list[Ablated]:
    """Change every part of the scene's model in turn."""
    scene = reference.scene
    names = [ball.name for ball in scene.build().balls]
    whole = _run(scene, scene.build())
    changes = list(variants(scene))
    (own_cost, own_noise), *costs = _costs([Variant("", "", lambda: scene), *changes], reference.time)
    resolution = max(reference.error, reference.error_of(whole))
    rows = []
    for change, (cost, other_noise) in zip(changes, costs, strict=True):
        before = verdict(whole.result)
        saves = None if cost is None or own_cost is None else 1.0 - cost / own_cost
        noise = max(own_noise, other_noise)
        try:
            other = change.scene()
            run = _run(other, change.setup(other))
        except SandboxError as error:
            rows.append(
                Ablated(
                    change.part,
                    change.change,
                    None,
                    None,
                    (before, ""),
                    saves,
                    {},
                    str(error),
                    noise=noise,
                    resolution_m=resolution,
                )
            )
            continue
        shift = apart(looked_at(scene, whole, reference.time), looked_at(other, run, reference.time))
        touch = min([reference.first_touch, *(event.t for event in run.events)])
        flight = apart(places(whole, names, touch), places(run, names, touch))
        turned, differences = (before, verdict(run.result)), _differences(whole, run)
        idle = change.touching and reference.first_touch >= reference.time
        rows.append(
            Ablated(
                change.part,
                change.change,
                shift,
                flight,
                turned,
                saves,
                differences,
                idle=idle,
                noise=noise,
                resolution_m=resolution,
            )
        )
    return rows


def variants(scene: Scene) -> Iterator[Variant]:
    """Each part of the model left out, simplified, or added if the scene lacks it."""
    setup = scene.build()

    def changed(part: str, change: str, apply: Callable[[Setup], Setup], touching: bool = True) -> Variant:
        return Variant(part, change, lambda: scene, lambda same: apply(same.build()), touching)

    for name in _terms(setup):
        yield changed(name, "left out", lambda setup, name=name: _without(setup, name), touching=False)  # type: ignore[misc]
    yield from _by_parameters(scene, setup)
    if any(surface.law is not None for surface in setup.surfaces):
        yield changed("bounce law", "as for a slow bounce", lambda s: _on_surfaces(s, _without_law))
    if any(surface.law is not None and surface.law(*_BOUNCE).tilt != 0.0 for surface in setup.surfaces):
        yield changed("deformation of the ground", "left out", lambda s: _on_surfaces(s, _without_tilt))
    for field, part in (
        ("friction", "friction of surfaces"),
        ("rolling_resistance", "rolling resistance"),
    ):
        if any(getattr(surface, field) > 0.0 for surface in setup.surfaces):
            yield changed(part, "left out", lambda s, field=field: _on_surfaces(s, _without_field(field)))  # type: ignore[misc]
    if any(surface.lowest_bounce > 0.0 for surface in setup.surfaces):
        yield changed("loss of low bounces", "a tenth of the height", lambda s: _on_surfaces(s, _with_lower_bounces))
    if len(setup.balls) > 1 and setup.between_balls(1.0, 1.0).friction > 0.0:
        yield changed("friction of balls (throw)", "left out", _without_throw)
        if setup.between_balls(1.0, 0.1) != setup.between_balls(1.0, 1.0):
            yield changed("friction of balls (throw)", "at any speed as at 1 m/s", _with_one_throw)
    if setup.cloth is not None:
        for field in ("sliding", "rolling", "spinning"):
            if getattr(setup.cloth, field) > 0.0:
                part = f"{field} friction of the cloth"
                yield changed(part, "left out", lambda s, f=field: _on_cloth(s, f), touching=False)  # type: ignore[misc]
    spins = any(ball.spin != 0.0 and any(isinstance(force, Magnus) for force in ball.forces) for ball in setup.balls)
    if spins and not any(ball.torques for ball in setup.balls):
        yield changed("spin decay", "added, as of a golf ball", _with_decay, touching=False)


def with_changes(scene: Scene, changes: dict[str, Any]) -> Scene:
    """The scene with some of its parameters changed, by dotted key. Raises RequestError for a value out of bounds."""
    parameters = declared.validate(type(scene.parameters), scene.parameters.model_dump(), scene.name, changes)
    return replace(scene, parameters=parameters)


# ------------------------------------------------------------------------------------------------------ by parameters


def _by_parameters(scene: Scene, setup: Setup) -> Iterator[Variant]:
    values = {parameter.key: parameter.value for parameter in declared.walk(scene.parameters)}

    def changed(part: str, change: str, changes: dict[str, Any]) -> Variant:
        return Variant(part, change, lambda: with_changes(scene, changes))

    for key, force, part in (("drag", Drag, "drag coefficient"), ("lift", Magnus, "lift coefficient")):
        if values.get(f"ball.{key}.model") in (None, "constant", "none"):
            continue
        steady = with_changes(scene, {f"ball.{key}.model": "constant", f"ball.{key}.coefficient": 1.0}).build()
        pull, unit = _at_launch(setup, force), _at_launch(steady, force)
        if pull > 0.0 and unit > 0.0:
            changes = {f"ball.{key}.model": "constant", f"ball.{key}.coefficient": pull / unit}
            yield changed(part, f"{pull / unit:.3f} as at the start", changes)
    if values.get("air.density", 0.0) > 0.0:
        if values["air.wind"] == (0.0, 0.0):
            yield changed("wind", "added, 1 m/s headwind", {"air.wind": (-1.0, 0.0)})
        else:
            yield changed("wind", "left out", {"air.wind": (0.0, 0.0)})
        if values.get("ball.lift.model") == "none":
            yield changed("lift", "added, equal to the spin ratio", {"ball.lift.model": "spin-ratio"})


def _at_launch(setup: Setup, kind: type) -> float:
    """Magnitude in N of the first force of a kind at the start, 0 if there is none."""
    for ball in setup.balls:
        for force in ball.forces:
            if isinstance(force, kind):
                return hypot(*force(0.0, ball.position, ball.velocity, ball.spin))
    return 0.0


# ---------------------------------------------------------------------------------------------------------- by setup


def _terms(setup: Setup) -> list[str]:
    """Names of all forces and torques, each once."""
    return list(dict.fromkeys(cause(term) for ball in setup.balls for term in (*ball.forces, *ball.torques)))


def _without(setup: Setup, name: str) -> Setup:
    return replace(setup, balls=[_without_term(ball, name) for ball in setup.balls])


def _without_term(ball: Ball, name: str) -> Ball:
    return replace(
        ball,
        forces=[force for force in ball.forces if cause(force) != name],
        torques=[torque for torque in ball.torques if cause(torque) != name],
    )


def _on_surfaces(setup: Setup, change: Callable[[Surface], Surface]) -> Setup:
    return replace(setup, surfaces=[change(surface) for surface in setup.surfaces])


@dataclass(frozen=True)
class _LawWithout:
    """A law of impacts with one part left out."""

    law: Callable[[float, float], Bounce]
    field: str

    def __call__(self, normal_speed: float, slip_speed: float) -> Bounce:
        return self.law(normal_speed, slip_speed)._replace(**{self.field: 0.0})


def _without_field(field: str) -> Callable[[Surface], Surface]:
    def change(surface: Surface) -> Surface:
        if field != "friction" or surface.law is None:
            return replace(surface, **{field: 0.0})  # type: ignore[arg-type]
        return replace(surface, friction=0.0, law=_LawWithout(surface.law, "friction"))

    return change


def _with_lower_bounces(surface: Surface) -> Surface:
    return replace(surface, lowest_bounce=0.1 * surface.lowest_bounce)


def _without_law(surface: Surface) -> Surface:
    return replace(surface, law=None)


def _without_tilt(surface: Surface) -> Surface:
    return surface if surface.law is None else replace(surface, law=_LawWithout(surface.law, "tilt"))


def _without_throw(setup: Setup) -> Setup:
    return replace(setup, between_balls=_LawWithout(setup.between_balls, "friction"))


def _with_one_throw(setup: Setup) -> Setup:
    return replace(setup, between_balls=Always(setup.between_balls(1.0, 1.0)))


def _on_cloth(setup: Setup, field: str) -> Setup:
    assert setup.cloth is not None
    return replace(setup, cloth=replace(setup.cloth, **{field: 0.0}))


def _with_decay(setup: Setup) -> Setup:
    balls = [replace(ball, torques=[SpinDecay(ball.inertia, ball.radius, _DECAY)]) for ball in setup.balls]
    return replace(setup, balls=balls)


# ------------------------------------------------------------------------------------------------------------ running


def _run(scene: Scene, setup: Setup) -> Run:
    run = simulate(setup, LEVELS["precise"])
    run.result = scene.result(run)
    return run


def _costs(changes: list[Variant], time: float) -> list[tuple[float | None, float]]:
    """Seconds for each until ``time`` at "balanced", the shortest of interleaved repeats, and their relative noise;
    None if it cannot be completed."""
    walls: list[list[float]] = [[] for _ in changes]
    failed = [False] * len(changes)
    for _ in range(_REPEATS):
        for index, change in enumerate(changes):
            if failed[index]:
                continue
            try:
                setup = until(change.setup(change.scene()), time)
                started = perf_counter()
                simulate(setup, LEVELS["balanced"])
                walls[index].append(perf_counter() - started)
            except SandboxError:
                failed[index] = True
    return [(None, 0.0) if bad else _shortest(taken) for taken, bad in zip(walls, failed, strict=True)]


def _shortest(walls: list[float]) -> tuple[float, float]:
    """The shortest time, and by what fraction the third shortest is longer."""
    first, _, third, *_ = sorted(walls)
    return first, third / first - 1.0


def _differences(a: Run, b: Run) -> dict[str, tuple[float, float]]:
    """The numbers of the result that differ, in the scene's order."""
    numbers = {name: float(value) for name, value in b.result.items() if _is_number(value)}
    return {
        name: (float(value), numbers[name])
        for name, value in a.result.items()
        if name in numbers and _is_number(value) and not isclose(value, numbers[name], rel_tol=_SAME)
    }


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
