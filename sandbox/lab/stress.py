"""The extremes, and what happened at each: held, refused with a clear error, or failed.

The exact method must give no NaN or infinite number, no tunnelling, no energy gain beyond the bound below, and no
endless loop, or else an error that names time, ball and quantity. The plain method must end without NaN and without a
failure that has a name (tunnelled, exploded); its other columns are for information. What makes no sense, such as a
board upside down or a force that is not a number, must be refused, and counts as no extreme.
"""

from __future__ import annotations

from bisect import bisect_left
from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import takewhile
from math import inf, isfinite
from time import perf_counter, process_time
from typing import Any

import numpy as np

from sandbox.engine import simulate
from sandbox.engine.contact.manifold import all_round, fixed_outline
from sandbox.engine.contact.touch import Outline
from sandbox.engine.ledger import ledger
from sandbox.engine.model.accuracy import LEVELS, Accuracy
from sandbox.engine.model.ball import Ball, kinetic, outline_of
from sandbox.engine.model.motion import Motion
from sandbox.engine.model.nearest import Pose, nearest
from sandbox.engine.model.setup_errors import MethodFailed
from sandbox.engine.model.shapes import Shape
from sandbox.engine.paths.phase import Phase
from sandbox.engine.paths.run import Run
from sandbox.errors import RequestError, SandboxError
from sandbox.lab.extremes import Extreme, of_scene, setups_without_scene
from sandbox.lab.report import Chart, Column, Notes, Panel, Report, Table, words
from sandbox.lab.runs import Progress, no_progress
from sandbox.lab.tables import length, percent
from sandbox.physics.integrators import INTEGRATORS
from sandbox.scene import Scene
from sandbox.sport.amounts import significant

#: Allowed energy gain of the exact method, relative to the largest energy of the run: with an integrator that
#: controls its error, and with one of fixed step.
_ENERGY, _ENERGY_FIXED_STEP = 1e-3, 3e-2

#: Allowed overlap of the exact method: in m, and for what lies in a heap, in radii while it moves and at rest.
OVERLAP, _POURED, AT_REST = 1e-7, 0.05, 1e-4

#: All methods; and those that are tried where most of a run is a heap, which pymunk steps: of the integrators one of
#: each kind.
ALL, _IN_HEAPS = (*INTEGRATORS, "plain"), ("rk4", "dormand-prince", "plain")

#: A run that takes more of the processor's time than this, in s, counts as endless: a busy machine fails no run.
ENDLESS = 20.0

#: Step in s of the integrators without error control, and of the plain method, unless the extreme sets it.
_STEP, _PLAIN_STEP = 1 / 60, 1 / 240

#: Samples of a path in addition to the ends of its arcs, and times at which pairs of balls are checked.
_SAMPLES, _LOOKS = 300, 300

#: Most extremes that are named where one message is that of several.
_NAMED = 3

#: Most balls for which pairs are checked along the whole path.
_MOST_PAIRED = 40

HELD, REFUSED, FAILED, SENSELESS = "held", "refused", "failed", "senseless"


@dataclass(frozen=True)
class Outcome:
    """The outcome of one method at one extreme."""

    scene: str  # "" for a bare setup
    extreme: str
    method: str
    outcome: str  # "held", "refused" or "failed"; or "senseless", if the input makes no sense and is refused
    message: str = ""
    wall_s: float = 0.0
    energy_gained: float | None = None  # not from any force, relative to the largest energy of the run
    penetration_m: float | None = None
    left: bool = False  # whether anything passed through a surface, or left the world


def every_method(level: str = "balanced") -> dict[str, Accuracy]:
    """Every method by name, with its accuracy in the stress test."""
    base = LEVELS[level]
    exact = {
        name: replace(base, integrator=name)
        if integrator.controls_error
        else replace(base, integrator=name, step=_STEP)
        for name, integrator in INTEGRATORS.items()
    }
    return {**exact, "plain": replace(base, method="plain", step=_PLAIN_STEP)}


def stress(
    scenes: Sequence[Scene], level: str = "balanced", with_bare: bool = True, progress: Progress = no_progress
) -> list[Outcome]:
    """Run every extreme of the scenes, and those without a scene, with every method."""
    rows = [("", extreme, ALL) for extreme in setups_without_scene()] if with_bare else []
    for scene in scenes:
        methods = _IN_HEAPS if _is_heap(scene, LEVELS[level]) else ALL
        rows += [(scene.title, extreme, methods) for extreme in of_scene(scene)]
    outcomes = []
    for done, (name, extreme, methods) in enumerate(rows):
        progress(done, len(rows))
        outcomes += list(tried(name, extreme, level, methods))
    return outcomes


