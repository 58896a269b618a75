"""Find me a shot: what can be aimed at in a scene, and the shots that get there, the most forgiving first."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

from sandbox.lab.aim import search
from sandbox.lab.aim.question import Solution, Target
from sandbox.lab.axes import Span
from sandbox.lab.scatter import players_spread
from sandbox.scene import Scene
from sandbox.sport.amounts import amount
from sandbox.sport.controls import Goal
from sandbox.window.aim import speeds
from sandbox.window.handles import grips
from sandbox.window.session import Session
from sandbox.window.worker import Packed, computed

#: Where the scene says nothing else, all speeds of a pull are tried; and angles in deg: upwards, or so far to either
#: side of the scene file's.
_FROM_SIDE, _TO_A_SIDE = (2.0, 85.0), 25.0
#: By two parameters, so many solutions are searched around more finely, in this share of the ranges.
REFINED, _FINER = 2, 0.12
#: A region with more room than this share of the range is known well enough.
_ROOMY = 0.04
#: The most shots that are offered, and by what share they differ.
_MOST, _APART = 5, 0.04


class Found(NamedTuple):
    """A shot that gets there."""

    scene: Scene
    values: dict[str, Any]  # the changes that aim so
    margin: float  # how far off it may be, in standard deviations of a practised player
    said: str
    run: Packed


@dataclass(frozen=True)
class Question:
    """A search for a shot: goals of one name, at a place of the world (m) if there is one."""

    name: str
    at: tuple[float, float] | None
    goals: list[Goal] = field(default_factory=list)


def questions(session: Session, upright: bool) -> list[Question]:
    """The targets that can be aimed at now."""
    controls, usual = session.controls, _usual(session, upright)
    goals = list(controls.goals(session.scene.parameters)) if controls.goals is not None else []
    marked = {(handle.x, handle.y) for handle in controls.handles if handle.goal}
    goals += [Goal(grip.name, {controls.scores: True}, grip.place) for grip in grips(session) if grip.keys in marked]
    if not goals and controls.scores:
        goals = [Goal("a shot that scores", {controls.scores: True})]
    found: dict[str, Question] = {}
    for goal in goals:
        vary = goal.vary or usual
        if vary:
            found.setdefault(goal.name, Question(goal.name, goal.at)).goals.append(replace(goal, vary=vary))
    return list(found.values())


def _usual(session: Session, upright: bool) -> dict[str, tuple[float, float]]:
    """The ranges of speed and angle that are searched where the scene says nothing else: what a pull can reach, and the
    current speed."""
    controls = session.controls
    speed, angle = session.parameters.get(controls.speed), session.parameters.get(controls.angle)
    if speed is None or angle is None:
        return {}
    reach, own = speeds(session), session.base_value(controls.angle)
    low, high = _FROM_SIDE
    if not upright or own < low:  # such as a serve, downwards
        low, high = own - _TO_A_SIDE, own + _TO_A_SIDE
    return {
        controls.speed: (min(reach.lowest, speed.value), max(reach.highest, speed.value)),
        controls.angle: (angle.within(low), angle.within(high)),
    }


def range_text(question: Question, session: Session) -> str:
    """The ranges in which shots are looked for: ``speed 0.37 to 14.8 m/s, angle 2 to 85 deg``; and the speed where
    it stays as it is."""
    texts = []
    for key in dict.fromkeys(key for goal in question.goals for key in goal.vary):
        ends = [end for goal in question.goals for end in goal.vary.get(key, ())]
        parameter = session.parameters[key]
        name = key.rpartition(".")[2].replace("_", " ")
        texts.append(f"{name} {min(ends):.3g} to {max(ends):.3g} {parameter.unit or ''}".rstrip())
    speed = session.parameters.get(session.controls.speed)
    if speed is not None and not any(session.controls.speed in goal.vary for goal in question.goals):
        texts.append(f"at {speed.value:.3g} {speed.unit or ''}".rstrip())
    return ", ".join(texts)


def find(scene: Scene, goals: list[Goal]) -> list[Found]:
    """The shots that get there, the most forgiving first. Raises RequestError and RunError."""
    found = [_found(scene, solution) for goal in goals for solution in _solutions(scene, goal)]
    apart: list[Found] = []
    for each in sorted(found, key=lambda each: -each.margin):
        if all(_differ(each, other) for other in apart):
            apart.append(each)
    return apart[:_MOST]


def _solutions(scene: Scene, goal: Goal) -> list[Solution]:
    """The solutions in the ranges; for two parameters searched more finely around the first ones."""
    spans = [Span(key, *ends) for key, ends in goal.vary.items()]
    wanted = [Target(name, value) for name, value in goal.wanted.items()]
    coarse = search(scene, spans, wanted).solutions
    if len(spans) == 1:
        return coarse
    found = []
    for solution in coarse[:REFINED]:
        if solution.region is not None and solution.region.room[spans[0].key] > _ROOMY * (spans[0].high - spans[0].low):
            found.append(solution)
            continue
        near = []
        for span in spans:
            middle, half = solution.values[span.key], 0.5 * _FINER * (span.high - span.low)
            near.append(Span(span.key, max(span.low, middle - half), min(span.high, middle + half)))
        found += search(scene, near, wanted).solutions[:1]
    return found


def _differ(one: Found, other: Found) -> bool:
    """True if two shots are more than a tenth apart in some parameter."""
    pairs = [(value, other.values.get(key)) for key, value in one.values.items() if isinstance(value, float)]
    return any(there is None or abs(value - there) > _APART * max(abs(value), abs(there)) for value, there in pairs)


def _found(scene: Scene, solution: Solution) -> Found:
    """A solution with its path, and how forgiving it is."""
    values = {**scene.controls.set_on_pull, **{key: float(f"{value:.6g}") for key, value in solution.values.items()}}
    aimed, speed = scene.changed(values), scene.controls.speed
    rooms = solution.region.room if solution.region is not None else {}
    if solution.interval is not None:
        rooms = dict.fromkeys(solution.values, 0.5 * solution.interval.width)
    spread = players_spread(aimed, 1.0)
    margins = [room / spread[key][1] for key, room in rooms.items() if key in spread]

    def texts(numbers: Mapping[str, float]) -> list[str]:
        return [amount(number, "m/s" if key == speed else "deg") for key, number in numbers.items()]

    said = " at ".join(texts(solution.values))
    if rooms:
        said += f"; may be off by {' or '.join(texts(rooms))}"
    return Found(aimed, values, min(margins, default=0.0), said, computed(aimed)[0])
