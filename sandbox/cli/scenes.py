"""The commands about scenes themselves: ``list``, ``schema``, ``new``, ``play``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from sandbox.cli.arguments import changes_options, load, prints_to_stderr, say, scene_argument
from sandbox.errors import RequestError


@click.command("list")
@click.argument("scene", metavar="[SCENE]", required=False, help="Only this scene and its presets.")
@click.option("--keys", is_flag=True, help="All keys of SCENE's file: default, unit, bounds, meaning.")
def list_scenes(scene: str | None, keys: bool) -> None:
    """List all scenes and presets, and what is in this folder.

    \b
    Examples:
      sandbox list golf
      sandbox list golf --keys
    """
    from sandbox.lab.tables import table
    from sandbox.scene import listings, listings_in, listings_of

    if keys:
        from sandbox.keys import key_table

        if scene is None:
            raise RequestError("list --keys: of which scene? For example: sandbox list golf --keys")
        say("\n".join(key_table(load(scene, {}).parameters)))
        return
    found = [*listings(), *listings_in(Path())] if scene is None else listings_of(scene)
    say("\n".join(table(("", ""), [(listing.name, listing.about) for listing in found], "ll", indent="")))


@click.command()
@scene_argument
@click.option("--tasks", is_flag=True, help="Of the scene's task files instead.")
def schema(scene: str, tasks: bool) -> None:
    """Print the JSON schema of a scene's file.

    It has every key with its unit, bounds and meaning.

    \b
    Examples:
      sandbox schema golf > golf.schema.json     # an editor then completes and checks golf.toml
      sandbox schema golf --tasks > task.schema.json
    """
    import json

    prints_to_stderr(click.get_current_context())
    from sandbox.scene import parameters_of
    from sandbox.schema import json_schema

    if tasks:
        from sandbox.tasks.schema import task_schema

        made = task_schema(load(scene, {}))
    else:
        name, parameters = parameters_of(scene)
        made = json_schema(parameters, name)
    say(json.dumps(made, indent=2))


@click.command()
@click.argument("name", metavar="NAME", type=Path, help="Folder to create; it names the scene.")
@click.option("--from-above", is_flag=True, help="Seen from above, not from the side.")
@click.option("--from", "copied", metavar="SCENE", help="A copy of this scene, instead of a simple one.")
def new(name: Path, from_above: bool, copied: str | None) -> None:
    """Create a working scene to edit.

    \b
    Examples:
      sandbox new beachvolley
      sandbox run ./beachvolley
      sandbox new my-golf --from golf
    """
    from sandbox.new import FROM_ABOVE, FROM_SIDE, new_scene, next_steps

    if from_above and copied is not None:
        raise RequestError(f"new {name}: give --from-above or --from {copied}, not both")
    files = new_scene(name, FROM_ABOVE if from_above else FROM_SIDE, copied)
    say("\n".join([*(f"wrote {file}" for file in files), "", *next_steps(name)]))


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

    def page_of(session: Any) -> str:
        from sandbox.page.task import session_page

        return session_page(session)

    play_in_window(scene, changes, scene_of_replay, game, 1 + two, page_of)
