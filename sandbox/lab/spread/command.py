"""``sandbox spread``: how results scatter when parameters do."""

from __future__ import annotations

from typing import Any

import click

from sandbox.cli.arguments import (
    changes_options,
    load,
    scene_argument,
    units_option,
)
from sandbox.cli.reports import Outputs, report_options
from sandbox.errors import RequestError


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
@report_options
def spread(
    scene: str,
    by: tuple[str, ...],
    of: tuple[str, ...],
    changes: dict[str, Any],
    samples: int,
    seed: int,
    sampling: str,
    within: tuple[str, ...],
    no_causes: bool,
    outputs: Outputs,
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
      sandbox spread billiards/nine-ball-break --by cue.speed=3% --samples 256 --html breaks.html
    """
    from sandbox.lab.spread.causes import causes_of, parse_cause
    from sandbox.lab.spread.needs import parse_within
    from sandbox.lab.spread.report import report_of
    from sandbox.lab.spread.spreading import check_scipy, spread_of
    from sandbox.progress import bar
    from sandbox.text import no_such_result

    chosen = load(scene, changes)
    causes = causes_of(chosen, [parse_cause(chosen, "--by", text) for text in by], "--by")
    for name in of:
        if name not in chosen.facts:
            raise RequestError(f"--of {name}: {no_such_result(name, list(chosen.facts))}")
    widths = dict(parse_within(chosen, text) for text in within)
    check_scipy()
    with bar("spread") as progress:
        found = spread_of(chosen, causes, of, samples, seed, sampling, not no_causes, widths, progress)
    outputs.write(report_of(found))
