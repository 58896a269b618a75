"""Ablation: how far the ball shifts when a part of a scene's model is left out, simplified or added."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, is_dataclass, replace
from functools import partial
from math import hypot, inf, isclose
from typing import Any, NamedTuple

from sandbox.engine.model.accuracy import LEVELS
from sandbox.engine.model.ball import Ball, Force
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.surface import Bounce, BounceLaw, ConstantBounce, Surface
from sandbox.engine.motion.forces_on_ball import cause
from sandbox.lab.reference import Reference, apart, places, until
from sandbox.lab.report import Column, Table, words
from sandbox.lab.tables import length_or_below
from sandbox.lab.timing import Timed, repeat
from sandbox.lab.verdicts import verdict
from sandbox.physics.air import UniformWind
from sandbox.physics.coefficients import Constant, spin_ratio_lift
from sandbox.physics.forces import Drag, Inside, Magnus, Parts, SpinDecay, Thinning
from sandbox.physics.of_ball import on_ball
from sandbox.physics.plane import without
from sandbox.scene import compare
from sandbox.scene.running import simulate_at
from sandbox.scene.scene_run import SceneRun
from sandbox.sport.amounts import significant
from sandbox.tracebacks import one_line_error

#: Shifts below this, in m, do not matter to a player.
NOTHING = 1e-4

#: Spin decay of a golf ball from radar, added if a scene has none.
_DECAY = 6e-5

#: Normal and tangential speeds in m/s at which the laws of impacts are compared.
_FAST, _SLOW = (10.0, 10.0), (1.0, 1.0)

#: Reynolds numbers and spin ratios at which coefficients are compared.
_FLOWS = tuple((reynolds, spin_ratio) for reynolds in (3e4, 1e5, 3e5) for spin_ratio in (0.05, 0.2))

#: Result numbers shown for each part; the relative change below which a number counts as the same; and the number, in
#: its unit, below which it is zero but for rounding.
_SHOWN, _SAME, _ZERO = 2, 1e-6, 1e-9

#: A saving is shown from this fraction on, and from this multiple of its noise. A run that takes more than twice as
#: long without a part, a saving of less than -1, has become another one: its time says nothing of the part.
_LEAST_SAVED, _NOISES, _ANOTHER_RUN = 0.01, 2.0, -1.0


class _Variant(NamedTuple):
    """A setup with one part of its model changed."""

    part: str
    change: str
    setup: Setup
    touching: bool  # whether it matters only at a contact


@dataclass(frozen=True)
class Ablated:
    """The effect of one change. The shifts are None if the run could not be completed; ``problem`` says why."""

    part: str
    change: str
    verdict: tuple[str, str]  # with the part, and without
    shift_m: float | None = None  # when positions are compared
    flight_m: float | None = None  # at the first contact of the ball, with the part or without
    results: dict[str, tuple[float, float]] | None = None  # numbers of the result, with the part and without
    saves: float | None = None  # fraction of the scene's time at the level "balanced"
    saves_noise: float = 0.0  # of ``saves``, from the differences of the shortest repeats
    resolution_m: float = 0.0  # error of the compared runs
    idle: bool = False  # whether it concerns contact, and nothing was touched
    problem: str = ""

    @property
    def is_nothing(self) -> bool:
        """True if the change has no visible effect, in flight or at the end."""
        shifts = self.shift_m, self.flight_m
        return all(m is not None and m < NOTHING for m in shifts) and self.verdict[0] == self.verdict[1]

    @property
    def effect(self) -> str:
        """The changes in the result, in words."""
        if self.problem:
            return f"run failed: {self.problem}"
        if self.is_nothing:
            return "nothing: no contact" if self.idle else "nothing"
        numbers = [(name, *map(_rounded, values)) for name, values in (self.results or {}).items()]
        changes = [f"{name} {one} -> {other}" for name, one, other in numbers if one != other][:_SHOWN]
        if self.verdict[0] != self.verdict[1]:
            changes.append(_changed_words(*self.verdict))
        return ", ".join(changes)

    def cells(self) -> list[str]:
        """A row of the table: the part, the change, both shifts, and what it saves."""
        shifts = [length_or_below(shift, self.resolution_m) for shift in (self.flight_m, self.shift_m)]
        saves = self.saves or 0.0
        seen = abs(saves) >= max(_LEAST_SAVED, _NOISES * self.saves_noise) and saves >= _ANOTHER_RUN
        saved = "" if self.saves is None else f"{100.0 * saves:.0f} %" if seen else "-"
        return [self.part, self.change, *shifts, saved]


def _rounded(value: float) -> str:
    return significant(value if abs(value) >= _ZERO else 0.0, 4)


def _changed_words(before: str, after: str) -> str:
    """Two verdicts, without the words they share."""
    a, b = before.split(", "), after.split(", ")
    return " -> ".join(
        ", ".join(word for word in own if word not in other) or "none" for own, other in ((a, b), (b, a))
    )


def tables(rows: Sequence[Ablated], time: float) -> list[Table]:
    """The shifts, and the changes in the result; ``time`` (s) is when the shift is measured."""
    columns = [words("part"), words(), *map(Column, ("shift at first touch", f"after {time:.4g} s", "saves"))]
    effects = [(f"{row.part} {row.change}", row.effect) for row in rows if row.effect]
    return [
        Table(columns, [row.cells() for row in rows], "effect of each part of the model", detail=True),
        Table([words(), words()], effects, "changes in the result", detail=True),
    ]


def ablation(reference: Reference) -> list[Ablated]:
    """Change every part of the scene's model in turn."""
    scene, precise, balanced = reference.scene, LEVELS["precise"], LEVELS["balanced"]
    whole = simulate_at(scene, precise)
    before = verdict(scene, whole.result)
    resolution = max(reference.error, reference.error_of(whole))
    changes = list(variants(scene.build()))
    setups = [reference.setup(), *(until(change.setup, reference.time) for change in changes)]
    own, *costs = trials = [Timed(setup, balanced, lambda run: None) for setup in setups]
    repeat(trials)
    rows = []
    for (part, change, setup, touching), cost in zip(changes, costs, strict=True):
        row = Ablated(
            part,
            change,
            (before, ""),
            saves=None if cost.problem or own.problem else 1.0 - cost.wall / own.wall,
            saves_noise=cost.wall / own.wall * (own.noise + cost.noise),
            resolution_m=resolution,
            idle=touching and reference.first_touch >= reference.time,
        )
        try:
            run = simulate_at(scene, precise, setup)
        except Exception as error:  # of the scene's own code, too
            rows.append(replace(row, problem=one_line_error(error)))
            continue
        touch = min([reference.first_touch, *(event.t for event in run.events)])
        row = replace(
            row,
            verdict=(before, verdict(scene, run.result)),
            shift_m=apart(*(places(one, reference.time) for one in (whole, run))),
            flight_m=apart(*(places(one, touch) for one in (whole, run))),
            results=_differences(whole, run),
        )
        rows.append(row)
    return rows


