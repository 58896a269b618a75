"""The commands that measure the sandbox: ``aim``, ``coefficients``, ``spread``, ``sweep``, ``trade``, ``stress``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sandbox import entries
from sandbox.cli.arguments import (
    changes_options,
    json_option,
    load,
    optional_scene,
    say,
    scene_argument,
    units_option,
)
from sandbox.errors import RequestError, RunError
from sandbox.files import check_distinct, check_file, check_installed, is_stream, json_text, writing

if TYPE_CHECKING:
    from sandbox.lab.plan import Plan
    from sandbox.lab.spread import Spread
    from sandbox.scene import Scene

#: The part of an extension that writes a sweep as a page.
PAGES = "pages of sweeps"


@click.command()
@scene_argument
@click.option(
    "--vary", metavar="KEY=LO:HI", multiple=True, required=True, help="A number and its range; once or twice."
)
@click.option("--target", metavar="NAME=VALUE", multiple=True, help="A result and its target value; once or twice.")
@click.option("--maximize", metavar="NAME", help="Result to maximize.")
@changes_options
@json_option
@click.option("--show", metavar="F.png", type=Path, help="Draw the results of all trials.")
def aim(
    scene: str,
    vary: tuple[str, ...],
    target: tuple[str, ...],
    maximize: str | None,
    changes: dict[str, Any],
    as_json: bool,
    show: Path | None,
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
      sandbox aim basketball --vary launch.speed=6:10 --target made=true --show tries.png
      sandbox aim basketball --vary launch.speed=6:9 --vary launch.angle=35:70 --target made=true
      sandbox aim golf --vary launch.angle=2:60 --maximize carry
      sandbox aim golf --vary launch.angle=2:60 --vary launch.speed=40:90 --target carry="219 yd" --target apex=30
    """
    from sandbox.lab.aim import parse_target, search
    from sandbox.lab.aim.question import MAXIMIZE, Target
    from sandbox.lab.axes import parse_span
    from sandbox.progress import bar

    chosen = load(scene, changes)
    spans = [parse_span(chosen, "--vary", text) for text in vary]
    targets = [parse_target(text, chosen) for text in target]
    if maximize is not None:
        targets.append(Target(maximize, MAXIMIZE))
    if not targets:
        raise RequestError("nothing to aim at: give --target NAME=VALUE or --maximize NAME")
    if show is not None:
        from sandbox.lab.chart import check_chart

        check_chart("--show", show)
    with bar("aim") as progress:
        found = search(chosen, spans, targets, progress)
    from sandbox.lab.aim import report

    if show is not None:
        with writing("--show", show):
            report.draw(found, show)
    if as_json:
        say(report.as_json(found))
    else:
        written = [] if show is None else [f"wrote {show}"]
        say("\n".join([*report.as_text(found), *written]))


@click.command()
@scene_argument
@click.option(
    "--by",
    metavar="KEY=SD",
    multiple=True,
    help="A parameter and its standard deviation: in its unit, as 1%, or evenly over LO:HI; repeatable.  "
    "[default: the scene's practised player]",
)
@click.option("--of", metavar="NAME", multiple=True, help="A result to report; repeatable.  [default: all]")
@changes_options
@json_option
@click.option(
    "--samples", metavar="N", type=click.IntRange(16, 1_000_000), default=1024, show_default=True,
    help="Number of shots; as many again for each cause.",
)  # fmt: skip
@click.option("--seed", metavar="N", type=click.IntRange(0), default=0, show_default=True, help="Seed of the points.")
@click.option(
    "--sampling", type=click.Choice(("sobol", "random")), default="sobol", show_default=True,
    help="Points that cover the distribution evenly, or random ones.",
)  # fmt: skip
@click.option(
    "--within",
    metavar="NAME=WIDTH",
    multiple=True,
    help="Ask how many shots tell a result to within +-WIDTH: carry=1, made=5%; repeatable.",
)
@click.option("--no-causes", is_flag=True, help="Leave out how much of the variance each cause accounts for.")
@units_option
@click.option("--plot", metavar="F.png", type=Path, help="Draw histograms and causes.")
@click.option("--page", "--html", "page", metavar="F.html", type=Path, help="Write them as a page for any browser.")
def spread(
    scene: str,
    by: tuple[str, ...],
    of: tuple[str, ...],
    changes: dict[str, Any],
    as_json: bool,
    samples: int,
    seed: int,
    sampling: str,
    within: tuple[str, ...],
    no_causes: bool,
    plot: Path | None,
    page: Path | None,
) -> None:
    """Show how results scatter when parameters do.

    The same shot many times, each parameter scattering around its value: mean, standard deviation and quantiles of each
    result, the share of shots that score with its 95 % interval, how much of the variance each cause accounts for,
    and how many shots a real test needs.

    \b
    Examples:
      sandbox spread basketball
      sandbox spread golf --by launch.speed=1% --by launch.angle=1deg --plot spread.png
      sandbox spread golf --by launch.spin="200 rpm" --by air.wind[0]=-3:3 --of carry --within carry=1
      sandbox spread billiards/nine-ball-break --by cue.speed=3% --samples 256 --page breaks.html
    """
    from sandbox.lab.spread import check_scipy, report, spread_of
    from sandbox.lab.spread.causes import causes_of, parse_cause
    from sandbox.lab.spread.needs import parse_within
    from sandbox.progress import bar
    from sandbox.text import no_such_result

    chosen = load(scene, changes)
    causes = causes_of(chosen, [parse_cause(chosen, "--by", text) for text in by], "--by")
    for name in of:
        if name not in chosen.facts:
            raise RequestError(f"--of {name}: {no_such_result(name, list(chosen.facts))}")
    widths = dict(parse_within(chosen, text) for text in within)
    _check_outputs(plot, page)
    check_scipy()
    with bar("spread") as progress:
        found = spread_of(chosen, causes, of, samples, seed, sampling, not no_causes, widths, progress)
    _write_outputs(found, plot, page)
    written = [f"wrote {path}" for path in (plot, page) if path is not None]
    say(report.as_json(found) if as_json else "\n".join([*report.as_text(found), *written]))


