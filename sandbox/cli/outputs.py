"""The files that a run can be written to: a table of options, with each file's type and the function that writes it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sandbox import entries
from sandbox.errors import RequestError
from sandbox.files import LARGEST, SMALLEST, check_size, writing

if TYPE_CHECKING:
    from sandbox.scene.scene_run import SceneRun

#: The size of pictures in px, unless another is asked for.
_USUAL = (1280, 720)
#: GIFs are made of so many px and frames, unless others are asked for: the largest, of a long flight, has 5 MB then.
SMALL, MOST_FRAMES = (800, 450), 450

#: The part of an extension that writes a run as a page.
PAGES = "pages of runs"

Size = tuple[int, int]


@dataclass(frozen=True)
class Drawn:
    """A run to write, and the requested size and rate of its pictures; ``rate`` is in frames per second.

    ``others`` are the runs that it is compared with, each by the scene's name or file as it was requested.
    """

    run: SceneRun
    size: Size | None = None
    rate: int | None = None
    others: Mapping[str, SceneRun] = field(default_factory=dict)
    every: float | None = None  # s, between the rows of a trajectory
    columns: Sequence[str] = ()  # of a trajectory, besides the state

    @property
    def ghosts(self) -> Mapping[str, SceneRun]:
        """The other runs by the short names that pictures show; in full where two would be alike."""
        short = {source: source.removesuffix(".toml").split("/")[-1] for source in self.others}
        alike = Counter(short.values())
        return {name if alike[name] == 1 else source: self.others[source] for source, name in short.items()}

    @cached_property
    def picture(self) -> Any:
        """The scene's picture, made once for all files."""
        return self.run.scene.picture(self.run, self.size, self.ghosts)


@dataclass(frozen=True)
class _Output:
    """One kind of file: its option, its suffix ("" for a folder of files), who writes it, and the option's help."""

    option: str
    suffix: str
    write: Callable[[Drawn, Path], None]
    help: str
    is_picture: bool = True
    moves: bool = False
    needs: str = ""  # a library that is not always installed
    part: str = ""  # of an extension


def _trajectory(drawn: Drawn, path: Path) -> None:
    from sandbox.cli import rows

    rows.write_trajectory(drawn.run, path, drawn.others, drawn.every or rows.EVERY, drawn.columns)


def _momentum(drawn: Drawn, path: Path) -> None:
    from sandbox.cli import rows

    rows.write_impacts(drawn.run, path, drawn.others)


def _poster(drawn: Drawn, path: Path) -> None:
    from sandbox.picture.frames import save_png

    save_png(drawn.picture.poster(), path)


def _html(drawn: Drawn, path: Path) -> None:
    from sandbox.sport.amounts import chosen_units

    options = [word for source in drawn.others for word in ("--compare", source)]
    options += ["--units", chosen_units()] if chosen_units() != "si" else []
    entries.require(PAGES, "--html").save_page(drawn.run, path, drawn.ghosts, options)


