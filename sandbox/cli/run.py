"""``sandbox run``: one run, as numbers and as pictures."""

from __future__ import annotations

from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sandbox import entries
from sandbox.cli import outputs
from sandbox.cli.arguments import changes_options, json_option, load, say, scene_argument, units_option
from sandbox.errors import RequestError

if TYPE_CHECKING:
    from sandbox.scene import Scene


@click.command()
@scene_argument
@changes_options
@json_option
@click.option(
    "--check",
    is_flag=True,
    help="Rerun at finer accuracy and from starts moved by 1 nm: each number's error, and what is chaotic.",
)
@click.option(
    "--attempt",
    metavar="N",
    type=click.IntRange(min=1),
    help="Which attempt at a task: what is drawn at its start.  [default: 1]",
)
@click.option(
    "--seed", metavar="N", type=click.IntRange(min=0), help="What the starts of a task are drawn by.  [default: 0]"
)
@units_option
@outputs.options
@click.option(
    "--compare",
    metavar="SCENE",
    multiple=True,
    help="Another preset or scene file: its numbers and its path next to this one's; repeatable.",
)
@click.option(
    "--every", metavar="TIME", help="Interval of the rows of --trajectory, such as 0.01 s.  [default: 1/120 s]"
)
@click.option(
    "--columns",
    metavar="NAME,...",
    help="More columns of --trajectory: acceleration, forces, energy.",
)
@click.option(
    "--fps",
    metavar="N",
    type=click.IntRange(1, 240),
    help="Frames per second of the run.  [default: 60 for --frames and --video, else 25]",
)
@click.option(
    "--size",
    metavar="WxH",
    type=outputs.read_size,
    help="Size of pictures in px; the frames of a strip are half of it, at least 320x180.  "
    "[default: 800x450 for --gif, else 1280x720]",
)
def run(
    scene: str,
    changes: dict[str, Any],
    as_json: bool,
    check: bool,
    attempt: int | None,
    seed: int | None,
    compare: tuple[str, ...],
    fps: int | None,
    size: outputs.Size | None,
    every: str | None,
    columns: str | None,
    **paths: Path | None,
) -> None:
    """Run a scene once, without a window, and print its results.

    \b
    Examples:
      sandbox run golf
      sandbox run golf --set launch.speed="171 mph" --set air.wind=[-3,0]
      sandbox run golf --poster golf.png --trajectory golf.csv
      sandbox run golf --trajectory golf.csv --every 0.05 --columns acceleration,forces,energy
      sandbox run golf --frames frames --fps 30 --size 1920x1080
      sandbox run golf --compare golf/headwind --compare golf/moon --poster three.png
      sandbox run my-shot.toml --accuracy precise --check --json
      sandbox run free-throw --attempt 3 --set launch.speed=7.4
    """
    from sandbox.cli import card
    from sandbox.progress import bar
    from sandbox.scene import check as check_scene
    from sandbox.scene import simulate

    for option, number in (("--attempt", attempt), ("--seed", seed)):
        if number is not None:
            entries.require("tasks", f"{option} {number}")
    tasks = entries.find("tasks")
    task = None if tasks is None else tasks.tried(scene, changes, attempt, seed)
    chosen = load(scene, changes) if task is None else task.scene
    compared = {source: _comparable(chosen, source, changes) for source in compare}
    files = outputs.requested(paths, size, fps)
    sampled = _sampling(every, columns, paths["trajectory"])
    with bar("seconds simulated") as progress:
        try:
            done = simulate(chosen, progress=progress)
        except RequestError as error:  # what only the scene can check: two balls in one place
            raise RequestError(f"{scene}: {error}") from None
        checked = check_scene(chosen, done, progress) if check else None
        others = {source: simulate(other, progress=progress) for source, other in compared.items()}
    if as_json:
        more = {} if task is None else {"attempt": task.report(done)}
        text = card.as_json(chosen, done, checked, list(others.values()), more)
    else:
        text = "\n".join([*card.card(chosen, done, checked, others), *([] if task is None else task.lines(done))])
        if paths["momentum"] is not None:
            from sandbox.cli.rows import impact_lines

            text = "\n".join([text, "", *impact_lines(done)])
    outputs.write(files, outputs.Drawn(done, size, fps, others, *sampled))
    written = [] if as_json else [f"wrote {path}" for path in files.values()]
    say("\n".join([text, *written]))


def _sampling(every: str | None, columns: str | None, path: Path | None) -> tuple[float | None, tuple[str, ...]]:
    """The interval in s and the added columns of a trajectory. Raises RequestError."""
    from sandbox import units
    from sandbox.cli.rows import MORE

    for option, given in (("--every", every), ("--columns", columns)):
        if given is not None and path is None:
            raise RequestError(f"{option} {given}: requires --trajectory F.csv")
    step = None
    if every is not None:
        try:
            step = units.parse(every, "s")
        except ValueError as error:
            raise RequestError(f'--every "{every}" {error}') from None
        if not 1e-9 <= step < inf:
            raise RequestError(f"--every {every}: must be at least 1e-9 s, and finite")
    names = tuple(name.strip() for name in (columns or "").split(",")) if columns is not None else ()
    for name in names:
        if name not in MORE:
            raise RequestError(f'--columns {columns}: there is no "{name}"; choose from {", ".join(MORE)}')
    return step, names


def _comparable(scene: Scene, source: str, changes: dict[str, Any]) -> Scene:
    """The scene to compare with, which must be of the same sport; of the changes only the accuracy applies to it."""
    other = load(source, {key: value for key, value in changes.items() if key == "accuracy.level"})
    if other.folder.resolve() != scene.folder.resolve():
        raise RequestError(
            f"--compare {source}: is {other.name}, and only {scene.name} can be compared with {scene.name}"
        )
    return other
