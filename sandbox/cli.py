"""The ``sandbox`` program: one thin function per command. Everything heavy is imported by the command that needs it."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from io import TextIOWrapper
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Annotated, Any

import typer

import sandbox
from sandbox.errors import RequestError, RunError, SandboxError

if TYPE_CHECKING:
    from sandbox.engine.run import Run
    from sandbox.scene import Scene

app = typer.Typer(
    name="sandbox",
    add_completion=False,
    no_args_is_help=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110},
)

SceneArgument = Annotated[
    str,
    typer.Argument(
        metavar="SCENE", help="A scene (golf), a preset (golf/driver) or a scene file of your own.", show_default=False
    ),
]
OptionalScene = Annotated[
    str | None,
    typer.Argument(metavar="[SCENE]", help="As above; all scenes where it is left out.", show_default=False),
]
Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set", metavar="KEY=VALUE", help='Change a parameter; repeatable. A value may have a unit: "171 mph".'
    ),
]
LEVELS = ("fast", "balanced", "precise")
Level = Annotated[
    str | None,
    typer.Option(
        "--accuracy",
        metavar="|".join(LEVELS),
        help="Speed against accuracy, in place of the scene file's accuracy.level.",
        show_default=False,
    ),
]


def _whole(option: str, low: int, high: float = float("inf"), unit: str = "") -> Callable[[str], int]:
    """Reads the whole number of an option; its bounds are in ``unit``."""
    bounds = f"of {low} or more" if high == float("inf") else f"from {low} to {high}"

    def read(text: str) -> int:
        try:
            number = int(text)
        except ValueError:
            number = low - 1
        if not low <= number <= high:
            raise RequestError(f"{option} {text}: must be a whole number {bounds} {unit}".rstrip())
        return number

    return read


def _show_version(wanted: bool) -> None:
    if wanted:
        _say(f"sandbox {sandbox.__version__}")
        raise typer.Exit


@app.callback()
def _program(
    version: Annotated[
        bool, typer.Option("--version", callback=_show_version, is_eager=True, help="Show the version and leave.")
    ] = False,
) -> None:
    """A 2D sports sandbox: pick a sport, let go, and see real physics.

    \b
    Begin with:
      sandbox list                                  # what there is
      sandbox run golf                              # one shot, and its numbers
      sandbox run golf --set launch.speed="150 mph" --poster golf.png
    """


@app.command("list")
def list_scenes(
    scene: Annotated[
        str | None, typer.Argument(metavar="[SCENE]", help="Only this scene and its presets.", show_default=False)
    ] = None,
) -> None:
    """Show the scenes and presets there are, those in this folder too."""
    from sandbox.scene import listings, listings_in, listings_of

    found = [*listings(), *listings_in(Path())] if scene is None else listings_of(scene)
    width = max((len(listing.name) for listing in found), default=0)
    for listing in found:
        _say(f"{listing.name:{width}}  {listing.about}".rstrip())


@app.command()
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
    _say(json.dumps(json_schema(parameters, name), indent=2))


@app.command("new")
def new_scene(
    name: Annotated[Path, typer.Argument(metavar="NAME", help="The folder to make: its name is the scene's.")],
) -> None:
    """Write a scene of your own: one that works, to change.

    \b
    Example:
      sandbox new volleyball
      sandbox run ./volleyball
    """
    from sandbox import new

    files = new.new_scene(name)
    _say("\n".join([*(f"wrote {file}" for file in files), "", *new.next_steps(name)]))


@app.command()
def run(
    scene: SceneArgument,
    set_: Settings = None,
    accuracy: Level = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object in place of the result card.")] = False,
    check: Annotated[
        bool, typer.Option("--check", help="Run again, finer, and estimate the error of each number.")
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
        Path | None, typer.Option(metavar="F.webp", help="The same in all colours, and in fewer bytes.")
    ] = None,
    strip: Annotated[Path | None, typer.Option(metavar="F.png", help="Write five frames side by side.")] = None,
    energy: Annotated[
        Path | None, typer.Option(metavar="F.png", help="Write a chart of where the energy goes.")
    ] = None,
    compare: Annotated[
        str | None,
        typer.Option(metavar="SCENE", help="Another preset or scene file: its numbers and its path beside this one's."),
    ] = None,
    fps: Annotated[
        int | None,
        typer.Option(
            metavar="N",
            parser=_whole("--fps", 1, 240, "frames per second"),
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
    from sandbox.scene import check as check_scene
    from sandbox.scene import simulate

    chosen = _load(scene, set_, accuracy)
    outputs = {
        "--trajectory": trajectory,
        "--poster": poster,
        "--strip": strip,
        "--energy": energy,
        "--gif": gif,
        "--webp": webp,
        "--frames": frames,
    }
    _check_outputs(outputs, fps)
    pixels = None if size is None else _parse_size(size)
    if size is not None and all(path is None for option, path in outputs.items() if option != "--trajectory"):
        raise RequestError(f"--size {size}: goes with a picture, such as --poster F.png")
    try:
        done = simulate(chosen)
    except RequestError as error:  # what only the scene itself can see: two balls in one place
        raise RequestError(f"{scene}: {error}") from None
    checked = check_scene(chosen, done) if check else None
    other = None if compare is None else simulate(_comparable(chosen, compare, accuracy))
    if as_json:
        said = report.as_json(chosen, done, checked, other)
    else:
        beside = None if compare is None or other is None else (compare, other)
        said = "\n".join(report.card(chosen, done, checked, beside))
    if trajectory is not None:
        with _writing("--trajectory", trajectory):
            report.write_trajectory(done, trajectory)
    pictures = {name: path for name, path in outputs.items() if path is not None and name != "--trajectory"}
    if pictures:
        ghosts = {} if compare is None or other is None else {compare.removesuffix(".toml").split("/")[-1]: other}
        _draw(done, pictures, fps, pixels, ghosts)
    written = [f"wrote {path}" for path in outputs.values() if path is not None and not as_json]
    _say("\n".join([said, *written]))


@app.command()
def play(scene: SceneArgument, set_: Settings = None, accuracy: Level = None) -> None:
    """Open the window: pull back from the ball, let go, and see. H lists the keys.

    \b
    Examples:
      sandbox play golf
      sandbox play basketball/free-throw
    """
    from sandbox.window.app import play as play_in_window

    changes = _changes(set_, accuracy)
    if any("[" in key for key in changes):  # the window keeps what was changed by whole parameters
        from sandbox.parameters import whole
        from sandbox.scene import load

        parameters = load(scene).parameters
        changes = whole(type(parameters), parameters.model_dump(), scene, changes, "--set")
    play_in_window(scene, changes)


def _load(source: str, settings: list[str] | None, accuracy: str | None) -> Scene:
    """The scene with ``--set`` and ``--accuracy`` over its file."""
    from sandbox.scene import load

    return load(source, _changes(settings, accuracy), overrides_from="--set")


def _changes(settings: list[str] | None, accuracy: str | None) -> dict[str, Any]:
    """``--set`` and ``--accuracy`` as values by dotted key."""
    from sandbox.parameters import parse_assignment

    changes = dict(parse_assignment(text) for text in settings or [])
    if accuracy is not None:
        if accuracy not in LEVELS:
            raise RequestError(f"--accuracy {accuracy}: must be {', '.join(LEVELS[:-1])} or {LEVELS[-1]}")
        changes["accuracy.level"] = accuracy
    return changes


def _comparable(scene: Scene, source: str, accuracy: str | None) -> Scene:
    """The scene to compare with, which must be one of the same sport; ``--set`` is for the other alone."""
    other = _load(source, None, accuracy)
    if other.folder.resolve() != scene.folder.resolve():
        raise RequestError(
            f"--compare {source}: is {other.name}, and only {scene.name} can be compared with {scene.name}"
        )
    return other


def _check_outputs(outputs: dict[str, Path | None], fps: int | None) -> None:
    """Refuse what could not be written before any work is done."""
    from sandbox.files import check_apart, check_file, check_folder

    suffixes = {"--trajectory": ".csv", "--gif": ".gif", "--webp": ".webp"}
    for option, path in outputs.items():
        if option == "--frames" and path is not None:
            check_folder(option, path)
        elif path is not None:
            check_file(option, path, suffixes.get(option, ".png"))
    check_apart(outputs)
    if fps is not None and all(outputs[option] is None for option in ("--frames", "--gif", "--webp")):
        raise RequestError(f"--fps {fps}: goes with --frames, --gif or --webp")


def _parse_size(text: str) -> tuple[int, int]:
    """``"1280x720"``."""
    low, high = SIZES
    sides = text.lower().split("x")
    if len(sides) != 2 or not all(side.isdecimal() and len(side) < 6 for side in sides):
        raise RequestError(f"--size {text}: must be width and height in px, such as 1280x720")
    width, height = int(sides[0]), int(sides[1])
    if not (low[0] <= width <= high[0] and low[1] <= height <= high[1]):
        raise RequestError(f"--size {text}: must be between {low[0]}x{low[1]} and {high[0]}x{high[1]} px")
    return width, height


@contextmanager
def _writing(option: str, path: Path) -> Iterator[None]:
    """A disk that is full, or a folder that went away, in one line."""
    from sandbox.files import reason
    from sandbox.tracebacks import of_user_code

    try:
        yield
    except OSError as error:
        if of_user_code(error) is not None:
            raise
        raise RunError(f"{option} {path}: cannot be written: {reason(error)}") from None


def _draw(
    done: Run, outputs: dict[str, Path], fps: int | None, size: tuple[int, int] | None, ghosts: dict[str, Run]
) -> None:
    """Write the pictures of a run that were asked for, by their options."""
    from sandbox.files import no_empty_folder
    from sandbox.picture import frames
    from sandbox.progress import bar

    scene = done.scene
    picture = scene.picture(done, size, ghosts)
    width, height = size or (1280, 720)
    for option, path in outputs.items():
        with _writing(option, path):
            if option == "--poster":
                frames.save_poster(picture, path)
            elif option == "--strip":
                from sandbox.picture.strip import film_strip

                half = max(SIZES[0][0], width // 2), max(SIZES[0][1], height // 2)
                frames.save_png(film_strip(scene.picture(done, half, ghosts), done), path)
            elif option == "--energy":
                from sandbox.picture.energy import energy_chart

                frames.save_png(energy_chart(done, (width, height)), path)
            else:
                save = {"--frames": frames.save_frames, "--gif": frames.save_gif, "--webp": frames.save_webp}[option]
                with no_empty_folder(path), bar(option.removeprefix("--")) as progress:
                    save(picture, done, path, fps or (60 if option == "--frames" else 25), progress)


@app.command()
def aim(
    scene: SceneArgument,
    vary: Annotated[
        list[str], typer.Option(metavar="KEY=LO:HI", help="A number and its range; once or twice.", show_default=False)
    ],
    target: Annotated[
        list[str],
        typer.Option(metavar="NAME=VALUE", help="A result and what it shall be; once or twice.", show_default=False),
    ],
    set_: Settings = None,
    accuracy: Level = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object in place of the card.")] = False,
    show: Annotated[Path | None, typer.Option(metavar="F.png", help="Write a picture of the tries.")] = None,
) -> None:
    """Find the values that give a result: all of them in the range, each with its numerical error.

    A target that is true or false, or a word, has intervals: the widest first, with the middle, which forgives most.
    That there is no solution is an answer too: it is said, with how near it got, and the exit code is 0.

    \b
    Examples:
      sandbox aim golf --vary launch.angle=2:75 --target carry=200
      sandbox aim basketball --vary launch.speed=6:10 --target made=true --show tries.png
      sandbox aim golf --vary launch.angle=2:60 --vary launch.speed=40:90 --target carry="219 yd" --target apex=30
    """
    from sandbox.files import check_file
    from sandbox.lab.aim import parse_target, search
    from sandbox.lab.axes import parse_span
    from sandbox.progress import bar

    chosen = _load(scene, set_, accuracy)
    spans = [parse_span(chosen, "--vary", text) for text in vary]
    targets = [parse_target(text, chosen) for text in target]
    if show is not None:
        from sandbox.lab.chart import check_installed

        check_file("--show", show, ".png")
        check_installed("--show")
    with bar("aim") as progress:
        found = search(chosen, spans, targets, progress)
    from sandbox.lab import aim_report

    if show is not None:
        with _writing("--show", show):
            aim_report.draw(found, show)
    if as_json:
        _say(aim_report.as_json(found))
    else:
        written = [] if show is None else [f"wrote {show}"]
        _say("\n".join([*aim_report.as_text(found), *written]))


@app.command()
def sweep(
    scene: SceneArgument,
    over: Annotated[
        list[str],
        typer.Option(
            metavar="KEY=LO:HI:N", help="A parameter and its values, also as KEY=A,B,C; repeatable.", show_default=False
        ),
    ],
    out: Annotated[Path, typer.Option(metavar="F.csv", help="One row for each point.", show_default=False)],
    set_: Settings = None,
    accuracy: Level = None,
    samples: Annotated[
        int | None,
        typer.Option(
            metavar="N", parser=_whole("--samples", 1), help="So many random points: within ranges, from lists."
        ),
    ] = None,
    seed: Annotated[
        int | None, typer.Option(metavar="N", parser=_whole("--seed", 0), help="Which random points.  [default: 0]")
    ] = None,
    check: Annotated[bool, typer.Option("--check", help="Run each point again, finer, and add its errors.")] = False,
    plot: Annotated[
        Path | None, typer.Option(metavar="F.png", help="A map over two parameters, a curve over one.")
    ] = None,
    of: Annotated[str | None, typer.Option(metavar="NAME", help="The result that --plot shows.")] = None,
    parquet: Annotated[
        Path | None, typer.Option(metavar="F.parquet", help="The rows once more; needs pyarrow.")
    ] = None,
    jobs: Annotated[
        int | None,
        typer.Option(
            metavar="N",
            parser=_whole("--jobs", 1, unit="processes"),
            help="Processes.  [default: one for each core that saves time]",
        ),
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="Have the workers of a Dask scheduler compute.")
    ] = None,
) -> None:
    """Run a scene once for each point of a grid, or for random points, and write a row for each.

    Ctrl-C keeps the rows that are done; the same command again goes on from there. What another sweep left in the file
    is kept as F.csv~. A point that fails is a row with its error.

    \b
    Examples:
      sandbox sweep basketball --over launch.speed=6:9:61 --over launch.angle=35:75:41 --out map.csv --plot map.png
      sandbox sweep golf --over launch.angle=5:40:71 --over ball.drag.model=tour-fit,usga --out carry.csv
      sandbox sweep golf --over launch.speed="160 mph:180 mph" --over air.wind[0]=-8:8 --samples 5000 --out wind.csv
    """
    from sandbox.files import check_file
    from sandbox.lab.axes import parse_axis
    from sandbox.lab.plan import Plan
    from sandbox.lab.sweep import jobs_that_pay, sweep_to_file, workers
    from sandbox.progress import bar

    chosen = _load(scene, set_, accuracy)
    plan = Plan(chosen, tuple(parse_axis(chosen, "--over", text) for text in over), samples or 0, seed or 0, check)
    check_file("--out", out, ".csv")
    if seed is not None and samples is None:
        raise RequestError(f"--seed {seed}: goes with --samples")
    if of is not None and plot is None:
        raise RequestError(f"--of {of}: goes with --plot")
    if plot is not None:
        from sandbox.lab.maps import check_plot

        check_file("--plot", plot, ".png")
        check_plot(plan, of)
    if parquet is not None:
        from sandbox.lab.parquet import check_installed, write_parquet

        check_file("--parquet", parquet, ".parquet")
        check_installed("--parquet")
    with workers(jobs or jobs_that_pay(plan), scheduler) as staff, bar("sweep") as progress:
        done = sweep_to_file(plan, out, staff, progress)
    if plot is not None:
        from sandbox.lab.maps import draw_sweep

        with _writing("--plot", plot):
            draw_sweep(plan, out, plot, of)
    if parquet is not None:
        with _writing("--parquet", parquet):
            write_parquet(plan, out, parquet)
    if str(out) != "/dev/stdout":
        written = [f"wrote {path}" for path in (out, plot, parquet) if path is not None]
        _say("\n".join([done.as_text(), *written]))
    if done.failures == done.points - done.resumed > 0:
        raise RunError(f"every point failed, first with: {done.first_error}")


@app.command()
def trade(
    scene: SceneArgument,
    set_: Settings = None,
    accuracy: Level = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object in place of the tables.")] = False,
    plot: Annotated[
        Path | None, typer.Option(metavar="F.png", help="Draw error against speed, a curve for each method.")
    ] = None,
) -> None:
    """Measure speed against accuracy for a scene: every method, the levels, and what each part of the model is worth.

    Takes half a minute, on a machine that does nothing else.

    \b
    Examples:
      sandbox trade golf
      sandbox trade basketball/rattle --plot rattle.png
      sandbox trade my-shot.toml --set air.wind=[-8,0] --json
    """
    from sandbox.files import check_file
    from sandbox.lab import chart
    from sandbox.lab import trade as lab
    from sandbox.progress import bar

    chosen = _load(scene, set_, accuracy)
    if plot is not None:
        check_file("--plot", plot, ".png")
        chart.check_installed("--plot")
    with bar("trade") as progress:
        found = lab.trade(chosen, progress)
    if plot is not None:
        with _writing("--plot", plot):
            chart.draw_trade(found, plot)
    _say(_json(lab.as_dict(found)) if as_json else "\n".join(lab.as_text(found)))


@app.command()
def stress(
    scene: OptionalScene = None,
    set_: Settings = None,
    accuracy: Level = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON list in place of the tables.")] = False,
) -> None:
    """Run a scene, or all of them, at the extremes by every method, and tell what happened at each.

    \b
    Examples:
      sandbox stress             # all scenes, and setups of no scene
      sandbox stress golf
      sandbox stress golf/driver --accuracy fast --json
    """
    from sandbox.lab import stress as lab
    from sandbox.progress import bar

    scenes = _loaded(scene, set_, accuracy)
    with bar("stress") as progress:
        outcomes = lab.stress(scenes, accuracy or "balanced", with_bare=scene is None, progress=progress)
    _say(_json(lab.as_dicts(outcomes)) if as_json else "\n".join(lab.as_text(outcomes)))


@app.command()
def validate(
    scene: OptionalScene = None,
    set_: Settings = None,
    accuracy: Level = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON list in place of the tables.")] = False,
) -> None:
    """Show published numbers beside ours, with their sources, for a scene or for all of them.

    \b
    Examples:
      sandbox validate
      sandbox validate golf --set ball.drag.model=usga --set ball.lift.model=usga
    """
    from sandbox.lab import validate as lab
    from sandbox.progress import bar

    changes = _changes(set_, accuracy)
    with bar("validate") as progress:
        rows = lab.validate(scene, changes, progress)
    _say(_json(lab.as_dicts(rows)) if as_json else "\n".join(lab.as_text(rows)))


def _loaded(source: str | None, settings: list[str] | None, accuracy: str | None) -> list[Scene]:
    """One scene, or all that come with the sandbox."""
    from sandbox.scene import listings

    sources = [source] if source is not None else [found.name for found in listings() if "/" not in found.name]
    return [_load(name, settings, accuracy) for name in sources]


def _json(value: Any) -> str:
    """JSON of plain values; what is not finite is null."""
    import json

    from sandbox.files import plain

    return json.dumps(plain(value), allow_nan=False, ensure_ascii=False)


# ---------------------------------------------------------------------------------------------------------------------
# The way out
# ---------------------------------------------------------------------------------------------------------------------


#: Smallest and largest pictures, in px.
SIZES = (320, 180), (7680, 4320)

#: Exit code after Ctrl-C.
STOPPED = 130


def main(args: list[str] | None = None) -> int:
    """Run one command; what goes wrong becomes a line on stderr and an exit code."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="replace")  # a terminal without "±" shows "?"
    if args is None and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _Interrupts())
    try:
        code: int = app(args, prog_name="sandbox", standalone_mode=False) or 0
        return _fail("stopped", code) if code == STOPPED else code
    except typer.TyperException as error:  # unknown command, missing argument, bad option
        return _fail(f"{error.format_message()}\n{_asked(error, args)} --help shows how to ask", error.exit_code)
    except SandboxError as error:
        return _fail(str(error), error.exit_code)
    except KeyboardInterrupt:
        return _fail("stopped", STOPPED)
    except Exception as error:
        from sandbox.tracebacks import of_user_code

        text = of_user_code(error)
        if text is None:
            raise
        return _fail(text, 1)