def _differences(a: SceneRun, b: SceneRun) -> dict[str, tuple[float, float]]:
    """The numbers of the result that differ, in the scene's order."""
    both = {name: (a.result[name], b.result[name]) for name in compare(a, b).errors}
    return {
        name: (float(one), float(other))
        for name, (one, other) in both.items()
        if isinstance(one, int | float) and not isclose(one, other, rel_tol=_SAME, abs_tol=_ZERO)
    }


# -------------------------------------------------------------------------------------------------------- the variants


def variants(setup: Setup) -> Iterator[_Variant]:
    """Each part of the model left out, simplified, or added if the scene lacks it."""
    balls = [replace(ball, forces=[*ball.forces], torques=[*ball.torques]) for ball in setup.balls]
    setup = replace(setup, balls=balls, surfaces=[*setup.surfaces])  # lists throughout, to be compared
    changes = (*_of_balls(setup), *_of_contacts(setup), *_of_planes(setup))
    yield from (variant for variant in changes if variant.setup != setup)


def _of_balls(setup: Setup) -> Iterator[_Variant]:
    """Forces and torques; loss of mass; coefficients as at the start; wind, lift and spin decay."""
    first, terms = setup.balls[0], [term for ball in setup.balls for term in (*ball.forces, *ball.torques)]

    def variant(part: str, change: str, changed: Callable[[Ball], Ball]) -> _Variant:
        return _Variant(part, change, replace(setup, balls=[changed(ball) for ball in setup.balls]), touching=False)

    for name in dict.fromkeys(map(cause, terms)):
        yield variant(name, "left out", partial(_without, name=name))
    yield variant("loss of mass", "left out", lambda ball: replace(ball, loss=None))
    for kind, part in ((Drag, "drag coefficient"), (Magnus, "lift coefficient")):
        start = [_at_start(first, force) for force in first.forces if isinstance(force, kind) and _varies(force)]
        if any(start):
            yield variant(part, f"{start[0]:.3f} as at the start", partial(_steady, kind=kind))
    declared = {part: value for term in map(_in_medium, terms) for part, value in _parts_of(term).items()}
    for part, value in declared.items():
        yield variant(part.replace("_", " "), "left out", partial(_with_part, part=part, value=value))
    if all(getattr(term, "wind", None) is None for term in map(_in_medium, terms) if "wind" in _parts_of(term)):
        headwind = partial(_with_part, part="wind", value=UniformWind(-1.0, 0.0))
        yield variant("wind", "added, 1 m/s headwind", headwind)
    lifted = [ball for ball in setup.balls if any(isinstance(force, Magnus) for force in ball.forces)]
    if not lifted:
        yield variant("lift", "added, equal to the spin ratio", _with_lift)
    if any(ball.spin for ball in lifted) and not any(ball.torques for ball in setup.balls):
        yield variant("spin decay", "added, as of a golf ball", _with_decay)


