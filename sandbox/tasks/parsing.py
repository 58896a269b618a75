"""Reading a task file against its scene: every key, fact, bound and unit in it is checked."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from math import inf, isfinite
from pathlib import Path
from typing import Any

from sandbox import parameters as declared
from sandbox import scene as scenes
from sandbox import units
from sandbox.errors import RequestError
from sandbox.files import from_here
from sandbox.scene.discovery import is_installed
from sandbox.tasks.discovery import find_task, tasks
from sandbox.tasks.file import ScoreEntry, TaskFile, read_task_file
from sandbox.tasks.scoring import KINDS, Condition, Score
from sandbox.tasks.task import Control, Start, Task
from sandbox.text import nearest, no_such_result, with_noun
from sandbox.toml import short_toml


def load(source: str | Path) -> Task:
    """The task of that name, or in that file. Raises RequestError, in a line with file, key and bound."""
    path = find_task(source)
    return _Reader(path, read_task_file(path)).task()


class _Reader:
    """Reads a task file against its scene; messages name the file and the key."""

    def __init__(self, path: Path, file: TaskFile) -> None:
        self.file, self.path, self.where = file, path, from_here(path)
        if not file.goal.isprintable():
            raise self.wrong(f"goal = {short_toml(file.goal)}: must be one line of printable characters")
        written, own = file.scene, path.resolve().parent.parent
        source: str | Path = path.parent / written if written.startswith(("./", "../")) else written
        name, _, preset = written.partition("/")
        if name == own.name and path.resolve().parent.name == "tasks" and (own / "scene.py").is_file():
            source = name if is_installed(own) else str(own)  # in the folder of its own scene
            source += f"/{preset}" if preset else ""
        try:
            base = scenes.load(source)
        except RequestError as error:
            raise RequestError(f"{self.where}: scene = {short_toml(written)}: {error}") from None
        self.scene = scenes.load(source, file.set, overrides_from=f"{self.where}: set") if file.set else base
        self.declared = {it.key: it for it in declared.walk(self.scene.parameters, entries=True)}

    def task(self) -> Task:
        file = self.file
        start = tuple(self.start(place) for place in range(len(file.start)))
        controls = tuple(self.control(place) for place in range(len(file.controls)))
        keys = [*(each.key for each in start), *(each.key for each in controls)]
        twice = next((key for key in keys if keys.count(key) > 1), None)
        if twice is not None:
            raise self.wrong(f"{twice}: is given twice in start and controls")
        score, stars, passing = self.scored()
        if file.shots > 1 and self.scene.controls.next_start is None:
            raise self.wrong(f"shots = {file.shots}: a shot of {self.scene.name} does not go on from the one before")
        goes_on, ends = (tuple(self.conditions(name, getattr(file, name))) for name in ("goes_on", "ends"))
        return Task(
            name=self.path.stem,
            goal=file.goal,
            level=file.level,
            scene=self.scene,
            start=start,
            controls=controls,
            shown=file.shown,
            attempts=file.attempts,
            shots=file.shots,
            score=score,
            stars=stars,
            passing=passing,
            goes_on=goes_on,
            ends=ends,
            file=self.path,
        )

    def scored(self) -> tuple[Score, tuple[float, float, float], float]:
        """The rule of the score, and the scores for stars and to pass. Raises RequestError."""
        file, score = self.file, self.score(self.file.score)
        first, second, third = (self.number("stars", value, score.total_unit) for value in file.stars)
        passing = self.number("pass", file.passing, score.total_unit)
        if [first, second, third] != sorted((first, second, third), reverse=score.lower_is_better):
            order = "falling: a smaller score is better" if score.lower_is_better else "rising"
            raise self.wrong(f"stars = {short_toml(file.stars)}: must be {order}")
        best, end = score.best_total(file.attempts, file.shots), "least" if score.lower_is_better else "most"
        for what, value in {"pass": passing, "stars[2]": third}.items():
            if not score.reaches(best, value):
                number, bound = (f"{each:g} {score.total_unit}".rstrip() for each in (value, best))
                attempts = with_noun(file.attempts, "attempt")
                raise self.wrong(f"{what} = {number}: {attempts} can reach {bound} at {end}")
        return score, (first, second, third), passing

    def wrong(self, message: str) -> RequestError:
        return RequestError(f"{self.where}: {message}")

    def parameter(self, what: str, key: str) -> declared.Parameter:
        """The scene's parameter with this key. Raises RequestError."""
        found = self.declared.get(key)
        if found is None:
            near = nearest(key, list(self.declared))
            hint = f"did you mean {near}?" if near else f"sandbox schema {self.scene.name} shows all keys"
            raise self.wrong(f'{what} = "{key}": {self.scene.name} has no such parameter; {hint}')
        return found

    def start(self, place: int) -> Start:
        entry, what = self.file.start[place], f"start[{place}]"
        known = self.parameter(f"{what}.key", entry.key)
        if entry.values is not None:
            if entry.low is not None or entry.high is not None or not entry.values:
                raise self.wrong(f"{what}, {entry.key}: give either low and high, or a list of values")
            return Start(entry.key, known.unit or "", values=tuple(self.valid(what, known, it) for it in entry.values))
        low, high = self.range(what, known, entry.low, entry.high)
        return Start(entry.key, known.unit or "", low, high)

    def control(self, place: int) -> Control:
        entry, what = self.file.controls[place], f"controls[{place}]"
        known = self.parameter(f"{what}.key", entry.key)
        low, high = self.range(what, known, entry.low, entry.high)
        default = 0.5 * (low + high)
        if entry.default is not None:
            default = self.number(f"{what}.default", entry.default, known.unit or "")
            if not low <= default <= high:
                raise self.wrong(
                    f"{what}.default = {default:g}: must be from {low:g} to {high:g} {known.unit}".rstrip()
                )
        sd, share = self.noise(f"{what}.noise", entry.noise, known.unit or "")
        return Control(known.key, known.unit or "", known.meaning, low, high, default, sd, share, known.bounds)

    def valid(self, what: str, known: declared.Parameter, value: Any) -> Any:
        """A value that the scene takes for a parameter. Raises RequestError."""
        changed = self.scene.changed({known.key: value}, f"{self.where}: {what},")
        return declared.value_at(changed.parameters, known.key)

    def range(self, what: str, known: declared.Parameter, low: Any, high: Any) -> tuple[float, float]:
        """The ends of a range within the scene's bounds. Raises RequestError."""
        if known.low is None or known.high is None:
            raise self.wrong(f"{what}, {known.key}: is not a number, and has no range; give values")
        ends = []
        for name, given in (("low", low), ("high", high)):
            if given is None:
                raise self.wrong(f"{what}, {known.key}: {name} is missing")
            number = self.number(f"{what}.{name}", given, known.unit or "")
            if not known.low <= number <= known.high:
                bounds = f"from {known.low:g} to {known.high:g} {known.unit}".rstrip()
                raise self.wrong(f"{what}.{name} = {short_toml(given)}: {known.key} must be {bounds}")
            ends.append(number)
        if ends[0] >= ends[1]:
            raise self.wrong(f"{what}, {known.key}: low = {ends[0]:g} must be below high = {ends[1]:g}")
        return ends[0], ends[1]

    def noise(self, what: str, given: Any, unit: str) -> tuple[float, float]:
        """A standard deviation, and one as a share of the value. Raises RequestError."""
        is_share = isinstance(given, str) and given.strip().endswith("%") and unit != "%"
        number = self.number(what, given.strip()[:-1] if is_share else given, "" if is_share else unit)
        if number < 0.0:
            raise self.wrong(f"{what} = {short_toml(given)}: a standard deviation is 0 or more")
        return (0.0, 0.01 * number) if is_share else (number, 0.0)

    def number(self, what: str, given: Any, unit: str) -> float:
        """A number in a unit, which text may have of its own. Raises RequestError."""
        try:
            value = units.parse(given, unit) if isinstance(given, str) else given
        except ValueError as error:
            raise self.wrong(f"{what} = {short_toml(given)}: {error}") from None
        if isinstance(value, bool) or not isinstance(value, int | float) or not isfinite(value):
            raise self.wrong(f"{what} = {short_toml(given)}: must be a number" + (f" in {unit}" if unit else ""))
        return float(value)

    def fact(self, what: str, name: str) -> str:
        """A fact of the scene; ``made`` is the one that says that a shot scored. Raises RequestError."""
        facts = self.scene.facts
        if name not in facts and name == "made" and self.scene.controls.scores:
            return self.scene.controls.scores
        if name not in facts:
            raise self.wrong(f'{what} = "{name}": {no_such_result(name, list(facts))}')
        return name

    def score(self, entry: ScoreEntry) -> Score:
        kind = KINDS.get(entry.how)
        if kind is None:
            *others, last = (f'"{name}"' for name in KINDS)
            raise self.wrong(f"score.how = {short_toml(entry.how)}: must be {', '.join(others)} or {last}")
        name = self.fact("score.fact", entry.fact)
        fact, takes = self.scene.facts[name], {each.name for each in fields(kind)}
        given: dict[str, Any] = {}
        if entry.target is not None:
            given["target"] = self.number("score.target", entry.target, fact.unit)
        if entry.rings is not None:
            rings = sorted(
                (self.number("score.rings", distance, fact.unit), points) for distance, points in entry.rings
            )
            given["rings"] = tuple(rings)
        for key in given:
            if key not in takes:
                raise self.wrong(f'score.how = "{entry.how}": has no {key}')
        if "rings" in takes and not given.get("rings"):
            raise self.wrong(f'score.how = "{entry.how}": needs rings, such as [[0.1, 10], [0.5, 5]]')
        most = fact.most if fact.most is not None else 1.0 if name == self.scene.controls.scores else inf
        wanted = tuple(self.conditions("score.wanted", entry.wanted))
        return kind(name, fact.unit, wanted=wanted, word=fact.label or "made", most=most, **given)

    def conditions(self, what: str, table: Mapping[str, Any]) -> Iterator[Condition]:
        """The facts of a table, each with its value or range. Raises RequestError."""
        for name, given in table.items():
            fact = self.fact(what, name)
            unit = self.scene.facts[fact].unit
            if isinstance(given, list):
                if len(given) != 2:
                    raise self.wrong(f"{what}.{name} = {short_toml(given)}: a range is a list of its two ends")
                low, high = (self.number(f"{what}.{name}", end, unit) for end in given)
                if low > high:
                    raise self.wrong(f"{what}.{name} = {short_toml(given)}: write the lower end first")
                yield Condition(fact, within=(low, high))
            elif isinstance(given, str) and unit:
                yield Condition(fact, self.number(f"{what}.{name}", given, unit))
            elif isinstance(given, bool | str | int | float):
                yield Condition(fact, given)
            else:
                raise self.wrong(
                    f"{what}.{name} = {short_toml(given)}: must be a number, a word, true, false or a range"
                )


@dataclass(frozen=True)
class TaskListing:
    """One task as ``sandbox tasks`` shows it."""

    name: str
    scene: str
    level: int
    goal: str
    attempts: int
    score: str


def listed() -> Iterator[TaskListing]:
    """Every installed task, scene by scene in rising order of difficulty."""
    for name in tasks():
        task = load(name)
        yield TaskListing(name, task.scene.title, task.level, task.goal, task.attempts, task.score.summary)