def _asked(error: typer.TyperException, args: list[str] | None) -> str:
    """The program, or the command of it, that was asked wrongly."""
    context = getattr(error, "ctx", None)
    if context is not None:
        return str(context.command_path)
    first = (sys.argv[1:] if args is None else args)[0]  # of an option without its value only that is known
    return "sandbox" if first.startswith("-") else f"sandbox {first}"


class _Interrupts:
    """Ctrl-C, once: another signal at the same time is the same one, sent to the process and to its group."""

    def __init__(self) -> None:
        self.last = -1.0

    def __call__(self, number: int, frame: FrameType | None) -> None:
        now = time.monotonic()
        if now - self.last < 0.3:
            return
        if _swallows(frame):
            threading.Timer(0.01, os.kill, (os.getpid(), number)).start()  # which comes here again
            return
        self.last = now
        raise KeyboardInterrupt


def _swallows(frame: FrameType | None) -> bool:
    """Whether an exception would be lost here: cffi prints what a callback of pymunk raises, and goes on."""
    while frame is not None:
        file, function = frame.f_code.co_filename, frame.f_code.co_name
        if "pymunk" in file and (file.endswith("_callbacks.py") or function.endswith("free")):
            return True
        frame = frame.f_back
    return False


def _say(text: str) -> None:
    """Print on stdout, at once. The reader of a pipe may go when it likes; a full disk is told."""
    if sys.stdout is None:
        raise RunError("stdout cannot be written: it is closed")
    try:
        typer.echo(text)
        sys.stdout.flush()
    except BrokenPipeError:
        raise typer.Exit(1) from None
    except OSError as error:
        from sandbox.files import reason

        raise RunError(f"stdout cannot be written: {reason(error)}") from None


def _fail(message: str, code: int) -> int:
    typer.echo(message if code == STOPPED else f"error: {message}".rstrip(), err=True)
    if code == STOPPED and isinstance(signal.getsignal(signal.SIGINT), _Interrupts):
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # while Python puts things away
    return code
