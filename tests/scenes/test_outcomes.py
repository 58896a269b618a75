"""What becomes of a shot at other accuracies, or with parts left out; the rest is in the shots.toml of each scene."""

from __future__ import annotations

from typing import Any

import pytest

import sandbox
from sandbox.scene import listings
from sandbox.scene.discovery import installed_folders
from sandbox.shots import Shot, differences, known_shots
from tests.scenes.play import run_of

FOLDERS = installed_folders()
#: The shots without changes of each scene whose outcome is known, in their folders, and on which rounding has no say.
SHOTS = {
    shot.name(scene): (known.scores, shot)
    for scene, folder in sorted(FOLDERS.items())
    for known in [known_shots(folder)]
    for shot in known.shot
    if not shot.set and not shot.refused
}
STEADY = [source for source, (_, shot) in SHOTS.items() if shot.until is None and (shot.golden or shot.says)]


@pytest.mark.parametrize("source", STEADY)
def test_presets_are_the_same_at_every_accuracy(source: str):
    run, (scores, _) = run_of(source), SHOTS[source]
    usual = Shot(verdict=run.result.get("verdict", ""), says=run.scene.verdict(run))
    for level in ("fast", "precise"):
        assert list(differences(run_of(source, {"accuracy.level": level}), usual, scores)) == []


def test_every_preset_of_a_sport_that_scores_is_here():
    scoring = {name for name, folder in FOLDERS.items() if known_shots(folder).scores}
    wanted = {listing.name for listing in listings() if listing.name.partition("/")[0] in scoring}
    assert wanted - {"baseball/de-la-cruz-2024"} <= SHOTS.keys()


def test_every_scene_has_a_golden_run():
    assert {source for source, (_, shot) in SHOTS.items() if shot.golden} >= FOLDERS.keys()


@pytest.mark.parametrize(
    ("source", "changes", "names"),
    [
        ("basketball", {}, "Gravity Drag NetDrag"),
        ("basketball", {"ball.lift.model": "none", "net.slows": False}, "Gravity Drag"),
        ("soccer", {"ball.lift.model": "none", "ball.drag.model": "none"}, "Gravity"),
        ("soccer", {"air.density": 0, "gravity": 0}, ""),
    ],
)
def test_an_effect_left_out_is_an_absent_term(source: str, changes: dict[str, Any], names: str):
    forces = sandbox.load(source, changes).build().balls[0].forces
    assert " ".join(type(force).__name__ for force in forces) == names


@pytest.mark.parametrize(
    ("scene", "key"),
    [
        ("basketball", "release.height"),
        ("football", "launch.height"),
        ("volleyball", "launch.height"),
        ("throws", "release.height"),
        ("baseball", "release.height"),
        ("tennis", "release.height"),
    ],
)
def test_a_launch_from_height_0_begins_on_the_ground(scene: str, key: str):
    """As the first lesson on a parabola does."""
    run = sandbox.simulate(sandbox.load(scene, {key: 0.0}))
    assert 0.0 <= run.state("ball", 0.0)[1] <= 0.15


def test_a_launch_is_told_as_it_was_given():
    """Though its velocity is a sine and a cosine of it."""
    values = {"launch.angle": -28.8, "launch.speed": 28.7, "launch.spin": 2801.1}
    result = sandbox.simulate(sandbox.load("golf", values | {"ball.radius": 0.02})).result
    assert (result["launch_angle"], result["ball_speed"], result["launch_spin"]) == (-28.8, 28.7, 2801.1)
