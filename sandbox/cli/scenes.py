"""The commands about scenes themselves: ``list``, ``schema``, ``new``."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING

import click

from sandbox import entries
from sandbox.cli.arguments import load, prints_to_stderr, say, scene_argument
from sandbox.errors import RequestError

if TYPE_CHECKING:
    from sandbox.scene.discovery import Listing


@click.command("list")
@click.argument("scene", metavar="[SCENE]", required=False, help="Only this scene and its presets.")
@click.option("--keys", is_flag=True, help="All keys of SCENE's file: default, unit, bounds, meaning.")
def _list_scenes(scene: str | None, keys: bool) -> None:
    """List all scenes, each with its presets, tasks and games; and what is in this folder.

    \b
    Examples:
      sandbox list golf
      sandbox list golf --keys
    """
    from sandbox.scene import listings, listings_in, listings_of

    if keys:
        from sandbox.cli.keys import key_table

        if scene is None:
            raise RequestError("list --keys: of which scene? For example: sandbox list golf --keys")
        say("\n".join(key_table(load(scene, {}).parameters)))
        return
    if scene is None:
        found = [*listings(), *listings_in(Path())]
        say("\n".join(_listed([list(group) for _, group in groupby(found, lambda listing: _scene_of(listing.name))])))
    else:
        say("\n".join(_listed([listings_of(scene)])))


def _scene_of(name: str) -> str:
    """The scene of a name in the list of all, which may be that of a preset."""
    return "/".join(name.split("/")[: 1 + name.startswith("./")])


def _listed(groups: Sequence[Sequence[Listing]]) -> Iterator[str]:
    """Lines for people: each scene with its presets, and under them its tasks and games. On a terminal, which no
    program reads, scenes are apart."""
    from sandbox.lab.tables import table

    rows: list[tuple[str, str]] = []
    for listings in groups:
        rows += [(listing.name, listing.about) for listing in listings]
        rows += [(f"  {kind}", ", ".join(names)) for kind, names in _played(listings[0].name)]
    heads = {listings[0].name for listings in groups[1:]}
    for line in table(("", ""), rows, "ll", indent=""):
        if sys.stdout.isatty() and line.split(" ")[0] in heads:
            yield ""
        yield line


def _played(scene: str) -> list[tuple[str, list[str]]]:
    """The names of the tasks and games of a scene, each after what they are."""
    from sandbox.scene.discovery import find

    tasks = entries.find("tasks")
    try:
        folder = find(scene).folder
    except RequestError:  # what it is reported for when it is run
        return []
    return [] if tasks is None or scene.endswith(".toml") else tasks.played_in(folder)


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
        made = entries.require("schemas of tasks", "--tasks").task_schema(load(scene, {}))
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
    from sandbox.cli.new import FROM_ABOVE, FROM_SIDE, new_scene, next_steps

    if from_above and copied is not None:
        raise RequestError(f"new {name}: give --from-above or --from {copied}, not both")
    files = new_scene(name, FROM_ABOVE if from_above else FROM_SIDE, copied)
    say("\n".join([*(f"wrote {file}" for file in files), "", *next_steps(name)]))
