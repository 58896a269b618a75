"""The record of a run for a golden test, and what has changed since: events, results and sampled states."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from importlib.metadata import version
from math import inf
from pathlib import Path
from platform import python_version
from typing import TYPE_CHECKING, Any, NamedTuple

from sandbox.files import json_ready
from sandbox.text import shortened

if TYPE_CHECKING:
    from sandbox.scene.scene_run import SceneRun
    from sandbox.sport.facts import Fact

#: Two numbers are the same when they differ by no more than this, in s, m, m/s or rad/s, or by this share of
#: themselves. Rounding on another processor stays below 1e-9, unless the scene is chaotic; a force that is wrong by one
#: part in ten thousand moves a ball by millimetres.
TOLERANCE = 1e-6
#: Numbers are rounded to this many digits, so that files differ only where the tolerance is exceeded.
_DIGITS = 9
#: Parts of a record that say where a difference comes from; one that is older may lack them.
EXPLAINING = ("parameters", "labels", "says")
#: States recorded for each ball, and the most for all balls together.
SAMPLES, _MOST_STATES = 24, 240
#: A run is chaotic if moving its balls this far, in m, at the start moves the result by more than the tolerance. It is
#: a hundred times the effect of rounding.
_NUDGE = 1e-12

#: Longest text of a result in a message, in characters.
_LONGEST_WORD = 48

_COLUMNS = ("t", "x", "y", "vx", "vy", "spin")
_UNITS = {"t": "s", "x": "m", "y": "m", "vx": "m/s", "vy": "m/s", "spin": "rad/s", "speed": "m/s"}

Record = dict[str, Any]


def record(run: SceneRun, until: float | None = None, duration: float | None = None) -> Record:
    """Return what happened, in JSON's types: up to ``until`` s, or to the end and with the results.

    The parameters and the versions of what computed it say where a difference may come from.

    States are spread evenly over the run, or over ``duration`` s, that of a record to compare with.
    """
    end = run.duration if until is None else min(until, run.duration)
    balls = run.setup.balls
    last = max(6, min(SAMPLES, _MOST_STATES // len(balls))) - 1
    times = _rounded([(duration or end) * i / last for i in range(last + 1)])  # as the file will have them
    recorded: Record = {} if until is None else {"until": until}
    if until is None:
        recorded |= {"ended": run.ended, "duration": run.duration, "says": run.scene.verdict(run)}
        recorded["result"] = json_ready(run.result)
        recorded["labels"] = {key: label for key, fact in run.scene.facts.items() if (label := _label(fact))}
    recorded["parameters"] = run.scene.parameters.model_dump(mode="json", exclude_none=True)
    recorded["versions"] = _versions()
    recorded["events"] = [
        [event.t, event.kind, event.ball, event.partner, event.speed] for event in run.events if event.t <= end
    ]
    # A run may end with an impact: its last state is the one after it, however the time was rounded. That is also the
    # state at all later times of a record that is longer.
    when = [run.duration if t >= run.duration - TOLERANCE else t for t in times]
    recorded["states"] = {
        ball.name: [[t, *map(float, run.state(ball.name, at))] for t, at in zip(times, when, strict=True)]
        for ball in balls
    }
    return _rounded(recorded)


def _label(fact: Fact) -> str:
    """Label and unit of a fact: ``"landing speed (m/s)"``."""
    return f"{fact.label} ({fact.unit})".strip() if fact.unit else fact.label


@cache
def _versions() -> str:
    """The versions on which numbers and pictures depend: ``"Python 3.11.2, numpy 2.1.0, ..."``."""
    packages = ", ".join(f"{name} {version(name)}" for name in ("numpy", "pymunk", "pygame-ce"))
    return f"Python {python_version()}, {packages}"


def changed_parameters(expected: Record, actual: Record, units: Mapping[str, str | None]) -> list[str]:
    """Return the parameters that differ: ``"launch.speed 60 -> 60.6 m/s"``; [] for a record without them."""
    before, after = (_flat(recorded.get("parameters", {})) for recorded in (expected, actual))
    if not before:
        return []
    return [
        f"{key} {_word(before.get(key))} -> {_word(after.get(key))} {units.get(key) or ''}".rstrip()
        for key in before | after
        if before.get(key) != after.get(key)
    ]


def _flat(value: Any, key: str = "") -> dict[str, Any]:
    """Nested parameters by key: ``launch.speed``, ``air.wind[0]``."""
    if isinstance(value, Mapping):
        inside = [(f"{key}.{name}" if key else name, entry) for name, entry in value.items()]
    elif isinstance(value, list):
        inside = [(f"{key}[{place}]", entry) for place, entry in enumerate(value)]
    else:
        return {key: value}
    return {name: one for inner, entry in inside for name, one in _flat(entry, inner).items()}


def read(path: Path) -> Record:
    """The record in a file. Raises ValueError if it is not one, or not a whole one."""
    recorded: Record = json.loads(path.read_text("utf-8"))
    try:
        first_change(recorded, recorded)
        if not all(_is_number(value) for rows in recorded["states"].values() for row in rows for value in row):
            raise ValueError
    except (KeyError, TypeError, AttributeError, IndexError, ValueError):
        raise ValueError("not a record of a run, or not a whole one") from None
    return recorded


def as_text(recorded: Record) -> str:
    """JSON with one row per line, so that a change of one number changes one line."""
    return _lines(recorded, 0) + "\n"


def _lines(value: Any, deep: int) -> str:
    """Return JSON with a line for each entry of a table or list of rows; what is deeper than states is on one."""
    if isinstance(value, Mapping) and deep < 2:
        brackets, entries = "{}", [f"{json.dumps(key)}: {_lines(entry, deep + 1)}" for key, entry in value.items()]
    elif isinstance(value, list) and deep < 3 and all(isinstance(row, list) for row in value):
        brackets, entries = "[]", [json.dumps(row, ensure_ascii=False) for row in value]
    else:
        return json.dumps(value, ensure_ascii=False)
    inner = ",\n".join(" " * (deep + 1) + entry for entry in entries)
    return f"{brackets[0]}\n{inner}\n{' ' * deep}{brackets[1]}" if inner else brackets


def first_change(expected: Record, actual: Record, tolerance: float = TOLERANCE) -> tuple[float, str] | None:
    """Time in s and description of the first difference in how the balls moved; None if there is none."""
    return min(changes(expected, actual, tolerance), default=None)


def changes(expected: Record, actual: Record, tolerance: float = TOLERANCE) -> list[tuple[float, str]]:
    """Time in s and description of the first difference of each ball, and of the first in the events; in order."""
    before, after = _courses(expected), _courses(actual)
    found = (_first_change(before.get(name, []), after.get(name, []), tolerance) for name in before | after)
    return sorted(change for change in found if change is not None)


def changed_results(
    expected: Record, actual: Record, tolerance: float = TOLERANCE, facts: Mapping[str, Fact] | None = None
) -> list[str]:
    """Return the other differences in words: results, with label and unit by the ``facts``, and how the run ended."""
    found, facts = [], facts or {}
    before, after = ({**recorded.get("result", {}), "ended": recorded.get("ended")} for recorded in (expected, actual))
    for name in [*before, *(name for name in after if name not in before)]:
        if before.get(name) is None and after.get(name) is None:  # it did not happen, and may be new
            continue
        if name not in after or name not in before:
            found.append(f"{name} is {'new' if name in after else 'gone'}")
        elif not _same(before[name], after[name], tolerance):
            unit = facts[name].unit if name in facts else ""
            now, then = (_word(value) + f" {unit}" * (value is not None) for value in (after[name], before[name]))
            label = facts[name].label if name in facts else ""
            shown = name if label in ("", name.replace("_", " ")) else f"{name} ({label})"
            found.append(f"{shown} is {now.rstrip()}, was {then.rstrip()}")
    return [*found, *_changed_words(expected, actual, [name for name in before if name in after])]


def _changed_words(expected: Record, actual: Record, facts: Sequence[str]) -> Iterator[str]:
    """Yield how label and unit of the ``facts``, and the verdict, differ; nothing of a record without them."""
    labels, names = expected.get("labels", {}), actual.get("labels", {})
    for name in facts if "labels" in expected else ():
        if labels.get(name) != names.get(name):
            yield f"{name} is labelled {_word(names.get(name, ''))}, was {_word(labels.get(name, ''))}"
    if "says" in expected and expected["says"] != actual["says"]:
        yield f"the verdict is {_word(actual['says'])}, was {_word(expected['says'])}"


def known_part(known: Record, actual: Record) -> tuple[Record, list[str]]:
    """Return a record without what an older one cannot have: facts, and kinds of events, that are new since; and the
    names of those. An older record without any fact or event is not whole: to it, none is new."""
    recorded, new = dict(actual), list[str]()
    facts = known.get("result")
    if facts and "result" in actual:
        new += [name for name in actual["result"] if name not in facts]
        recorded["result"] = {name: value for name, value in actual["result"].items() if name in facts}
    kinds = {event[1] for event in known["events"]}
    if kinds:
        new += dict.fromkeys(f"event {event[1]}" for event in actual["events"] if event[1] not in kinds)
        recorded["events"] = [event for event in actual["events"] if event[1] in kinds]
    return recorded, new


def merged(known: Record, actual: Record, tolerance: float = TOLERANCE) -> Record:
    """Return a new record with each number of the older one that is still the same, so that a file changes only where
    the run did: not in the last digits of another processor, nor by its versions if the motion is the same."""
    kept = dict(_with_known(known, actual, tolerance))
    kept["parameters"] = actual["parameters"]  # exact
    if first_change(known, known_part(known, actual)[0], tolerance) is None:
        kept["versions"] = known.get("versions", actual["versions"])
    return kept


def _with_known(known: Any, value: Any, tolerance: float) -> Any:
    """A new value with the parts of the older one that are the same; rows are found wherever they stand."""
    if _same(known, value, tolerance):
        return known
    if isinstance(known, dict) and isinstance(value, dict):
        return {key: _with_known(known.get(key), entry, tolerance) for key, entry in value.items()}
    if isinstance(known, list) and isinstance(value, list):
        return [next((row for row in known if _same(row, entry, tolerance)), entry) for entry in value]
    return value


def diverges(run: SceneRun, until: float | None = None, tolerance: float = TOLERANCE) -> float | None:
    """The time in s at which a run and one that begins ``_NUDGE`` away differ; None if they never do."""
    from sandbox.engine import simulate
    from sandbox.scene.running import nudged
    from sandbox.scene.scene_run import SceneRun

    recorded = record(run, until)
    nudged_run = SceneRun.of(simulate(nudged(run.setup, _NUDGE, 0), run.accuracy), run.scene, {})
    other = record(nudged_run, inf if until is None else until, recorded.get("duration"))  # without results
    change = first_change(recorded, other, tolerance)
    return None if change is None else change[0]


class _Entry(NamedTuple):
    """A state of a ball, or an event: when (s), what it is, and its numbers."""

    t: float
    what: str
    numbers: Mapping[str, float]


def _courses(recorded: Record) -> dict[str, list[_Entry]]:
    """The states of each ball by its name, and the events, by ""."""
    states = {
        ball: [_Entry(row[0], ball, dict(zip(_COLUMNS, row, strict=True))) for row in rows]
        for ball, rows in recorded["states"].items()
    }
    events = [
        _Entry(t, f"{ball} {kind} {partner}".rstrip(), {"t": t, "speed": speed})
        for t, kind, ball, partner, speed in recorded["events"]
    ]
    return {**states, "": events}


def _first_change(before: list[_Entry], after: list[_Entry], tolerance: float) -> tuple[float, str] | None:
    """The first entry that differs, is missing or is new."""
    for old, new in zip(before, after, strict=False):
        t = min(old.t, new.t)
        if old.what != new.what:
            return t, f"t = {t:.3g} s: {new.what}, was {old.what}"
        for name, then in old.numbers.items():
            now = new.numbers[name]
            if not _same(then, now, tolerance):
                return t, f"t = {old.t:.3g} s, {old.what}, {name} is {_amounts(now, then, _UNITS[name])}"
    both = min(len(before), len(after))
    for extra in (before[both:] or after[both:])[:1]:
        return extra.t, f"t = {extra.t:.3g} s: {extra.what} is {'gone' if len(before) > both else 'new'}"
    return None


def _amounts(now: float, then: float, unit: str) -> str:
    """Both numbers, with enough digits to tell them apart."""
    digits = next((n for n in range(4, _DIGITS) if f"{now:.{n}g}" != f"{then:.{n}g}"), _DIGITS)
    return f"{now:.{digits}g} {unit}, was {then:.{digits}g} {unit}"


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _same(a: Any, b: Any, tolerance: float = TOLERANCE) -> bool:
    """True if two values differ by no more than ``tolerance``, or by that share of themselves."""
    if _is_number(a) and _is_number(b):
        return abs(a - b) <= tolerance + tolerance * max(abs(a), abs(b))
    if isinstance(a, list) and isinstance(b, list):
        return len(a) == len(b) and all(_same(one, other, tolerance) for one, other in zip(a, b, strict=True))
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(_same(a[key], b[key], tolerance) for key in a)
    return type(a) is type(b) and a == b


def _rounded(value: Any) -> Any:
    if isinstance(value, float):
        return float(f"{value:.{_DIGITS}g}") + 0.0  # no negative zero
    if isinstance(value, list):
        return [_rounded(item) for item in value]
    if isinstance(value, dict):
        return {key: _rounded(item) for key, item in value.items()}
    return value


def _word(value: Any) -> str:
    text = f"{value:.{_DIGITS}g}" if isinstance(value, float) else json.dumps(value, ensure_ascii=False)
    return shortened(text, _LONGEST_WORD)