def _is_heap(scene: Scene, accuracy: Accuracy) -> bool:
    """True if most of the scene's own run is a heap."""
    try:
        run = simulate(scene.build(), accuracy)
    except SandboxError:
        return False  # its rows say why
    heaped = [arc.phase is Phase.HEAP for own in run.arcs.values() for arc in own]
    return 2 * sum(heaped) > len(heaped)


def tried(scene: str, extreme: Extreme, level: str = "balanced", methods: Collection[str] = ALL) -> Iterator[Outcome]:
    """One extreme with those of the methods that it applies to."""
    for method, accuracy in every_method(level).items():
        if method not in methods or not extreme.suits(accuracy):
            continue
        if extreme.step is not None:
            accuracy = replace(accuracy, step=extreme.step)
        yield _tried(scene, extreme, method, accuracy)


def _tried(scene: str, extreme: Extreme, method: str, accuracy: Accuracy) -> Outcome:
    started, used = perf_counter(), process_time()

    def outcome(what: str, message: str, *found: Any) -> Outcome:
        return Outcome(scene, extreme.name, method, what, message, perf_counter() - started, *found)

    try:
        run = simulate(extreme.build(), accuracy)
    except MethodFailed as error:
        return outcome(FAILED, str(error))
    except SandboxError as error:
        request = isinstance(error, RequestError)
        refused = SENSELESS if request or not extreme.makes_sense else REFUSED
        kind = "" if request else f"{type(error).__name__}: "
        return outcome(refused if process_time() - used < ENDLESS else FAILED, f"{kind}{error}")
    except Exception as error:  # any other exception is a failure, which this test looks for
        return outcome(FAILED, f"{type(error).__name__}: {error}")
    took = process_time() - used
    gained, overlap, deep, through = _energy_gained(run), *_overlap(run)
    bound = _ENERGY if INTEGRATORS[accuracy.integrator].controls_error else _ENERGY_FIXED_STEP
    exact = accuracy.method == "exact"
    problems = {
        "NaN or infinite": not _is_finite(run),
        f"energy gained, {significant(100.0 * gained)} %": exact and gained > bound,
        f"overlap of {length(overlap)}": exact and deep,
        f"passed through {through}": through,
        f"took {took:.0f} s": took > ENDLESS,
    }
    message = "; ".join(problem for problem, seen in problems.items() if seen)
    return outcome(FAILED if message else HELD, message, gained, overlap, bool(through))


# ------------------------------------------------------------------------------------------------------------ checks


def _is_finite(run: Run) -> bool:
    return all(isfinite(value) for arcs in run.arcs.values() for arc in arcs for value in arc.state(arc.t1))


def _energy_gained(run: Run) -> float:
    """Energy that no force accounts for, relative to the largest energy of the run.

    For the exact method, the gain of its arcs beyond the forces' work, plus any gain in an impact; for the plain
    method, whose impacts are spread over steps, the gain from start to end beyond the work.
    """
    if len(run.setup.balls) > _MOST_PAIRED:
        return 0.0  # the ledger of a pile takes longer than its run
    book = ledger(run)
    work = sum(book.work.values())
    fastest = (kinetic(ball, arc.start) for ball in run.setup.balls for arc in run.arcs[ball.name])
    largest = max(1e-30, book.start, *(abs(part) for part in book.work.values()), *fastest)
    if run.accuracy.method == "plain":
        return max(0.0, book.end - book.start - work) / largest
    return (max(0.0, book.residue) + book.jumped) / largest


def _overlap(run: Run) -> tuple[float, bool, str]:
    """The deepest overlap in m of any ball with anything, whether one is deeper than allowed, and what a ball passed
    through, if anything."""
    found, through = [(0.0, 0.0), *_overlaps_of_balls(run)], ""
    for ball in run.setup.balls:
        times, x, y = run.trajectory(ball.name, max(run.duration, 1e-9) / _SAMPLES, ends=True)[:, :3].T
        for surface in run.setup.surfaces:
            outline = Outline.of(surface.shape, np.full_like(x, ball.radius))
            seen = _relative_to(surface.motion, times, x, y)
            for t, gap in [(t, gap) for t, gap in zip(times, outline.near(*seen).gap, strict=True) if gap < 0.0]:
                if ball.rotates:  # the disc around it may overlap: its outline counts
                    fixed = fixed_outline(surface.at(t).shape).shape
                    gap = nearest(*_outline(run, ball, t), fixed, Pose(0.0, 0.0, 0.0)).gap
                found.append((-float(gap), _allowed(run, ball, t, Phase.CLUSTER)))
            through = through or (surface.name if _crosses(outline, *seen) else "")
    return max(found)[0], any(deep > allowed for deep, allowed in found), through


