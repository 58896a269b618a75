"""Messages of browsers: everything else is refused before anything is done with it."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, StringConstraints, TypeAdapter, ValidationError

from sandbox.errors import RequestError
from sandbox.serve.calls import ROOM
from sandbox.serve.limits import CHANGES, KEY, NAME, WORD
from sandbox.text import one_line
from sandbox.units import parse

_Key = Annotated[str, StringConstraints(max_length=KEY)]
_Word = Annotated[str, StringConstraints(max_length=WORD)]
_Value = bool | Annotated[float, Field(allow_inf_nan=False)] | _Word
_Changes = Annotated[dict[_Key, _Value], Field(max_length=CHANGES)]
_Number = Annotated[int, Field(ge=0, lt=2**53)]  # by which a browser recognises the answer
_Room = tuple[Annotated[int, Field(ge=100, le=4000)], Annotated[int, Field(ge=100, le=4000)]]  # px for a picture


class _Message(BaseModel):
    """Base of all messages: no unknown keys, no conversions."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)


class Hello(_Message):
    """The first message: who it is, again after a lost connection; and what a link asks for."""

    do: Literal["hello"]
    session: _Key = ""
    name: Annotated[str, StringConstraints(max_length=4 * NAME)] = ""
    source: _Key = ""
    changes: _Changes = {}


class Name(_Message):
    """Another name."""

    do: Literal["name"]
    name: Annotated[str, StringConstraints(max_length=4 * NAME)]


class Play(_Message):
    """Another scene; none where ``source`` is empty, while the player chooses."""

    do: Literal["play"]
    source: _Key
    changes: _Changes = {}


class Aim(_Message):
    """Compute something with these parameters: the path, the place or the fan."""

    do: Literal["path", "stage", "fan"]
    n: _Number
    changes: _Changes
    room: _Room = ROOM


class Shoot(_Message):
    """Let go, with what the player predicts of it if the teacher asks."""

    do: Literal["shoot"]
    n: _Number
    changes: _Changes
    room: _Room = ROOM
    predicted: Annotated[float, Field(allow_inf_nan=False)] | None = None


class Lead(_Message):
    """The teacher sets a scene for all, or lets everybody choose where ``source`` is empty."""

    do: Literal["lead"]
    source: _Key
    changes: _Changes = {}


class See(_Message):
    """The teacher looks at another scene, which nobody else notices."""

    do: Literal["see"]
    source: _Key


class Freeze(_Message):
    """The teacher stops everybody, or lets them go on."""

    do: Literal["freeze"]
    on: bool


class Predict(_Message):
    """The teacher asks for a prediction of a result before each shot; of none where ``fact`` is empty."""

    do: Literal["predict"]
    fact: _Key


class Present(_Message):
    """The teacher shows everybody one of the shots."""

    do: Literal["present"]
    n: _Number
    number: _Number
    room: _Room = ROOM


class Look(_Message):
    """The teacher asks who is there and who plays."""

    do: Literal["look"]


class Clear(_Message):
    """The teacher empties the table."""

    do: Literal["clear"]


_PUPIL: TypeAdapter[Any] = TypeAdapter(Annotated[Hello | Name | Play | Aim | Shoot, Field(discriminator="do")])
_TEACHER: TypeAdapter[Any] = TypeAdapter(
    Annotated[Hello | Aim | Lead | See | Freeze | Predict | Present | Look | Clear, Field(discriminator="do")]
)


def read(text: str, teacher: bool = False) -> Any:
    """The message. Raises RequestError with a line on what is wrong with it."""
    try:
        return (_TEACHER if teacher else _PUPIL).validate_json(text)
    except ValidationError as failure:
        raise RequestError(f"message refused: {_wrong(failure)}") from None


def _wrong(failure: ValidationError) -> str:
    """Return what is wrong with a message, in a line: where, and what must be there."""
    error = failure.errors(include_url=False, include_input=False)[0]
    if error["type"].startswith("union_tag"):
        return "what is to be done is not known"
    _, *where = error["loc"] or [""]
    if where[:1] == ["changes"] and len(where) > 1:
        if where[-1] == "[key]":
            return f"changes: a key has at most {KEY} characters"
        return f"{one_line(str(where[1]))[:KEY]}: must be a number, a word of at most {WORD} characters, true or false"
    if error["type"] == "too_long":
        return f"changes: at most {CHANGES} parameters may be changed"
    place = ".".join(map(str, where))[:KEY]
    return f"{place}{': ' if place else ''}{error['msg'].lower()}"


def named(name: str) -> str:
    """A name as it is shown: one line, without control characters, at most NAME characters."""
    shown = "".join(letter for letter in " ".join(name.split()) if letter.isprintable())
    return shown[:NAME].strip()


def in_units(changes: Mapping[str, Any], declared: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    """The changes of a link, in the units of the parameters: "150 mph" is a number of m/s. What is no amount stays."""
    found = dict(changes)
    for key, value in changes.items():
        known = declared.get(key)
        if isinstance(value, str) and known is not None and known["choices"] is None:
            with suppress(ValueError):
                found[key] = parse(value, known["unit"])
    return found


def check(changes: Mapping[str, Any], declared: Mapping[str, Mapping[str, Any]]) -> None:
    """Raise RequestError unless each key is that of a parameter that may be changed, and its value within bounds.

    ``declared`` are the parameters by key, as ``calls.described`` has them.
    """
    for key, value in changes.items():
        known = declared.get(key)
        if known is None:
            raise RequestError(f"{one_line(key)}: cannot be changed here")
        low, high, choices, unit = known["low"], known["high"], known["choices"], known["unit"]
        if choices is not None:
            if value not in choices or isinstance(value, bool) != isinstance(choices[0], bool):
                raise RequestError(f"{key}: choose from {', '.join(map(str, choices))}")
        elif isinstance(value, bool | str) or not low <= value <= high:
            raise RequestError(f"{key}: must be a number from {low:.10g} to {high:.10g} {unit}".rstrip())
