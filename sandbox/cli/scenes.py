"""The commands about scenes themselves: ``list``, ``schema``, ``new``, ``play``."""

from __future__ import annotations

from itertools import zip_longest
from pathlib import Path
from typing import Annotated

import typer

from sandbox.cli.arguments import Level, SceneArgument, Settings, changes
from sandbox.cli.say import say
from sandbox.text import one_line


def list_scenes(
    scene: Annotated[
        str | None, typer.Argument(metavar="[SCENE]", help="Only this scene and its presets.", show_default=False)
    ] = None,
) -> None:
    """List all scenes and presets, and the scenes and scene files in this folder."""
    import textwrap

    from sandbox.lab.tables import width
    from sandbox.scene import listings, listings_in, listings_of, scene_files_in

    here = Path()
    found = [*listings(), *listings_in(here), *scene_files_in(here)] if scene is None else listings_of(scene)
    left = max((len(listing.name) for listing in found), default=0) + 2
    for listing in found:  # not by tables.table, whose library takes a third of the command's time
        about = textwrap.wrap(one_line(listing.about), max(20, width() - left)) or [""]
        say(
            "\n".join(
                f"{name:<{left}}{line}".rstrip() for name, line in zip_longest([listing.name], about, fillvalue="")
            )
        )


def schema(scene: SceneArgument) -> None:
    """Print the JSON schema of a scene's file: every key with its unit, bounds and meaning.

    \b
    Example:
      sandbox schema golf > golf.schema.json     # an editor then completes and checks golf.toml
    """
    import json

    from sandbox.parameters import json_schema
    from sandbox.scene import parameters_of

    name, parameters = parameters_of(scene)
    say(json.dumps(json_schema(parameters, name), indent=2))


def new_scene(
    name: Annotated[Path, typer.Argument(metavar="NAME", help="The folder to make: its name is the scene's.")],
    from_above: Annotated[bool, typer.Option("--from-above", help="Show it from above, not from the side.")] = False,
) -> None:
    """Create a scene of your own: one that works, for you to edit.

    \b
    Example:
      sandbox new beachvolley
      sandbox run ./beachvolley
    """
    from sandbox import new

    files = new.new_scene(name, new.FROM_ABOVE if from_above else new.FROM_SIDE)
    say("\n".join([*(f"wrote {file}" for file in files), "", *new.next_steps(name)]))


def play(
    scene: SceneArgument,
    set_: Settings = None,
    accuracy: Level = None,
    scene_of_replay: Annotated[
        str | None, typer.Option("--scene", metavar="FOLDER", help="The scene of a replay file.")
    ] = None,
) -> None:
    """Open the window: pull back anywhere and let go to shoot. H lists the keys.

    SCENE may also be a replay file, which contains no code: if its scene is not installed, --scene names the folder.

    \b
    Examples:
      sandbox play golf
      sandbox play basketball/free-throw
      sandbox play --scene ./volleyball out/volleyball-1.replay.json
    """
    from sandbox.window.app import play as play_in_window

    changed = changes(set_, accuracy)
    if any("[" in key for key in changed):  # the window keeps changes by whole parameters
        from sandbox.parameters import without_indices
        from sandbox.scene import load

        parameters = load(scene).parameters
        changed = without_indices(type(parameters), parameters.model_dump(), scene, changed, "--set")
    play_in_window(scene, changed, scene_of_replay)
