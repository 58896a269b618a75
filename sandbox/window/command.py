"""``sandbox play``: the window."""

from __future__ import annotations

from typing import Any

import click

from sandbox.cli.arguments import changes_options, load


@click.command()
@click.argument("scene", metavar="[SCENE]", required=False, help="A scene, preset, scene file, task or replay file.")
@changes_options
@click.option("--scene", "scene_of_replay", metavar="FOLDER", help="The scene of a replay file.")
@click.option("--game", metavar="NAME", help="A game for two in the scene, such as nine-ball of billiards.")
@click.option("--two", is_flag=True, help="Two players take turns at the task.")
def play(scene: str | None, changes: dict[str, Any], scene_of_replay: str | None, game: str | None, two: bool) -> None:
    """Open the window: pull back anywhere and let go to shoot. H lists the keys.

    Without SCENE it begins with a tile for each sport. SCENE may also be a task (sandbox tasks lists them), or a replay
    file, which contains no code: if its scene is not installed, --scene names the folder.

    \b
    Examples:
      sandbox play
      sandbox play golf
      sandbox play basketball/free-throw
      sandbox play free-throw --two
      sandbox play billiards --game nine-ball
      sandbox play --scene ./volleyball out/volleyball-1.replay.json
    """
    from sandbox.window.app import play as play_in_window

    if scene is not None and any("[" in key for key in changes):  # the window keeps changes by whole parameters
        from sandbox.parameters import without_indices

        changes = without_indices(load(scene, {}).parameters, changes, "--set")
    play_in_window(scene, changes, scene_of_replay, game, 1 + two)
