"""``sandbox fit``: the parameters that explain what was measured."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sandbox.cli.arguments import changes_options, load, say, scene_argument, table_options
from sandbox.cli.reports import Outputs, report_options
from sandbox.files import writing

if TYPE_CHECKING:
    from sandbox.lab.mapped import Choices


def _print_formats(context: click.Context, option: click.Parameter, value: bool) -> None:
    """Print the known columns of tables and end, in place of a command."""
    if value:
        from sandbox.lab.formats import as_text

        say(as_text())
        context.exit()


@click.command()
@scene_argument
@click.argument(
    "tracks",
    metavar="TRACK.csv...",
    type=Path,
    nargs=-1,
    required=True,
    help="Measured positions, a file for each ball, or a table of shots: CSV, text or JSON.",
)
@click.option(
    "--vary", metavar="KEY[=LO:HI]", multiple=True, required=True, help="A number to fit, and its range; repeatable."
)
@click.option(
    "--free", metavar="NAME,...", multiple=True, help="Of a film, fit these too: origin, time, tilt (of the camera)."
)
@click.option("--scale", metavar='"120 px = 1 m"', help="Positions are in px of a picture, y downwards.")
@click.option("--origin", metavar="X,Y", help="The scene's origin, in the numbers of the track.")
@click.option(
    "--fps", metavar="N", type=click.FloatRange(0.0, min_open=True), help="Frames per second, of a column frame."
)
@click.option(
    "--ball", "balls", metavar="[NAME=]BALL", multiple=True, help="The scene's ball that a track is of; repeatable."
)
@table_options
@click.option(
    "--formats",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_print_formats,
    help="List known columns of tables, and exit.",
)
@click.option(
    "--models",
    metavar="KEY[=A,B]",
    help="Fit each of these models, such as ball.drag.model=constant,none, and compare.",
)
@click.option("--robust", is_flag=True, help="Count points with gross errors less or not at all (Tukey's biweight).")
@click.option("--save", metavar="F.toml", type=Path, help="The fitted scene; its pictures show the points (F.csv).")
@changes_options
@report_options
def fit(
    scene: str,
    tracks: tuple[Path, ...],
    vary: tuple[str, ...],
    free: tuple[str, ...],
    scale: str | None,
    origin: str | None,
    fps: float | None,
    balls: tuple[str, ...],
    choices: Choices,
    models: str | None,
    robust: bool,
    save: Path | None,
    changes: dict[str, Any],
    outputs: Outputs,
) -> None:
    """Find the parameters that explain measured tracks or shots.

    Each has its 95 % interval. A track has the columns t (s since the launch), x, y (m as in the scene), and ball if
    there are several; other units stand in the names, as "x (cm)". Tracker's exports are read as they are. Without t,
    points are compared with the nearest place of the path.

    \b
    Examples:
      sandbox fit basketball track.csv --vary launch.speed=6:9 --vary floor.restitution
      sandbox fit throws film.txt --vary launch.speed=5:20 --vary launch.angle=20:60 --free time,origin
      sandbox fit basketball clicks.csv --scale "96 px = 1 m" --origin 212,655 --vary launch.speed=6:9
      sandbox fit golf shots.csv --where Club=Driver --vary air.density=1:1.3
      sandbox fit golf shots.csv --map "launch.speed=Speed [mph]" --map "carry=Carry [yd]" --vary launch.angle=5:20
    """
    from sandbox.lab.fit.data import Reading
    from sandbox.lab.fit.fitting import fit_track, parse_varied, read_data
    from sandbox.lab.fit.frame import parse_free
    from sandbox.lab.fit.launches import Launches
    from sandbox.lab.fit.models import compare, parse_models
    from sandbox.lab.fit.parsing import Film, parse_ball, parse_pair, parse_scale
    from sandbox.lab.fit.problem import Problem
    from sandbox.lab.fit.report import report_of
    from sandbox.lab.fit.saving import check_saving
    from sandbox.lab.fit.saving import save as saved
    from sandbox.progress import bar

    chosen = load(scene, changes)
    spans = [parse_varied(chosen, text) for text in vary]
    film = Film(
        None if scale is None else parse_scale(scale),
        (0.0, 0.0) if origin is None else parse_pair("--origin", origin),
        fps,
        dict(map(parse_ball, balls)),
    )
    choices = replace(choices, decided=(*changes, *(span.key for span in spans)))
    data = read_data(chosen, tracks, Reading(film, parse_free("--free", free), choices))
    if save is not None:
        check_saving("--save", save, has_points=not isinstance(data, Launches))
        outputs.check({"--save": save})
    with bar("fit") as progress:
        found = (
            fit_track(chosen, data, spans, robust, progress)
            if models is None
            else compare(Problem(chosen, data, spans, robust, progress), *parse_models(chosen, "--models", models))
        )
    files: list[Path] = []
    if save is not None:
        with writing("--save", save):
            files = saved(found, save)
    outputs.write(report_of(found), others=files)
