"""Shots of a scene whose outcome is known: ``shots.toml`` in its folder. The pytest plugin checks them, also those of a
user's own scene; docs/your-own-scene.md says what the file may have."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import pytest
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from sandbox.errors import RequestError
from sandbox.scene import load, simulate
from sandbox.scene.discovery import as_path, installed_folder
from sandbox.toml import read_toml, short_toml

if TYPE_CHECKING:
    from sandbox.golden import Golden
    from sandbox.scene.scene_run import SceneRun

FILE = "shots.toml"
LONGEST = 80  # characters of a test's name


class _Row(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)

    preset: str = ""  # of the scene; empty for the scene itself
    set: dict[str, Any] = Field(default_factory=dict)  # changed parameters

    def name(self, scene: str) -> str:
        """Scene, preset and changes."""
        source = f"{scene}/{self.preset}" if self.preset else scene
        changes = ", ".join(f"{key} = {short_toml(value)}" for key, value in self.set.items())
        text = f"{source}, {changes}" if changes else source
        return text if len(text) <= LONGEST else f"{text[: LONGEST - 4]} ..."


class Shot(_Row):
    """One shot, and what is known of it."""

    golden: str | None = None  # of this name in the folder ``golden``
    until: float | None = None  # s; later, rounding decides
    verdict: str | None = None  # the result of that name
    says: str = ""  # in the sentence that says what happened
    card: dict[str, str | Literal[False]] = Field(default_factory=dict)  # texts by label; false for none
    refused: list[str] = Field(default_factory=list)  # in the error of a request that makes no sense


class _Trend(_Row):
    """A result that grows from value to value of a parameter, by ``least`` or more; 0 for not at all."""

    key: str
    values: list[Any]
    result: str
    least: float


class _KnownShots(BaseModel):
    """The content of a file of shots."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)

    scores: dict[str, list[str]] = Field(default_factory=dict)  # how verdicts begin where the fact of that name is true
    shot: list[Shot] = Field(default_factory=list)
    trend: list[_Trend] = Field(default_factory=list)


def known_shots(folder: Path) -> _KnownShots:
    """The shots in the folder of a scene, none where it has no such file. Raises RequestError."""
    file = folder / FILE
    try:
        return _KnownShots.model_validate(read_toml(file) if file.exists() else {})
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        place = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in first["loc"])
        raise RequestError(f"{file}: {place.lstrip('.')}: {first['msg']}") from None


def run_of(source: str, changes: Mapping[str, Any] | None = None) -> SceneRun:
    """The run of a scene or preset: computed once in a process, for all tests that only look at it."""
    return _computed(source, json.dumps(changes or {}))


@cache
def _computed(source: str, changes: str) -> SceneRun:
    return simulate(load(source, json.loads(changes)))


def _check_shot(source: str, shot: Shot, scores: Mapping[str, list[str]], golden: Golden) -> None:
    """Fail unless the shot is as it is known."""
    if shot.refused:
        with pytest.raises(RequestError) as refused:
            run_of(source, shot.set)
        text = str(refused.value)
        assert all(part in text for part in shot.refused), text
        assert "\n" not in text
        return
    run = run_of(source, shot.set)
    wrong = list(differences(run, shot, scores))
    if wrong:
        pytest.fail("\n".join(wrong), pytrace=False)
    if shot.golden is not None:
        golden.check(shot.golden, run, until=shot.until)


def differences(run: SceneRun, shot: Shot, scores: Mapping[str, list[str]]) -> Iterator[str]:
    """The differences of a run from what is known, a line each; ``scores`` are those of KnownShots."""
    word, sentence = run.result.get("verdict", ""), run.scene.verdict(run)
    if shot.verdict is not None and word != shot.verdict:
        yield f"verdict = {word!r}, not {shot.verdict!r}"
    if shot.says not in sentence:
        yield f"it says {sentence!r}, not {shot.says!r}"
    for fact, beginnings in scores.items():
        if run.result[fact] is not (word or sentence).startswith(tuple(beginnings)):
            yield f"{fact} = {run.result[fact]}, and the verdict is {word or sentence!r}"
    card = dict(run.scene.rows(run)) if shot.card else {}
    for label, text in shot.card.items():
        if card.get(label, False) != text:
            yield f"the card has {label} = {card.get(label, 'nothing')!r}, not {text!r}"


def _check_trend(source: str, trend: _Trend) -> None:
    """Fail unless the result grows as it is known."""
    found = [run_of(source, {**trend.set, trend.key: value}).result[trend.result] for value in trend.values]
    steps = [after - before for before, after in pairwise(found)]
    wrong = min(steps) < trend.least if trend.least else any(abs(step) > 1e-12 for step in steps)
    if wrong:
        pytest.fail(f"{trend.result} = {found} for {trend.key} = {trend.values}", pytrace=False)


class ShotsFile(pytest.File):
    """The shots of a scene as tests."""

    def collect(self) -> Iterator[pytest.Item]:
        folder = self.path.parent
        scene = folder.name if installed_folder(folder.name) == folder else as_path(folder)
        try:
            known = known_shots(folder)
        except RequestError as error:
            raise self.CollectError(str(error)) from None
        rows: list[Shot | _Trend] = [*known.shot, *known.trend]
        for row in rows:
            item = _KnownItem.from_parent(self, name=row.name(folder.name))
            item.row, item.scores = row, known.scores
            item.source = f"{scene}/{row.preset}" if row.preset else scene
            yield item


class _KnownItem(pytest.Item):
    """One shot, or one trend."""

    row: Shot | _Trend
    source: str
    scores: Mapping[str, list[str]]

    def runtest(self) -> None:
        if isinstance(self.row, Shot):
            from sandbox.golden import golden_of

            _check_shot(self.source, self.row, self.scores, golden_of(self))
        else:
            _check_trend(self.source, self.row)

    def reportinfo(self) -> tuple[Path, None, str]:
        return self.path, None, self.name
