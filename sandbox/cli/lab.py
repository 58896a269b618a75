"""The commands that measure the sandbox: ``aim``, ``coefficients``, ``sweep``, ``trade``, ``stress``."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sandbox import entries
from sandbox.cli.arguments import changes_options, load, optional_scene, scene_argument, table_options
from sandbox.cli.reports import Outputs, report_options
from sandbox.errors import RequestError, RunError
from sandbox.files import check_file, is_stream

if TYPE_CHECKING:
    from sandbox.lab.mapped import Choices
    from sandbox.lab.plan import Plan
    from sandbox.scene import Scene

#: The part of an extension that writes a sweep as a page.
PAGES = "pages of sweeps"


@click.command()
@scene_argument
@click.option(
    "--vary", metavar="KEY=LO:HI", multiple=True, required=True, help="A number and its range; once or twice."
)
@click.option("--target", metavar="NAME=VALUE", multiple=True, help="A result and its target value; once or twice.")
@click.option("--maximize", metavar="NAME", help="Result to maximize; of a yes or no, how often it is yes.")
@changes_options
@report_options
def aim(
    scene: str,
    vary: tuple[str, ...],
    target: tuple[str, ...],
    maximize: str | None,
    changes: dict[str, Any],
    outputs: Outputs,
) -> None:
    """Find all values in a range that give a result.

    Each has its numerical error. For a target that is true or false, a word, or a whole number such as a score, it
    finds intervals: the widest first, with its middle, which is the most forgiving value; by two parameters it finds
    regions, each with its most forgiving point. If there is no solution it reports the nearest result, and the exit
    code is 0.

    A number that jumps, such as where a golf ball stops, takes a minute or two, since each place where it may reach the
    target is searched. Intervals take 500 to 2,000 runs, and up to 12,000 more where the result changes, to see narrow
    gaps.

    \b
    Examples:
      sandbox aim golf --vary launch.angle=2:75 --target carry=200
      sandbox aim basketball --vary launch.speed=6:10 --target made=true --plot tries.png
      sandbox aim basketball --vary launch.speed=6:9 --vary launch.angle=35:70 --target made=true
      sandbox aim golf --vary launch.angle=2:60 --maximize carry
      sandbox aim basketball --vary launch.angle=46:60 --vary launch.speed=7.2:7.8 --maximize made
      sandbox aim golf --vary launch.angle=2:60 --vary launch.speed=40:90 --target carry="219 yd" --target apex=30
    """
    from sandbox.lab.aim import parse_target, search
    from sandbox.lab.aim.question import MAXIMIZE, Target
    from sandbox.lab.aim.report import report_of
    from sandbox.lab.axes import parse_span
    from sandbox.progress import bar

    chosen = load(scene, changes)
    spans = [parse_span(chosen, "--vary", text) for text in vary]
    targets = [parse_target(text, chosen) for text in target]
    if maximize is not None:
        targets.append(Target(maximize, MAXIMIZE))
    if not targets:
        raise RequestError("nothing to aim at: give --target NAME=VALUE or --maximize NAME")
    with bar("aim") as progress:
        found = search(chosen, spans, targets, progress)
    outputs.write(report_of(found))


@click.command()
@scene_argument
@click.option(
    "--over",
    metavar="KEY=LO:HI:N",
    multiple=True,
    help="A parameter and its values, also as KEY=A,B,C or KEY=MEAN~SD; repeatable.",
)
@click.option(
    "--points",
    metavar="F.csv",
    type=Path,
    help="Points in a table, in place of --over: a column for each KEY, or shots as a launch monitor writes them.",
)
@table_options
@click.option("--out", metavar="F.csv", type=Path, required=True, help="CSV file to write, one row per point.")
@changes_options
@click.option(
    "--samples",
    metavar="N",
    type=click.IntRange(1),
    help="Number of random points, from ranges, normal distributions (MEAN~SD) and lists.",
)
@click.option("--seed", metavar="N", type=click.IntRange(0), help="Seed of the random points.  [default: 0]")
@click.option("--check", is_flag=True, help="Rerun each point at finer accuracy and add its errors.")
@click.option("--of", metavar="NAME", help="The result that --plot and --html show.")
@click.option(
    "--family",
    metavar="KEY",
    help="Of --plot over two parameters: a curve for each value of this one, in place of a map.",
)
@click.option("--jobs", metavar="N", type=int, help="Number of processes.  [default: chosen automatically]")
@click.option("--scheduler", metavar="ADDRESS", help="Run on the workers of a Dask scheduler.")
@report_options
def sweep(
    scene: str,
    over: tuple[str, ...],
    points: Path | None,
    choices: Choices,
    out: Path,
    changes: dict[str, Any],
    samples: int | None,
    seed: int | None,
    check: bool,
    of: str | None,
    family: str | None,
    jobs: int | None,
    scheduler: str | None,
    outputs: Outputs,
) -> None:
    """Run a scene at many points: a grid, random, or a table.

    Writes one row per point. Ctrl-C keeps the rows that are done; the same command again resumes from there. If the
    file holds another sweep, that is kept as F.csv~. A point that fails is a row with its error.

    \b
    Examples:
      sandbox sweep basketball --over launch.speed=6:9:61 --over launch.angle=35:75:41 --out map.csv --plot map.png
      sandbox sweep golf --over launch.angle=5:40:71 --over ball.drag.model=tour-fit,usga --out carry.csv
      sandbox sweep golf --over launch.speed="160 mph:180 mph" --over air.wind[0]=-8:8 --samples 5000 --out wind.csv
      sandbox sweep basketball --over launch.speed=7.4~0.08 --over launch.angle=52~1.0 --samples 5000 --out throws.csv
      sandbox sweep throws --over launch.angle=20:60:81 --over release.height=0,1,2 --out put.csv \\
        --plot put.png --family release.height
      sandbox sweep golf --points measured-launches.csv --out carry.csv
      sandbox sweep golf --points trackman.csv --where Club=Driver --set air.density=1.1 --out thin.csv
    """
    from sandbox.lab.row_file import rows
    from sandbox.lab.sweep import sweep_to_file, workers, worthwhile_jobs
    from sandbox.progress import bar

    plan, notes = _plan(load(scene, changes), over, points, choices, samples, seed, check)
    check_file("--out", out, ".csv")
    _check_chart(plan, outputs, of, family)
    outputs.check({"--out": out})
    with workers(worthwhile_jobs(plan) if jobs is None else jobs, scheduler) as pool, bar("sweep") as progress:
        done = sweep_to_file(plan, out, pool, progress)
    charts, page = [], None
    if outputs.plot is not None or outputs.page is not None:
        from sandbox.lab.maps import chart_of, read

        shown = read(plan, rows(out), of)
        charts.append(chart_of(plan, shown, family))
        if outputs.page is not None:
            page = partial(entries.require(PAGES, "--html").page_of, plan, shown, of, family)
    new = [out] if done.points > done.resumed else []
    outputs.write(done.report(charts, notes), others=new, page_of=page, quiet=is_stream(out))
    if done.failures == done.points - done.resumed > 0:
        raise RunError(f"every point failed, the first with: {done.first_error}")


def _plan(
    scene: Scene,
    over: tuple[str, ...],
    points: Path | None,
    choices: Choices,
    samples: int | None,
    seed: int | None,
    check: bool,
) -> tuple[Plan, tuple[str, ...]]:
    """The points of a sweep, and sentences on how a table of shots was read. Raises RequestError for options that do
    not go together."""
    from sandbox.lab.axes import parse_axis
    from sandbox.lab.plan import Plan
    from sandbox.lab.points import points_from

    if seed is not None and samples is None:
        raise RequestError(f"--seed {seed}: requires --samples")
    if points is None and choices:
        raise RequestError("--map, --where, --without and --strict require --points F.csv")
    if points is not None:
        if over or samples is not None:
            raise RequestError(f"--points {points}: cannot be combined with --over or --samples")
        axes, found = points_from(scene, "--points", points, choices)
        return Plan(scene, axes, check=check, listed=True), () if found is None else found.sentences
    if not over:
        raise RequestError("nothing to sweep over: give --over KEY=LO:HI:N, or --points F.csv")
    axes_over = tuple(parse_axis(scene, "--over", text) for text in over)
    return Plan(scene, axes_over, samples or 0, seed or 0, check), ()


def _check_chart(plan: Plan, outputs: Outputs, of: str | None, family: str | None) -> None:
    """Raise RequestError if a sweep cannot be drawn so."""
    if outputs.plot is None and outputs.page is None:
        for option, given in (("--of", of), ("--family", family)):
            if given is not None:
                raise RequestError(f"{option} {given}: requires --plot or --html")
        return
    from sandbox.lab.maps import check_plot

    check_plot(plan, of, family)
    if outputs.page is not None:
        entries.require(PAGES, "--html").check_page(plan)


@click.command()
@scene_argument
@changes_options
@click.option("--all", "everything", is_flag=True, help="Every setting, verdict, and part of the model.")
@report_options
def trade(scene: str, changes: dict[str, Any], everything: bool, outputs: Outputs) -> None:
    """Measure the speed-accuracy trade-off of a scene.

    The cheapest way to each accuracy, and how many times as long pymunk alone takes (the plain method). Verdicts of
    shots around the scene's own are the same, another, or the method failed. Takes a minute on an idle machine.

    \b
    Examples:
      sandbox trade golf
      sandbox trade basketball/rattle --plot rattle.png
      sandbox trade my-shot.toml --set air.wind=[-8,0] --json
    """
    from sandbox.lab.trade import report_of
    from sandbox.lab.trade import trade as measured
    from sandbox.progress import bar

    chosen = load(scene, changes)
    with bar("trade") as progress:
        found = measured(chosen, progress)
    outputs.write(report_of(found), everything)


@click.command()
@optional_scene
@changes_options
@click.option("--all", "everything", is_flag=True, help="Every extreme.")
@report_options
def stress(scene: str | None, changes: dict[str, Any], everything: bool, outputs: Outputs) -> None:
    """Run a scene, or all of them, at extreme values.

    What held, what was refused with a clear error, and what failed, by method; then each failure.

    \b
    Examples:
      sandbox stress             # all scenes, and setups without a scene
      sandbox stress golf
      sandbox stress golf/driver --accuracy fast --json
    """
    from sandbox.lab.stress import report_of
    from sandbox.lab.stress import stress as tried
    from sandbox.progress import bar
    from sandbox.scene import listings

    names = [listing.name for listing in listings() if "/" not in listing.name] if scene is None else [scene]
    scenes = [load(name, changes) for name in names]
    with bar("stress") as progress:
        outcomes = tried(scenes, changes.get("accuracy.level", "balanced"), scene is None, progress)
    outputs.write(report_of(outcomes), everything)


@click.command()
@scene_argument
@changes_options
@report_options
def coefficients(scene: str, changes: dict[str, Any], outputs: Outputs) -> None:
    """Table the drag and lift coefficients of a ball by model.

    \b
    Examples:
      sandbox coefficients soccer
      sandbox coefficients golf --plot golf.png
    """
    from sandbox.lab.coefficients import report_of

    outputs.write(report_of(load(scene, changes)))
