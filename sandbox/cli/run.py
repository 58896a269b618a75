"""``sandbox run``: one run, as numbers and as pictures."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from sandbox.cli import outputs
from sandbox.cli.arguments import Level, SceneArgument, Settings, load, whole_number
from sandbox.cli.say import say
from sandbox.errors import RequestError

if TYPE_CHECKING:
    from sandbox.scene import Scene


def run(
    scene: SceneArgument,
    set_: Settings = None,
    accuracy: Level = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object in place of the result card.")] = False,
    check: Annotated[
        bool,
        typer.Option(
            "--check", help="Run again, finer and from starts 1 nm away: the error of each number, and what is chaotic."
        ),
    ] = False,
    trajectory: Annotated[
        Path | None, typer.Option(metavar="F.csv", help="Write the path of every ball: t,ball,x,y,vx,vy,spin.")
    ] = None,
    poster: Annotated[Path | None, typer.Option(metavar="F.png", help="Write the whole run as one picture.")] = None,
    frames: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Write the run as PNG frames; the folder is made if missing.")
    ] = None,
    gif: Annotated[Path | None, typer.Option(metavar="F.gif", help="Write the run as an animation.")] = None,
    webp: Annotated[
        Path | None, typer.Option(metavar="F.webp", help="Write it as WebP: all colours, smaller file.")
    ] = None,
    strip: Annotated[Path | None, typer.Option(metavar="F.png", help="Write five frames side by side.")] = None,
    energy: Annotated[
        Path | None, typer.Option(metavar="F.png", help="Write a chart of where the energy goes.")
    ] = None,
    compare: Annotated[
        str | None,
        typer.Option(
            metavar="SCENE", help="Another preset or scene file: its numbers and its path next to this one's."
        ),
    ] = None,
    fps: Annotated[
        int | None,
        typer.Option(
            metavar="N",
            parser=whole_number("--fps", 1, 240, "frames per second"),
            help="Frames per second of the run, from 1 to 240.  [default: 60 for --frames, else 25]",
        ),
    ] = None,
    size: Annotated[
        str | None,
        typer.Option(
            metavar="WxH",
            help="Size of pictures in px; the frames of a strip are half of it, at least 320x180.  [default: 1280x720]",
        ),
    ] = None,
) -> None:
    """Run a scene once, without a window, to its end, and print its result card.

    \b
    Examples:
      sandbox run golf
      sandbox run golf --set launch.speed="171 mph" --set air.wind=[-3,0]
      sandbox run golf --poster golf.png --trajectory golf.csv
      sandbox run golf --frames frames --fps 30 --size 1920x1080
      sandbox run golf --compare golf/headwind --poster both.png
      sandbox run my-shot.toml --accuracy precise --check --json
    """
    from sandbox import report
    from sandbox.progress import bar
    from sandbox.scene import check as check_scene
    from sandbox.scene import simulate

    chosen = load(scene, set_, accuracy)
    paths = {
        "--trajectory": trajectory,
        "--poster": poster,
        "--strip": strip,
        "--energy": energy,
        "--gif": gif,
        "--webp": webp,
        "--frames": frames,
    }
    pixels = None if size is None else outputs.read_size(size)
    files = outputs.requested(paths, size, fps)
    with bar("seconds simulated") as progress:
        try:
            done = simulate(chosen, progress)
        except RequestError as error:  # what only the scene can check: two balls in one place
            raise RequestError(f"{scene}: {error}") from None
        checked = check_scene(chosen, done, progress) if check else None
        other = None if compare is None else (compare, simulate(_comparable(chosen, compare, accuracy), progress))
    if as_json:
        said = report.as_json(chosen, done, checked, None if other is None else other[1])
    else:
        said = "\n".join(report.card(chosen, done, checked, other))
    ghosts = {} if other is None else {other[0].removesuffix(".toml").split("/")[-1]: other[1]}
    outputs.write(files, outputs.Drawn(done, pixels, fps, ghosts))
    written = [] if as_json else [f"wrote {path}" for path in files.values()]
    say("\n".join([said, *written]))


def _comparable(scene: Scene, source: str, accuracy: str | None) -> Scene:
    """The scene to compare with, which must be of the same sport; ``--set`` does not apply to it."""
    other = load(source, None, accuracy)
    if other.folder.resolve() != scene.folder.resolve():
        raise RequestError(
            f"--compare {source}: is {other.name}, and only {scene.name} can be compared with {scene.name}"
        )
    return other
