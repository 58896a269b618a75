"""The inverse problem: which launch, or any other number of a scene, gives a wanted result.

The range is scanned finely enough to see every branch, more finely where results jump; then solvers continue:
Chandrupatla's method in each bracket for one number, scipy's ``root`` (Powell's hybrid method) from several starts for
two. A yes-or-no target (``made = true``) has intervals, whose ends are bisected, or regions of two parameters. Finer
runs estimate how far numerical errors move a solution.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from sandbox.errors import RequestError
from sandbox.lab.aim.intervals import intervals
from sandbox.lab.aim.maximize import maximize
from sandbox.lab.aim.pair import pairs
from sandbox.lab.aim.question import MAXIMIZE, Aim, Target, Trial, as_target, parse_target
from sandbox.lab.aim.regions import regions
from sandbox.lab.aim.scalar import roots_of
from sandbox.lab.aim.share import most_often
from sandbox.lab.aim.shots import Shots
from sandbox.lab.axes import Span, as_axis
from sandbox.lab.runs import Progress, columns_at, no_progress
from sandbox.scene import Scene, as_scene
from sandbox.text import check_mapping

#: Points along the range at which the kind of a number is looked at.
_TRIED = 5

__all__ = ["Aim", "Target", "aim", "as_target", "parse_target", "search"]


def aim(
    scene: Scene | str | Path,
    vary: Mapping[str, tuple[Any, Any]],
    target: Mapping[str, Any] | None = None,
    *,
    maximize: str | None = None,
    progress: Progress = no_progress,
) -> Aim:
    """All values within a range that meet a target: ``aim("golf", {"launch.angle": (5, 75)}, {"carry": 200.0})``.

    Two parameters with two targets likewise. A target that is true, false, a word or, of a result that counts, a whole
    number gives the intervals in which it is met, the widest first, each with its middle, which tolerates the largest
    error; by two parameters, the regions, each with its most forgiving point. ``maximize="carry"``, in place of a
    target, gives the place at which a number is greatest, and ``maximize="made"`` that at which most shots of a
    practised player score. Raises RequestError for an invalid request, and RunError if no run in the range could be
    completed.

    >>> import sandbox
    >>> found = sandbox.aim("golf", {"launch.angle": (5, 40)}, maximize="carry")
    >>> len(found.solutions)
    1
    """
    chosen = as_scene(scene)
    check_mapping("vary", vary, '{"launch.angle": (5, 75)}')
    check_mapping("target", target or {}, '{"carry": 200.0}')
    spans = []
    for key, given in vary.items():
        axis = as_axis(chosen, key, tuple(given) if isinstance(given, list) else given, "vary")
        if not isinstance(axis, Span):
            raise RequestError(f"vary {key}: only numbers have a range, (low, high), but this is {given!r}")
        spans.append(axis)
    targets = [as_target(name, value, chosen) for name, value in (target or {}).items()]
    return search(chosen, spans, [*targets, *([] if maximize is None else [Target(maximize, MAXIMIZE)])], progress)


def search(scene: Scene, spans: Sequence[Span], targets: Sequence[Target], progress: Progress = no_progress) -> Aim:
    """Like ``aim``, for spans and targets already parsed."""
    try:
        import scipy  # noqa: F401
    except ImportError:
        raise RequestError("sandbox aim needs scipy, which is not installed: pip install scipy") from None
    for option, names in (("--vary", [span.key for span in spans]), ("--target", [each.name for each in targets])):
        twice = next((name for name in names if names.count(name) > 1), None)
        if twice is not None:
            both = any(each.name == twice and each.is_maximum for each in targets)
            why = "--maximize names the same number; give one of the two" if both else "given twice"
            raise RequestError(f"{option} {twice}: {why}")
    if len(targets) == 1:
        targets = [_as_whole(scene, spans, targets[0])]
    numbers = [target.is_number for target in targets]
    one, several = len(targets) == 1 and not numbers[0], len(targets) == 2 and all(numbers)
    if not (len(spans) == len(targets) == 1 or (len(spans) == 2 and (one or several))):
        raise RequestError(
            f"{_count(spans, 'parameter')} and {_count(targets, 'target')}: give one of each, two of each with number "
            "targets, or two parameters and a target that is not a number; for more use sandbox sweep"
        )
    shots = Shots(scene, spans, targets, progress)
    jumps: list[tuple[Trial, Trial]] = []
    if targets[0].is_maximum and _is_true_or_false(shots):
        solutions = most_often(shots)
    elif targets[0].is_maximum:
        solutions = maximize(shots)
    elif len(targets) == 2:
        solutions = pairs(shots)
    elif numbers[0]:
        solutions, jumps = roots_of(shots)
    else:
        solutions = intervals(shots) if len(spans) == 1 else regions(shots)
    nearest = None if solutions else shots.nearest()
    found = solutions, nearest, jumps, shots.tries, shots.failures, shots.resolution
    return Aim(scene, tuple(spans), tuple(targets), *found)


def _is_true_or_false(shots: Shots) -> bool:
    """True if what is to be maximized is no number: then it is how often it is true."""
    points = [tuple(0.5 * (span.low + span.high) for span in shots.spans)]
    name = shots.targets[0].name
    found = columns_at(shots.scene, [span.key for span in shots.spans], points, asked=[name])
    return isinstance(found.facts[name][0], bool)


def _as_whole(scene: Scene, spans: Sequence[Span], target: Target) -> Target:
    """A target that is a whole number of a result which counts, such as a score: it is met in intervals, as a word is.
    Any other as it is."""
    if not target.is_number or target.value != int(target.value) or target.name not in scene.facts:
        return target
    points = list(zip(*(np.linspace(span.low, span.high, _TRIED).tolist() for span in spans), strict=True))
    found = columns_at(scene, [span.key for span in spans], points, asked=[target.name])
    known = [value for value in found.facts[target.name] if value is not None]
    counts = bool(known) and all(isinstance(value, int | np.integer) and not isinstance(value, bool) for value in known)
    return Target(target.name, int(target.value)) if counts else target


def _count(things: Sequence[Any], name: str) -> str:
    return f"{len(things)} {name}" + ("" if len(things) == 1 else "s")
