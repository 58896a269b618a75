"""Colours: those that all pictures share, from assets/palette.toml, and those of a scene, from its own folder."""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path
from typing import Any

from sandbox import resources

Colour = tuple[int, int, int]

ASSETS = resources.folder("assets")


def _colour(value: Any) -> Any:
    """#RRGGBB to (red, green, blue); lists (as tuples) and tables likewise; numbers stay."""
    if isinstance(value, str):
        return tuple(int(value[i : i + 2], 16) for i in (1, 3, 5))
    if isinstance(value, list):
        return tuple(_colour(item) for item in value)
    if isinstance(value, dict):
        return {key: _colour(item) for key, item in value.items()}
    return value


@cache
def _sections() -> dict[str, dict[str, Any]]:
    return _colour(tomllib.loads((ASSETS / "palette.toml").read_text("utf-8")))


def palette(section: str) -> dict[str, Any]:
    """One section of the palette, colours as (red, green, blue) from 0 to 255."""
    return _sections()[section]


@cache
def _usual(section: str) -> dict[str, Any]:
    return dict(_sections()[section])


def set_contrast(high: bool) -> None:
    """Give cards and their text more contrast, or the usual one, in everything that is drawn from now on."""
    _usual("card")
    _sections()["card"].update(_sections()["high_contrast"] if high else _usual("card"))


@cache
def scene_colours(file: str) -> dict[str, Any]:
    """The colours of a scene, from colours.toml in the folder of one of its files."""
    return _colour(tomllib.loads((Path(file).parent / "colours.toml").read_text("utf-8")))


def mix(a: Colour, b: Colour, share: float) -> Colour:
    """The colour that is ``share`` (0 to 1) of the way from a to b."""
    return tuple(round(p + (q - p) * share) for p, q in zip(a, b, strict=True))  # type: ignore[return-value]
