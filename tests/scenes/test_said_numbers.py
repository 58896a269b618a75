"""Numbers that the text of a scene file has from a run: each is that of the run."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import pytest

import sandbox

Result = Mapping[str, Any]
MPH, YARD, INCH, SOUND = 0.44704, 0.9144, 0.0254, 340.3  # m/s, m, m, m/s

#: Preset, changes, and what its file says of a run with them; ``usual`` is the result of the scene's default.
SAID: list[tuple[str, dict[str, Any], Callable[[Result, Result], str]]] = [
    (
        "golf/club-head",
        {},
        lambda it, _: (
            f"here {it['ball_speed'] / MPH:.0f} mph, {it['launch_angle']:.1f} deg, "
            f"{it['launch_spin']:,.0f} rpm and {it['carry'] / YARD:.0f} yd"
        ),
    ),
    ("golf/headwind", {}, lambda it, _: f"drops {round(it['distance_to_pin'], -1):.0f} m short"),
    ("rocket/grenade", {}, lambda it, _: f"takes it to {it['top_speed']:.0f} m/s"),
    ("soccer-curl/beckham-2001", {}, lambda it, _: f"It arrives at {it['speed_at_goal']:.1f} m/s"),
    ("soccer/goal-kick-in-a-gale", {"air.wind": [0, 0]}, lambda it, _: f"gale: {it['carry']:.0f} m on a calm day"),
    ("soccer/goal-kick-in-a-gale", {"air.wind": [0, 0]}, lambda it, _: f"goes {it['carry']:.0f} m through the air"),
    (
        "baseball-pitch/sinker",
        {},
        lambda it, usual: f"it falls {(usual['plate_height'] - it['plate_height']) / INCH:.0f} in more",
    ),
    ("bullet/22-lr", {}, lambda it, _: f"subsonic from the {'muzzle' if it['ball_speed'] < SOUND else 'middle'}"),
    (
        "bullet",
        {"bullet.coefficient": 0.214},
        lambda it, usual: f"0.214 drops {usual['height'] - it['height']:.1f} m more over 1,000 yd",
    ),
]


@pytest.mark.parametrize(("name", "changes", "said"), SAID)
def test_the_file_says_what_a_run_gives(name: str, changes: dict[str, Any], said: Callable[[Result, Result], str]):
    scene, _, preset = name.partition("/")
    result = sandbox.simulate(sandbox.load(name, changes)).result
    usual = sandbox.simulate(sandbox.load(scene)).result
    folder = sandbox.load(scene).folder
    file = folder / "presets" / f"{preset}.toml" if preset else folder / f"{scene}.toml"
    text = " ".join(file.read_text("utf-8").replace("#", " ").split())
    assert " ".join(said(result, usual).split()) in text