def _relative_to(
    motion: Motion | None, times: np.ndarray, x: np.ndarray, y: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Places in m at times in s, each of shape (n,), as they lie to a surface that moves where it is drawn."""
    if motion is None:
        return x, y
    u, v, angle = np.array([motion.place(t) for t in times.tolist()]).T
    c, s, dx, dy = np.cos(angle), np.sin(angle), x - u, y - v
    return motion.about[0] + c * dx + s * dy, motion.about[1] - s * dx + c * dy


def _allowed(run: Run, ball: Ball, t: float, *pressed: Phase) -> float:
    """The overlap in m that is allowed for a ball up to t: it may just have left a heap, or a phase in
    which others ``pressed`` it."""
    path = run.arcs[ball.name]
    at = min(bisect_left(path.stops, t), len(path) - 1)
    if not any(arc.phase in (Phase.HEAP, *pressed) for arc in (path[max(0, at - 1)], path[at])):
        return OVERLAP
    return ball.radius * (AT_REST if path[at].rests else _POURED)


def _outline(run: Run, ball: Ball, t: float) -> tuple[Shape, Pose]:
    """The outline of a ball or body, and where it is."""
    return outline_of(ball), Pose(*run.state(ball.name, t)[:2], run.angle(ball.name, t) if ball.rotates else 0.0)


def _crosses(outline: Outline, x: np.ndarray, y: np.ndarray) -> bool:
    """True if a path crosses the line in the middle of a surface, between its ends."""
    across, along = outline.across(x, y), outline.along(x, y)
    before, after = across[:-1], across[1:]
    share = before / np.where(before == after, 1.0, before - after)
    met = along[:-1] + share * (along[1:] - along[:-1])
    return bool(np.any(((before < 0.0) != (after < 0.0)) & (met > 0.0) & (met < outline.length[1:])))


def _overlaps_of_balls(run: Run) -> Iterator[tuple[float, float]]:
    """Each overlap in m of two balls, and the one that is allowed, at the ends of their arcs, but not within a contact
    that is simulated, which compresses them; for a pile, at the end of the run."""
    balls, times = run.setup.balls, [run.duration]
    if len(balls) <= _MOST_PAIRED:
        arcs = [arc for own in run.arcs.values() for arc in own]
        contacts = {arc.contact_span for arc in arcs if arc.contact_span is not None}
        times = sorted(t for t in {arc.t1 for arc in arcs} if not any(start < t < end for start, end in contacts))
        times = times[:: max(1, len(times) // _LOOKS)]
    gone = {ball.name: inf if (t := run.caught_at(ball.name)) is None else t for ball in balls}
    for t in times:
        there = [ball for ball in balls if t < gone[ball.name]]
        places = np.array([run.state(ball.name, t)[:2] for ball in there]).reshape(-1, 2)
        radii = np.array([ball.radius for ball in there])
        gaps = np.hypot(*(places[:, None] - places[None]).transpose(2, 0, 1)) - radii[:, None] - radii[None]
        for i, j in np.argwhere(np.triu(gaps < 0.0, 1)):
            one, other = there[i], there[j]
            gap = gaps[i, j] if all_round(one, other) else nearest(*_outline(run, one, t), *_outline(run, other, t)).gap
            yield -float(gap), min(_allowed(run, one, t), _allowed(run, other, t))


# -------------------------------------------------------------------------------------------------------------- report


#: Columns of what ``_sums`` gives.
_SUMS = (
    *(Column(outcome, write=str) for outcome in (HELD, REFUSED, FAILED)),
    Column("energy", write=percent),
    Column("overlap", write=length),
)


def report_of(outcomes: Sequence[Outcome]) -> Report:
    """Counts of how each method held, and each failure; as details each extreme of each scene, with its refusals."""
    sensible = _sensible(outcomes)
    counts = summary(outcomes)
    scenes = {scene: scene or _BARE for scene, _ in _grouped(outcomes, "scene")}
    senseless = _extremes(outcomes) - _extremes(sensible)
    absent = [f"not counted, as they make no sense and are refused: {senseless}"] if senseless else []
    failures = [
        Notes(list(_remarks(own, FAILED)), scenes[scene])
        for scene, own in _grouped(sensible, "scene")
        if any(each.outcome == FAILED for each in own)
    ]
    return Report(
        lambda: outcomes,
        f"{_extremes(sensible)} extremes of {', '.join(scenes.values())}",
        [
            replace(counts, notes=absent),
            _chart(counts.rows),
            *failures,
            *(_each_extreme(scenes[scene], own) for scene, own in _grouped(outcomes, "scene")),
        ],
        more="each extreme, and what was refused and why",
    )


def _each_extreme(scene: str, outcomes: Sequence[Outcome]) -> Table:
    rows = []
    for extreme, tries in _grouped(outcomes, "extreme"):
        *counts, energy, overlap = _sums([each for each in tries if each.method != "plain"], tries)
        rows.append([extreme, *(count or None for count in counts), energy, overlap])
    refused = list(_remarks(outcomes, REFUSED, SENSELESS))
    return Table([words("extreme"), *_SUMS], rows, scene, refused, detail=True)


def _chart(counts: Sequence[Sequence[Any]]) -> Chart:
    """Bars of what held, was refused and failed, by method."""

    def bars(axes: Any, colours: Mapping[str, Any]) -> None:
        card, methods = colours["card"], [row[0] for row in counts][::-1]
        left = np.zeros(len(methods))
        for place, (word, colour) in enumerate(((HELD, card["good"]), (REFUSED, card["quiet"]), (FAILED, card["bad"]))):
            runs = np.array([row[1 + place] for row in counts][::-1], float)
            axes.barh(methods, runs, left=left, color=colour, height=0.62, label=word)
            left = left + runs
        axes.tick_params(axis="y", length=0)
        axes.spines["left"].set_visible(False)

    return Chart([Panel(bars, "runs at extremes")], height=0.5 + 0.4 * len(counts))


def _sensible(outcomes: Sequence[Outcome]) -> list[Outcome]:
    """The outcomes of all extremes but those that make no sense."""
    senseless = {(each.scene, each.extreme) for each in outcomes if each.outcome == SENSELESS}
    return [each for each in outcomes if (each.scene, each.extreme) not in senseless]


def _extremes(outcomes: Sequence[Outcome]) -> int:
    return len({(each.scene, each.extreme) for each in outcomes})


#: What stands for the scene of a setup without one.
_BARE = "setups without a scene"


def summary(outcomes: Sequence[Outcome]) -> Table:
    """Counts of how each method held, its largest energy gain and its largest overlap, and the longest step at which
    it held in every scene."""
    rows: list[list[Any]] = []
    for method, own in _grouped(_sensible(outcomes), "method"):
        steps = _grouped([each for each in own if each.extreme.startswith("step ")], "extreme")
        held = takewhile(lambda step: all(each.outcome == HELD for each in step[1]), steps)
        longest = "".join([step for step, _ in held][-1:])
        rows.append([method, *_sums(own, own), longest])
    return Table([words("method"), *_SUMS, Column("holds up to")], rows)


def _grouped(outcomes: Sequence[Outcome], by: str) -> list[tuple[str, list[Outcome]]]:
    groups: dict[str, list[Outcome]] = defaultdict(list)
    for outcome in outcomes:
        groups[getattr(outcome, by)].append(outcome)
    return list(groups.items())


def _sums(measured: Sequence[Outcome], outcomes: Sequence[Outcome]) -> list[Any]:
    """The runs that held, were refused, and failed, counted; of those measured the largest energy gain and overlap."""
    counts = [sum(each.outcome == word for each in outcomes) for word in (HELD, REFUSED, FAILED)]
    energy = [each.energy_gained for each in measured if each.energy_gained is not None]
    overlap = [each.penetration_m for each in measured if each.penetration_m is not None]
    return [*counts, max(energy, default=None), max(overlap, default=None)]


def _remarks(outcomes: Sequence[Outcome], *words: str) -> Iterator[str]:
    """Each message once, with the extremes and methods that gave it; of these outcomes only, if any are given."""
    by_message: dict[tuple[str, str, str], list[str]] = defaultdict(list)
    for o in outcomes:
        if o.outcome in (words or (REFUSED, FAILED, SENSELESS)):
            by_message[o.outcome, o.extreme, o.message.partition("\n")[0]].append(o.method)
    everybody = len({outcome.method for outcome in outcomes})
    by_extreme: dict[tuple[str, str, tuple[str, ...]], list[str]] = defaultdict(list)
    for (outcome, extreme, message), names in by_message.items():
        by_extreme[outcome, message, tuple(names)].append(extreme)
    for (outcome, message, methods), extremes in by_extreme.items():
        who = "" if len(methods) == everybody else f" ({', '.join(methods)})"
        where = ", ".join(extremes) if len(extremes) <= _NAMED else f"{len(extremes)} extremes"
        yield f"{outcome}, {where}{who}: {message}"