def _strip(drawn: Drawn, path: Path) -> None:
    from sandbox.picture.frames import save_png
    from sandbox.picture.strip import film_strip

    width, height = drawn.size or _USUAL
    half = max(SMALLEST[0], width // 2), max(SMALLEST[1], height // 2)
    save_png(film_strip(drawn.run.scene.picture(drawn.run, half, drawn.ghosts), drawn.run), path)


def _energy(drawn: Drawn, path: Path) -> None:
    from sandbox.picture.energy_chart import energy_charts
    from sandbox.picture.frames import save_png

    save_png(energy_charts([drawn.run, *drawn.others.values()], drawn.size or _USUAL), path)


def _graph(drawn: Drawn, path: Path) -> None:
    from sandbox.picture.frames import save_png
    from sandbox.picture.graph import graph

    save_png(graph(drawn.run, drawn.size or _USUAL, drawn.ghosts), path)


def _animation(saver: str, rate: int, size: Size | None = None) -> Callable[[Drawn, Path], None]:
    """Writes with a function of sandbox.picture.frames; ``rate`` and ``size`` are the defaults, the rate lower for a
    long run in a file of limited ``size``."""

    def write(drawn: Drawn, path: Path) -> None:
        from sandbox.files import no_empty_folder
        from sandbox.picture import frames
        from sandbox.progress import bar

        smaller = drawn if drawn.size or size is None else replace(drawn, size=size)
        usual = rate if size is None else max(5.0, min(rate, MOST_FRAMES / max(drawn.run.duration, 1e-9)))
        with no_empty_folder(path), bar(saver.removeprefix("save_")) as progress:
            getattr(frames, saver)(smaller.picture, drawn.run, path, drawn.rate or usual, progress)

    return write


#: In the order in which they are written.
OUTPUTS = (
    _Output("--trajectory", ".csv", _trajectory, "Write the path of every ball: t,ball,x,y,vx,vy,spin.", False),
    _Output(
        "--momentum", ".csv", _momentum, "Write velocity, momentum and energy before and after each impact.", False
    ),
    _Output("--poster", ".png", _poster, "Write the whole run as one picture."),
    _Output(
        *("--html", ".html", _html, "Write a page for any browser that plays the run; it needs no network.", False),
        part=PAGES,
    ),
    _Output("--strip", ".png", _strip, "Write some frames side by side."),
    _Output("--energy", ".png", _energy, "Write a chart of where the energy goes."),
    _Output("--graph", ".png", _graph, "Write graphs over time: position, speed, spin, acceleration, forces, energy."),
    _Output("--gif", ".gif", _animation("save_gif", 25, SMALL), "Write it as an animation below 5 MB.", moves=True),
    _Output(
        *("--video", ".mp4", _animation("save_video", 60), "Write it as a video; needs imageio-ffmpeg."),
        moves=True,
        needs="imageio-ffmpeg",
    ),
    _Output(
        *("--frames", "", _animation("save_frames", 60)),
        *("Write the run as PNG frames; the folder is made if missing.", True, True),
    ),
)


def options(command: Callable[..., None]) -> Callable[..., None]:
    """An option for each output, which gives the command its path."""
    for output in reversed(OUTPUTS):
        metavar = f"F{output.suffix}" if output.suffix else "DIR"
        command = click.option(output.option, metavar=metavar, type=Path, help=output.help)(command)
    return command


def requested(paths: Mapping[str, Path | None], size: Size | None, rate: int | None) -> dict[_Output, Path]:
    """The requested outputs with their paths, which are given by their options' names.

    Raises RequestError, before any work is done, for one that cannot be written, and for a size or rate that no output
    uses.
    """
    from sandbox.files import check_distinct, check_file, check_folder, check_installed

    given = {f"--{name}": path for name, path in paths.items()}
    chosen = {output: path for output in OUTPUTS if (path := given[output.option]) is not None}
    for output, path in chosen.items():
        if output.suffix:
            check_file(output.option, path, output.suffix)
            check_installed(output.option, output.needs)
            if output.part:
                entries.require(output.part, output.option)
        else:
            from sandbox.picture.frames import check_frames_folder

            check_folder(output.option, path)
            check_frames_folder(output.option, path)
    check_distinct(given)
    if rate is not None and not any(output.moves for output in chosen):
        raise RequestError(f"--fps {rate}: requires --frames, --gif or --video")
    if size is not None and not any(output.is_picture for output in chosen):
        raise RequestError(f"--size {'x'.join(map(str, size))}: requires a picture, such as --poster F.png")
    return chosen


def write(outputs: Mapping[_Output, Path], drawn: Drawn) -> None:
    """Write all of them."""
    for output, path in outputs.items():
        with writing(output.option, path):
            output.write(drawn, path)


def read_size(text: str) -> Size:
    """``"1280x720"``."""
    from sandbox.text import shortened

    sides = text.lower().split("x")
    if len(sides) != 2 or not all(side.isdecimal() for side in sides):
        raise RequestError(f"--size {shortened(text)}: must be width and height in px, such as 1280x720")
    width, height = (int(side) if len(side) < 9 else LARGEST[0] + 1 for side in sides)
    check_size(f"--size {shortened(text)}", (width, height))
    return width, height
