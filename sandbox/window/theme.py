"""The look of the panel: assets/theme.json with the colours of the palette and the type of the pictures."""

from __future__ import annotations

import json
from typing import Any

from sandbox.picture.palette import ASSETS, Colour, mix, palette

CARD = palette("card")
NAMED = {
    **{name: CARD[name] for name in ("background", "text", "quiet", "accent")},
    "raised": mix(CARD["background"], CARD["quiet"], 0.16),
    "lifted": mix(CARD["background"], CARD["quiet"], 0.3),
    "groove": mix(CARD["background"], CARD["quiet"], 0.1),
}


def _hex(colour: Colour) -> str:
    return "#{:02X}{:02X}{:02X}".format(*colour)


def _filled(node: Any) -> Any:
    """``$accent`` by its colour, at any depth."""
    if isinstance(node, dict):
        return {key: _filled(value) for key, value in node.items()}
    return _hex(NAMED[node[1:]]) if isinstance(node, str) and node.startswith("$") else node


def theme(pixels: int) -> dict[str, Any]:
    """For letters of ``pixels`` px."""
    found = _filled(json.loads((ASSETS / "theme.json").read_text("utf-8")))
    files = {f"{style}_path": str(ASSETS / "fonts" / f"NotoSans-{name}.ttf") for style, name in
             (("regular", "Regular"), ("bold", "Bold"), ("italic", "Regular"), ("bold_italic", "Bold"))}  # fmt: skip
    found["defaults"]["font"] = {"name": "noto", "size": str(pixels), "bold": "0", "italic": "0", **files}
    found["#title"]["font"] = {"name": "noto", "size": str(pixels), "bold": "1", "italic": "0", **files}
    return found