def _without(ball: Ball, name: str) -> Ball:
    forces, torques = ([term for term in terms if cause(term) != name] for terms in (ball.forces, ball.torques))
    return replace(ball, forces=forces, torques=torques)


def _varies(force: Drag | Magnus) -> bool:
    return callable(force.coefficient) and len({force.coefficient(*flow) for flow in _FLOWS}) > 1


def _at_start(ball: Ball, force: Drag | Magnus) -> float:
    """The coefficient of a force at the start; 0 for a ball at rest."""
    pull, unit = (
        hypot(*each(0.0, ball.position, ball.velocity, ball.spin))
        for each in (force, on_ball(replace(force, coefficient=1.0), ball))
    )
    return pull / unit if unit else 0.0


def _steady(ball: Ball, kind: type[Drag | Magnus]) -> Ball:
    def steady(force: Force) -> Force:
        return replace(force, coefficient=Constant(_at_start(ball, force))) if isinstance(force, kind) else force

    return replace(ball, forces=[steady(force) for force in ball.forces])


def _parts_of(term: Any) -> Parts:
    """The fields of a force or torque that its class declares as parts, each with the value that leaves it out."""
    return getattr(term, "PARTS", {}) if is_dataclass(term) else {}


def _in_medium(term: Any) -> Any:
    """The force that acts in a medium; any other force or torque itself."""
    return _in_medium(term.force) if isinstance(term, Inside | Thinning) else term


def _with_part(ball: Ball, part: str, value: Any) -> Ball:
    """The ball with a field of its forces and torques changed, where their classes declare it as a part."""

    def changed(term: Any) -> Any:
        if isinstance(term, Inside | Thinning):
            return replace(term, force=changed(term.force))
        return replace(term, **{part: value}) if part in _parts_of(term) else term

    forces, torques = ([changed(term) for term in terms] for terms in (ball.forces, ball.torques))
    return replace(ball, forces=forces, torques=torques)


