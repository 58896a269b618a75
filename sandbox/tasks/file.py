"""The content of a task file, as it is written; ``parsing.py`` reads it against its scene."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal, get_args

from pydantic import Field

from sandbox import parameters as declared
from sandbox.errors import RequestError
from sandbox.files import from_here
from sandbox.parameters import Group, choice, group, groups
from sandbox.tasks.scoring import KINDS
from sandbox.toml import read_toml

#: Levels of difficulty.
LEVELS = 5
#: Most attempts at a task, and most shots of one attempt.
_MOST_ATTEMPTS = 100

#: The parts of the path of which one is shown while the player aims.
_Shown = Literal["all", "first contact", "one metre", "nothing"]
SHOWN: tuple[str, ...] = get_args(_Shown)

#: Keys that no scene file has: a file with one of them is taken for a task.
_ONLY_OF_TASKS = ("attempts", "controls", "score", "stars", "pass", "shown")


class StartEntry(Group):
    """One parameter that is drawn anew for each attempt: evenly from a range, or one of several values."""

    key: str = Field(description="the parameter, such as hoop.distance")
    low: Any = Field(None, description="lowest value, in the parameter's unit")
    high: Any = Field(None, description="highest value")
    values: list[Any] | None = Field(None, description="or the values, of which one is drawn")


class ControlEntry(Group):
    """One parameter that the player sets."""

    key: str = Field(description="the parameter, such as launch.angle")
    low: Any = Field(description="lowest value, in the parameter's unit")
    high: Any = Field(description="highest value")
    default: Any = Field(None, description="where it stands before the player sets it; left out: in the middle")
    noise: Any = Field(0.0, description="standard deviation of his aim: a number in the unit, or 1% of the value")


class ScoreEntry(Group):
    """The score: how the shots of all attempts are counted."""

    fact: str = Field(description="a fact of the scene, or made: the one that says that the shot scored")
    how: str = Field("sum", description=f"how the shots become a score: {', '.join(KINDS)}")
    target: Any = Field(None, description="nearest, points: the value of the fact that is aimed at, in its unit")
    rings: list[tuple[Any, float]] | None = Field(
        None, description="points: pairs of a distance from the target and what it is worth"
    )
    wanted: dict[str, Any] = Field(default_factory=dict, description="facts without which a shot counts nothing")


class TaskFile(Group):
    """A task file."""

    scene: str = Field(description="scene or preset, or the path of a scene of your own")
    goal: str = Field(description="the goal, in one sentence", min_length=1, max_length=120)
    level: int = Field(1, description="1 for the easiest of its scene, to 5", ge=1, le=LEVELS, strict=True)
    attempts: int = Field(description="how often the player may try", ge=1, le=_MOST_ATTEMPTS, strict=True)
    shots: int = Field(1, description="most shots of one attempt", ge=1, le=_MOST_ATTEMPTS, strict=True)
    shown: _Shown = choice("all", "how much of the path is shown")
    stars: list[Any] = Field(description="the scores for one, two and three stars", min_length=3, max_length=3)
    passing: Any = Field(description="the score that passes")
    goes_on: dict[str, Any] = Field(default_factory=dict, description="facts without which the attempt ends")
    ends: dict[str, Any] = Field(default_factory=dict, description="facts with which the attempt ends")
    set: dict[str, Any] = Field(default_factory=dict, description="what is not as in the scene, as in a scene file")
    start: list[StartEntry] = groups([], "what is drawn anew for each attempt")
    controls: list[ControlEntry] = groups(..., "what the player sets")
    score: ScoreEntry = group(..., "what counts")


def looks_like_task(values: Mapping[str, Any]) -> bool:
    """True if the tables of a file are those of a task and not of a scene."""
    return isinstance(values.get("goal"), str) or any(key in values for key in _ONLY_OF_TASKS)


def read_task_file(path: Path) -> TaskFile:
    """The task in a file. Raises RequestError, in a line with file, key and bound."""
    values, where = dict(read_toml(path)), from_here(path)
    score = values.get("score")
    if isinstance(score, str):  # score = "made"
        values["score"] = {"fact": score}
    if "passing" in values:
        raise RequestError(f"{where}: passing: unknown key; did you mean pass?")
    if "pass" in values:
        values["passing"] = values.pop("pass")
    try:
        found = declared.validate(TaskFile, values, where)
    except RequestError as error:
        line = str(error).replace(f"{where}: passing", f"{where}: pass").replace("mean passing?", "mean pass?")
        line = line.replace(", passing, ", ", pass, ")  # of the keys that there are
        raise RequestError(line) from None
    if not found.controls:
        raise RequestError(f"{where}: controls: the player sets nothing; add [[controls]] with key, low and high")
    return found