def _check_outputs(plot: Path | None, page: Path | None) -> None:
    """Raise RequestError if the scatter cannot be written there."""
    if plot is not None:
        from sandbox.lab.chart import check_chart

        check_chart("--plot", plot)
    if page is not None:
        check_file("--page", page, ".html")
        check_installed("--page", "matplotlib")
    check_distinct({"--plot": plot, "--page": page})


def _write_outputs(found: Spread, plot: Path | None, page: Path | None) -> None:
    """Write the scatter as picture and page, where they are asked for."""
    if plot is not None:
        from sandbox.lab.spread.chart import draw

        with writing("--plot", plot):
            draw(found, plot)
    if page is not None:
        from sandbox.page.parts import save
        from sandbox.page.spread import page_of

        with writing("--page", page):
            save(page_of(found), page)


@click.command()
@scene_argument
@click.option(
    "--over",
    metavar="KEY=LO:HI:N",
    multiple=True,
    help="A parameter and its values, also as KEY=A,B,C or KEY=MEAN~SD; repeatable.",
)
@click.option(
    "--points", metavar="F.csv", type=Path, help="Points in a table: a column for each KEY, in place of --over."
)
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
@click.option("--plot", metavar="F.png", type=Path, help="A map over two parameters, a curve over one.")
@click.option(
    "--html", metavar="F.html", type=Path, help="A page with the map, and the path of the point under the cursor."
)
@click.option("--of", metavar="NAME", help="The result that --plot and --html show.")
@click.option(
    "--family",
    metavar="KEY",
    help="Of --plot over two parameters: a curve for each value of this one, in place of a map.",
)
@click.option("--jobs", metavar="N", type=int, help="Number of processes.  [default: chosen automatically]")
@click.option("--scheduler", metavar="ADDRESS", help="Run on the workers of a Dask scheduler.")
def sweep(
    scene: str,
    over: tuple[str, ...],
    points: Path | None,
    out: Path,
    changes: dict[str, Any],
    samples: int | None,
    seed: int | None,
    check: bool,
    plot: Path | None,
    html: Path | None,
    of: str | None,
    family: str | None,
    jobs: int | None,
    scheduler: str | None,
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
    """
    from sandbox.lab.sweep import sweep_to_file, workers, worthwhile_jobs
    from sandbox.progress import bar

    plan = _plan(load(scene, changes), over, points, samples, seed, check)
    check_file("--out", out, ".csv")
    _check_pictures(plan, plot, html, of, family)
    check_distinct({"--out": out, "--plot": plot, "--html": html})
    with workers(worthwhile_jobs(plan) if jobs is None else jobs, scheduler) as pool, bar("sweep") as progress:
        done = sweep_to_file(plan, out, pool, progress)
    _draw(plan, out, plot, html, of, family)
    if not is_stream(out):
        new = out if done.points > done.resumed else None
        written = [f"wrote {path}" for path in (new, plot, html) if path is not None]
        say("\n".join([done.as_text(), *written]))
    if done.failures == done.points - done.resumed > 0:
        raise RunError(f"every point failed, the first with: {done.first_error}")


def _plan(
    scene: Scene, over: tuple[str, ...], points: Path | None, samples: int | None, seed: int | None, check: bool
) -> Plan:
    """The points of a sweep. Raises RequestError for options that do not go together."""
    from sandbox.lab.axes import parse_axis, points_in
    from sandbox.lab.plan import Plan

    if points is not None:
        if over or samples is not None:
            raise RequestError(f"--points {points}: cannot be combined with --over or --samples")
        plan = Plan(scene, points_in(scene, "--points", points), check=check, listed=True)
    elif over:
        plan = Plan(scene, tuple(parse_axis(scene, "--over", text) for text in over), samples or 0, seed or 0, check)
    else:
        raise RequestError("nothing to sweep over: give --over KEY=LO:HI:N, or --points F.csv")
    if seed is not None and samples is None:
        raise RequestError(f"--seed {seed}: requires --samples")
    return plan


def _check_pictures(plan: Plan, plot: Path | None, html: Path | None, of: str | None, family: str | None) -> None:
    """Raise RequestError if a sweep cannot be drawn so."""
    if of is not None and plot is None and html is None:
        raise RequestError(f"--of {of}: requires --plot or --html")
    if family is not None and plot is None:
        raise RequestError(f"--family {family}: requires --plot")
    if plot is not None:
        from sandbox.lab.chart import check_chart
        from sandbox.lab.maps import check_plot

        check_chart("--plot", plot)
        check_plot(plan, of, family)
    if html is not None:
        check_file("--html", html, ".html")
        check_installed("--html", "matplotlib")
        entries.require(PAGES, "--html").check_page(plan)


def _draw(plan: Plan, out: Path, plot: Path | None, html: Path | None, of: str | None, family: str | None) -> None:
    """Draw the rows of a sweep as picture and page, where they are asked for."""
    from sandbox.lab.row_file import rows

    if plot is not None:
        from sandbox.lab.maps import draw_sweep

        with writing("--plot", plot):
            draw_sweep(plan, rows(out), plot, of, family)
    if html is not None:
        with writing("--html", html):
            entries.require(PAGES, "--html").save_page(plan, rows(out), html, of)


@click.command()
@scene_argument
@changes_options
@json_option
@click.option("--all", "everything", is_flag=True, help="Every setting, verdict, and part of the model.")
@click.option("--plot", metavar="F.png", type=Path, help="Plot error against speed, one curve per method.")
def trade(scene: str, changes: dict[str, Any], as_json: bool, everything: bool, plot: Path | None) -> None:
    """Measure the speed-accuracy trade-off of a scene.

    The cheapest way to each accuracy, and how many times as long pymunk alone takes (the plain method). Verdicts of
    shots around the scene's own are the same, another, or the method failed. Takes a minute on an idle machine.

    \b
    Examples:
      sandbox trade golf
      sandbox trade basketball/rattle --plot rattle.png
      sandbox trade my-shot.toml --set air.wind=[-8,0] --json
    """
    from sandbox.lab import chart
    from sandbox.lab import trade as lab
    from sandbox.progress import bar

    chosen = load(scene, changes)
    if plot is not None:
        chart.check_chart("--plot", plot)
    with bar("trade") as progress:
        found = lab.trade(chosen, progress)
    if plot is not None:
        with writing("--plot", plot):
            chart.draw_trade(found, plot)
    say(json_text(lab.as_dict(found)) if as_json else "\n".join(lab.as_text(found, everything)))


@click.command()
@optional_scene
@changes_options
@json_option
@click.option("--all", "everything", is_flag=True, help="Every extreme.")
def stress(scene: str | None, changes: dict[str, Any], as_json: bool, everything: bool) -> None:
    """Run a scene, or all of them, at extreme values.

    What held, what was refused with a clear error, and what failed, by method; then each failure.

    \b
    Examples:
      sandbox stress             # all scenes, and setups without a scene
      sandbox stress golf
      sandbox stress golf/driver --accuracy fast --json
    """
    from sandbox.lab import stress as lab
    from sandbox.progress import bar
    from sandbox.scene import listings

    names = [listing.name for listing in listings() if "/" not in listing.name] if scene is None else [scene]
    scenes = [load(name, changes) for name in names]
    with bar("stress") as progress:
        outcomes = lab.stress(scenes, changes.get("accuracy.level", "balanced"), scene is None, progress)
    say(json_text(outcomes) if as_json else "\n".join(lab.as_text(outcomes, everything)))


@click.command()
@scene_argument
@changes_options
@click.option(
    "--plot",
    metavar="[F.png]",
    type=Path,
    is_flag=False,
    flag_value=Path("-"),
    help="Draw Cd over Reynolds number and Cl over spin ratio.  [default: SCENE-coefficients.png]",
)
@json_option
def coefficients(scene: str, changes: dict[str, Any], plot: Path | None, as_json: bool) -> None:
    """Table the drag and lift coefficients of a ball by model.

    \b
    Examples:
      sandbox coefficients soccer
      sandbox coefficients golf --plot golf.png
    """
    from sandbox.lab import chart
    from sandbox.lab import coefficients as of_ball

    chosen = load(scene, changes)
    if plot is not None:
        plot = Path(f"{chosen.name}-coefficients.png") if plot == Path("-") else plot
        chart.check_chart("--plot", plot)
    found = of_ball.coefficients(chosen)
    if plot is not None:
        of_ball.draw(chosen, plot)
    wrote = [] if plot is None else ["", f"wrote {plot}"]
    say(json_text(of_ball.as_json(found)) if as_json else "\n".join([*of_ball.as_text(found), *wrote]))