def _with_lift(ball: Ball) -> Ball:
    lifts = [
        Magnus(drag.radius, drag.density, spin_ratio_lift, drag.wind, drag.area, drag.viscosity)
        for drag in ball.forces
        if isinstance(drag, Drag)
    ]
    return replace(ball, forces=[*ball.forces, *lifts])


def _with_decay(ball: Ball) -> Ball:
    return replace(ball, torques=[SpinDecay(ball.inertia, ball.radius, _DECAY)])


def _of_contacts(setup: Setup) -> Iterator[_Variant]:
    """Yield the variants of surfaces, and of impacts between balls."""
    for (part, change), changed in _OF_SURFACES.items():
        yield _Variant(part, change, replace(setup, surfaces=[changed(surface) for surface in setup.surfaces]), True)
    if len(setup.balls) > 1:
        law, throw, one_by_one = setup.between_balls, "friction of balls (throw)", replace(setup.contact, name="rigid")
        yield _Variant("contact mechanics", "one impact after another", replace(setup, contact=one_by_one), True)
        yield _Variant(throw, "left out", replace(setup, between_balls=_law_without(law, "friction")), True)
        if setup.contact.along < inf:
            rigid = replace(setup, between_balls=_Without(law, "tangential"), contact=replace(setup.contact, along=inf))
            yield _Variant("restitution along balls", "left out", rigid, True)
        if law(*_FAST) != law(*_SLOW):
            slow = replace(setup, between_balls=ConstantBounce(law(*_SLOW)))
            yield _Variant(throw, "at any speed as at 1 m/s", slow, True)


@dataclass(frozen=True)
class _Without:
    """A law of impacts with one part left out."""

    law: BounceLaw
    part: str

    def __call__(self, normal_speed: float, slip_speed: float) -> Bounce:
        return self.law(normal_speed, slip_speed)._replace(**{self.part: 0.0})


def _law_without(law: BounceLaw, part: str) -> BounceLaw:
    """A law without one of its parts; the law itself where that changes nothing."""
    return law if not getattr(law(*_FAST), part) else _Without(law, part)


def _less(surface: Surface, part: str) -> Surface:
    """The surface without a part of its law, if it has one."""
    return replace(surface, law=surface.law and _law_without(surface.law, part))


#: Ways to leave out or simplify each part of the response of surfaces.
_OF_SURFACES: dict[tuple[str, str], Callable[[Surface], Surface]] = {
    ("bounce law", "as for a slow bounce"): lambda s: replace(s, law=None),
    ("deformation of the ground", "left out"): lambda s: _less(s, "tilt"),
    ("restitution along surfaces", "left out"): lambda s: _less(s, "tangential"),
    ("friction of surfaces", "left out"): lambda s: replace(_less(s, "friction"), friction=0.0),
    ("rolling resistance", "left out"): lambda s: replace(s, rolling_resistance=0.0),
    ("loss of low bounces", "a tenth of the height"): lambda s: replace(s, lowest_bounce=0.1 * s.lowest_bounce),
    ("cushion nose", "at the ball's centre"): lambda s: replace(s, nose_height=None),
}


def _of_planes(setup: Setup) -> Iterator[_Variant]:
    """Yield the variants of the planes on which balls slide and roll."""
    every = [] if setup.plane is None else [setup.plane, *(plane for _, plane in setup.planes)]
    parts = {(term, plane.name): called for plane in every for term, called in plane.TERMS.items()}
    for (term, name), called in parts.items():
        own, *others = [without(plane, term) if plane.name == name else plane for plane in every]
        planes = [(ball, plane) for (ball, _), plane in zip(setup.planes, others, strict=True)]
        yield _Variant(f"{called} of the {name}", "left out", replace(setup, plane=own, planes=planes), False)
