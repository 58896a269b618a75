"""The report of a run: a card for people, JSON for programs."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping, Sequence
from math import isfinite
from typing import TYPE_CHECKING, Any

from sandbox.engine.ledger import warnings
from sandbox.errors import RunError
from sandbox.files import json_ready, json_text
from sandbox.lab.report import Column, Notes, Report, Section, Table, as_text, words
from sandbox.progress import PATIENCE
from sandbox.scene.running import NUDGE
from sandbox.sport.amounts import margin
from sandbox.sport.readings import words_of
from sandbox.text import shortened, with_noun

if TYPE_CHECKING:
    from sandbox.scene import Check, Scene
    from sandbox.scene.scene_run import SceneRun

#: The fields of an event in JSON.
_EVENT = ("t", "kind", "ball", "with", "speed", "x", "y")

#: Time in s that an impact, a step of a heap, a cluster and an evaluation of forces take, about.
_OF_AN_IMPACT, _OF_A_HEAP, _OF_A_CLUSTER, _OF_FORCES = 5e-4, 2e-3, 5e-3, 2e-5

#: Events shown on a card; a ball that rolls through a rack has hundreds.
_EVENTS_SHOWN = 6

#: Longest value in a sentence, in characters; a list of what a ball touched may have hundreds.
_LONGEST_WORD = 40

#: Smallest error, in its unit, that is reported for a number which the card leaves out.
_LEAST_REPORTED = 1e-3


def as_json(
    scene: Scene,
    run: SceneRun,
    check: Check | None = None,
    others: Sequence[SceneRun] = (),
    more: Mapping[str, Any] | None = None,
) -> str:
    """One JSON object; NaN and infinities are null. ``others`` are runs to compare with: one stands there as an object,
    several as a list. ``more`` stands after what is said of the run."""
    report = {
        **_outcome(scene, run),
        **(more or {}),
        "accuracy": run.accuracy,
        "warnings": [*_beyond_target(check, scene), *_warnings(run)],
        "events": [dict(zip(_EVENT, event, strict=True)) for event in run.events],
        "numerics": run.numerics,
    }
    if others:
        compared = [_outcome(other.scene, other) for other in others]
        report["compared"] = compared if len(compared) > 1 else compared[0]
    if check is not None:
        report["errors"] = check.errors
        report["changed"] = {name: list(pair) for name, pair in check.changed.items()}
        report["nudges"] = {
            "size_m": NUDGE,
            "runs": check.nudges,
            "spread": check.spread,
            "chaotic": sorted(check.chaotic),
            "changed": check.changed_by_nudge,
        }
    try:
        return json_text(report)
    except TypeError as error:  # a result with other values than numbers, words and lists of them
        raise RunError(f"{scene.name}: its result cannot be written as JSON: {error}") from None


def _warnings(run: SceneRun) -> list[str]:
    """Reasons to doubt a run: those of the engine, and facts that are no numbers."""
    facts, parameters = run.scene.facts, run.scene.parameters
    unset = {key: facts[key].compute(run, parameters) for key, value in run.result.items() if value is None}
    wrong = [key for key, value in {**run.result, **unset}.items() if not _is_finite(value)]
    return [*warnings(run), *(f"{key} is not a finite number, and null in JSON" for key in wrong)]


def _is_finite(value: Any) -> bool:
    """True if a fact has no NaN and no infinity, in lists and tables either."""
    if isinstance(value, Mapping):
        return all(map(_is_finite, value.values()))
    if isinstance(value, list | tuple):
        return all(map(_is_finite, value))
    if hasattr(value, "tolist"):  # numpy's numbers and arrays
        return _is_finite(value.tolist())
    return not isinstance(value, float) or isfinite(value)


def _outcome(scene: Scene, run: SceneRun) -> dict[str, Any]:
    return {
        "scene": scene.name,
        "preset": scene.preset,
        "parameters": scene.parameters.model_dump(mode="json"),
        "result": run.result,
        "verdict": scene.verdict(run),
        "ended": run.ended,
        "duration": run.duration,
    }


def card(
    scene: Scene, run: SceneRun, check: Check | None = None, others: Mapping[str, SceneRun] | None = None
) -> list[str]:
    """Lines for the terminal: scene, results, events and numerical cost.

    ``others`` are runs to compare with, by their names: the values of each are shown in a column of its own.
    """
    rows = scene.rows(run, None if check is None else check.errors, also=True)
    numbers = Table([words(), words()], rows)
    if others:
        compared = _compared(rows, scene.verdict(run), list(others.values()))
        numbers = Table([words(name) for name in ("", scene.title, *others)], compared)
    first, *heads = [
        *(f"warning: {warning}" for warning in _beyond_target(check, scene)),
        f"{scene.title}: {scene.about}" if scene.about else scene.title,
    ]
    notes = [
        _numerics(run),
        *_what_took_long(run),
        *(f"warning: {warning}" for warning in _warnings(run)),
        *([] if check is None else _check_lines(check, scene)),
    ]
    verdict = [] if others else [scene.verdict(run)]
    sections: list[Section] = [Notes((), head) for head in heads]
    sections += [Notes(verdict), numbers, _events(run), Notes(notes)]
    return as_text(Report(lambda: run.result, first, sections))


def _compared(rows: list[tuple[str, str]], verdict: str, others: Sequence[SceneRun]) -> list[tuple[str, ...]]:
    """Labels, the texts of this run, and those of each other one."""
    values = [{"verdict": one.scene.verdict(one), **dict(one.scene.rows(one, also=True))} for one in others]
    return [(label, text, *(each.get(label, "") for each in values)) for label, text in [("verdict", verdict), *rows]]


def _events(run: SceneRun) -> Table:
    several = len(run.setup.balls) > 1
    listed = list(run.events if len(run.events) <= _EVENTS_SHOWN else run.events[: _EVENTS_SHOWN - 1])
    rows = [words_of(run, event, several) for event in listed]
    if len(listed) < len(run.events):
        more = f"... {len(run.events) - len(listed) - 1} more"
        rows += [("", *([""] if several else []), more, "", ""), words_of(run, run.events[-1], several)]
    columns = 5 if several else 4
    return Table([Column(), *[words()] * (columns - 1)], [(f"{t:>10}", *texts) for t, *texts in rows])


def _numerics(run: SceneRun) -> str:
    cost, accuracy = run.numerics, run.accuracy
    return (
        f"{accuracy.level}, {accuracy.method} method, {accuracy.steps}: {with_noun(cost.steps, 'step')}, "
        f"{with_noun(cost.impacts, 'impact')}, {cost.wall_s * 1e3:.1f} ms"
    )


def _what_took_long(run: SceneRun) -> list[str]:
    """A line on what took most of the time of a run that takes long, as far as its counts say, on any machine."""
    cost = run.numerics
    stepped = max(0, cost.pymunk_steps - cost.impacts)  # one is that of an impact
    hit = Counter(event.partner for event in run.events if event.kind == "impact").most_common(1)
    others = [f"{count:,} of them with {partner}" for partner, count in hit if count > 1]
    parts = {
        ", ".join([f"{cost.impacts:,} impacts in {run.duration:.4g} s", *others]): cost.impacts * _OF_AN_IMPACT,
        f"{stepped:,} steps of what lies on one another": stepped * _OF_A_HEAP,
        f"{cost.clusters:,} contacts of several balls at once": cost.clusters * _OF_A_CLUSTER,
        f"{cost.force_evaluations:,} evaluations of forces": cost.force_evaluations * _OF_FORCES,
    }
    if sum(parts.values()) <= PATIENCE:
        return []
    return [f"what took long: {max(parts, key=lambda text: parts[text])}"]


def _beyond_target(check: Check | None, scene: Scene) -> list[str]:
    """Return a warning of the errors that are larger than the accuracy aims at, if there are any."""
    if check is None or not check.beyond_target:
        return []
    wrong = ", ".join(_error(check, scene, name) for name in check.beyond_target)
    return [f"{wrong}: this accuracy aims at {margin(check.target, 'm')}"]


def _check_lines(check: Check, scene: Scene) -> list[str]:
    """Return lines on what depends on the accuracy, what is chaotic, and the errors of results without a row."""
    away = f"{check.nudges} runs from starts {NUDGE:g} m away"
    lines = [
        f"depends on the accuracy: {name} is {_word(here)} here and {_word(finer)} in a finer run"
        for name, (here, finer) in check.changed.items()
    ]
    lines += [
        f"chaotic: {_error(check, scene, name)}; {away} alone give {margin(spread, scene.units[name])}"
        for name, spread in check.chaotic.items()
    ]
    lines += [
        f"chaotic: {name.replace('_', ' ')} differs in {len(others)} of {away}, for example {_word(others[0])}"
        for name, others in check.changed_by_nudge.items()
    ]
    unseen = [
        _error(check, scene, name)
        for name, error in check.errors.items()
        if error >= _LEAST_REPORTED and not scene.facts[name].label and name not in check.chaotic
    ]
    lines += [f"not on the card: {', '.join(unseen)}"] if unseen else []
    return lines or [f"checked against a finer run and {away}: only the numbers change, by no more than their ±"]


def _error(check: Check, scene: Scene, name: str) -> str:
    return f"{name.replace('_', ' ')} {margin(check.errors[name], scene.units[name])}"


def _word(value: Any) -> str:
    text = json.dumps(json_ready(value), ensure_ascii=False, default=str)
    return shortened(text, _LONGEST_WORD)
