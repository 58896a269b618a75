"""The theme of the panel: assets/theme.json with the palette's colours and the pictures' fonts."""

from __future__ import annotations

import json
from typing import Any

from sandbox.picture.palette import ASSETS, Colour, mix, palette

CARD = palette("card")


def named() -> dict[str, Colour]:
    """The colours of the theme."""
    return {
        **{name: CARD[name] for name in ("background", "text", "quiet", "accent")},
        "raised": mix(CARD["background"], CARD["quiet"], 0.16),
        "lifted": mix(CARD["background"], CARD["quiet"], 0.3),
        "groove": mix(CARD["background"], CARD["quiet"], 0.1),
    }


#: Elements with text.
WRITTEN_ON = ("button", "label", "text_entry_line", "drop_down_menu", "text_box")
#: Lengths in px on 720 rows, by element.
LENGTHS = {
    "drop_down_menu": {"open_button_width": 20},
    "horizontal_slider": {"sliding_button_width": 14},
    "selection_list": {"list_item_height": 21},
    "tool_tip": {"rect_width": 260},
}


def _hex(colour: Colour) -> str:
    return "#{:02X}{:02X}{:02X}".format(*colour)


def _filled(node: Any) -> Any:
    """Replace names such as ``$accent`` by their colours, at any depth."""
    if isinstance(node, dict):
        return {key: _filled(value) for key, value in node.items()}
    return _hex(named()[node[1:]]) if isinstance(node, str) and node.startswith("$") else node


def theme(unit: float) -> dict[str, Any]:
    """The theme for a panel on which 1 px on 720 rows is ``unit`` px."""
    found = _filled(json.loads((ASSETS / "theme.json").read_text("utf-8")))
    files = {f"{style}_path": str(ASSETS / "fonts" / f"NotoSans-{name}.ttf") for style, name in
             (("regular", "Regular"), ("bold", "Bold"), ("italic", "Regular"), ("bold_italic", "Bold"))}  # fmt: skip
    upright = {"size": str(max(11, round(14 * unit))), "bold": "0", "italic": "0"}
    for element in WRITTEN_ON:  # pygame_gui reads no font from the defaults
        found.setdefault(element, {})["font"] = {"name": "noto", **upright, **files}
    found["drop_down_menu.#expand_button"] = {"font": {"name": "fira_code_symbols", **upright}}  # pygame_gui's, for ▼
    for element, lengths in LENGTHS.items():
        misc = found.setdefault(element, {}).setdefault("misc", {})
        misc |= {name: str(round(length * unit)) for name, length in lengths.items()}
    return found
