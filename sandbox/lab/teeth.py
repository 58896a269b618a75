"""A test of each published number: could it have shown that a model is wrong? Its effect is left out, or changed.

A row of ``validate`` names the effects that it is to show. Each is one of

- the cause of a force or torque, such as ``drag``, ``lift``, ``gravity``: left out, then 0.8 and 1.2 times as much;
- the key of a parameter, such as ``court.friction``: 0, then 0.8 and 1.2 times as much, within its bounds;
- ``key=value``: this in place of what the row has.

The row has teeth if each effect makes it fall in at least one of these ways.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from sandbox.engine.model.accuracy import resolve
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import Setup
from sandbox.engine.motion.forces_on_ball import cause
from sandbox.errors import RequestError, SandboxError
from sandbox.lab.published import assignments
from sandbox.lab.report import Report, Table, words
from sandbox.lab.runs import Progress, no_progress
from sandbox.lab.validate import Compared, MostOften, cells, compare, most_often_in, scene_of
from sandbox.parameters import walk
from sandbox.scene import Scene
from sandbox.scene.running import simulate_at
from sandbox.scene.scene_run import SceneRun

#: Factors of an effect, and how they are called.
_FACTORS = {0.0: "off", 0.8: "-20 %", 1.2: "+20 %"}
_FIFTH = (_FACTORS[0.8], _FACTORS[1.2])


@dataclass(frozen=True)
class Trial:
    """A row computed with an effect changed."""

    effect: str
    change: str  # "off", "-20 %", "+20 %", or the new setting
    computed: Any  # in the unit of the row; None if the changed run lacks it, or fails
    falls: bool


@dataclass(frozen=True)
class Tried:
    """A row that holds, and what became of it."""

    row: Compared
    trials: list[Trial]

    def unnoticed(self, *changes: str) -> list[str]:
        """The effects that it does not show by these changes, or by another setting; by default by any change."""
        effects = dict.fromkeys(trial.effect for trial in self.trials)
        by = {*(changes or _FACTORS.values()), *effects}
        shown = {trial.effect for trial in self.trials if trial.falls and trial.change in by}
        return [effect for effect in effects if effect not in shown]

    @property
    def has_teeth(self) -> bool:
        """True if it names an effect, and shows all that it names."""
        return bool(self.trials) and not self.unnoticed()


def teeth(
    rows: Sequence[Compared], changes: Mapping[str, Any] | None = None, progress: Progress = no_progress
) -> list[Tried]:
    """Change the effects of every row that holds; those that do not hold are left out. ``changes`` are of all rows."""
    holding, runs, tried = [row for row in rows if row.holds], {}, []
    for done, row in enumerate(holding):
        progress(done, len(holding))
        trials = []
        for effect in filter(None, (part.strip() for part in row.tests.split(";"))):
            key = row.scene, row.set, row.vary, effect
            if key not in runs:
                runs[key] = list(_changed(scene_of(row, changes), effect, row.vary))
            for change, run in runs[key]:
                again = None if run is None else compare(row, run)
                falls = again is None or not again.holds
                trials.append(Trial(effect, change, None if again is None else again.computed, falls))
        tried.append(Tried(row, trials))
    return tried


def _changed(scene: Scene, effect: str, vary: str) -> Iterator[tuple[str, SceneRun | MostOften | None]]:
    """Each change of an effect, and the run with it; None where it fails. RequestError if there is no such effect."""
    if "=" in effect:
        other = scene.changed(assignments(effect))
        yield effect, most_often_in(other, vary) if vary else _run(other)
        return
    if vary:
        raise RequestError(f"{scene.name}: {effect!r}: a row with vary names its effects as key=value")
    parameter = next((each for each in walk(scene.parameters, entries=True) if each.key == effect), None)
    if parameter is not None and parameter.value is None:
        raise RequestError(f"{scene.name}: {effect} is left out here: name another value, as in {effect}=0.1")
    if parameter is not None:
        values = {change: parameter.within(factor * parameter.value) for factor, change in _FACTORS.items()}
        for change, value in values.items():
            if value != parameter.value:
                yield change, _run(scene.changed({effect: value}))
        return
    setup = scene.build()
    if not any(cause(term) == effect for ball in setup.balls for term in (*ball.forces, *ball.torques)):
        raise RequestError(f"{scene.name}: {effect!r} is neither a force of this run nor a parameter")
    for factor, change in _FACTORS.items():
        yield change, _run(scene, _scaled(setup, effect, factor))


def _run(scene: Scene, setup: Setup | None = None) -> SceneRun | None:
    try:
        return simulate_at(scene, resolve(**scene.parameters.accuracy.model_dump()), setup)
    except SandboxError:
        return None


@dataclass(frozen=True)
class _Times:
    """A force, torque or coefficient, multiplied."""

    term: Any
    factor: float

    @property
    def __name__(self) -> str:
        """Facts that ask for a force by its cause find it."""
        return str(getattr(self.term, "__name__", type(self.term).__name__))

    def __call__(self, *arguments: Any) -> Any:
        result = self.term(*arguments)
        return tuple(self.factor * part for part in result) if isinstance(result, tuple) else self.factor * result


def _scaled(setup: Setup, effect: str, factor: float) -> Setup:
    def of(terms: Sequence[Any]) -> list[Any]:
        changed = (_Times(term, factor) if cause(term) == effect else term for term in terms)
        return [term for term in changed if not (isinstance(term, _Times) and factor == 0.0)]

    def ball(one: Ball) -> Ball:
        return replace(one, forces=of(one.forces), torques=of(one.torques))

    return replace(setup, balls=[ball(one) for one in setup.balls])


# ------------------------------------------------------------------------------------------------------------- report


def report_of(rows: Sequence[Compared], tried: Sequence[Tried]) -> Report:
    """The rows that hold though an effect that they name is left out; those that hold with a fifth of it more and less;
    and how many do not."""
    blunt = [(one, one.unnoticed()) for one in tried if not one.has_teeth]
    weak = [(one, one.unnoticed(*_FIFTH)) for one in tried if one.has_teeth]
    sections = [
        _table("rows that hold whatever their effect is", blunt),
        _table("rows that fall only without it", weak),
    ]
    return Report(partial(_document, rows, tried), summary(tried), sections)


def _document(rows: Sequence[Compared], tried: Sequence[Tried]) -> list[dict[str, Any]]:
    """The rows, each with ``trials`` and ``has_teeth``; None for those that do not hold."""
    of_row = {id(one.row): one for one in tried}
    found = ((row, of_row.get(id(row))) for row in rows)
    return [
        {**vars(row), "trials": one and [vars(each) for each in one.trials], "has_teeth": one and one.has_teeth}
        for row, one in found
    ]


def _table(title: str, found: Sequence[tuple[Tried, list[str]]]) -> Table:
    rows = []
    for one, effects in found:
        if effects or not one.trials:
            case, result, *_ = cells(one.row)
            rows.append((f"{one.row.sport} {case}", result, ", ".join(effects) or "none named"))
    return Table([words("case"), words("result"), words("effect")], rows, title)


def summary(tried: Sequence[Tried]) -> str:
    """Count those that fall, in a sentence."""
    sharp = [one for one in tried if one.has_teeth]
    fifth = sum(not one.unnoticed(*_FIFTH) for one in sharp)
    without = f"{len(sharp)} of {len(tried)} rows that hold fall without their effect"
    return f"{without}, {fifth} with a fifth more or less of it"
