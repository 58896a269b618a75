"""``sandbox session``: a player's shots as a coach wants them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sandbox.cli.arguments import changes_options, table_options
from sandbox.cli.reports import Outputs, report_options
from sandbox.errors import RequestError

if TYPE_CHECKING:
    from sandbox.lab.mapped import Choices


@click.command()
@click.argument("file", metavar="FILE", type=Path, help="A table of shots, one in each row.")
@click.argument("second", metavar="[FILE2]", type=Path, required=False, help="Another session, to compare.")
@click.option("--scene", metavar="NAME", help="The sport.  [default: that of the device, by its columns]")
@click.option("--by", metavar="COLUMN", help="Group by this column.  [default: the club, or words that repeat]")
@click.option("--of", metavar="COLUMN", multiple=True, help="Report another column of numbers, too; repeatable.")
@table_options
@click.option(
    "--set-aside",
    "mishit",
    metavar="Z|none",
    default="3.5",
    show_default=True,
    help="Shots farther from their group's median are mishits: in modified z-scores.",
)
@changes_options
@click.option(
    "--was",
    metavar="KEY=VALUE",
    multiple=True,
    help="The air of the session, where it was not the scene's; repeatable.",
)
@report_options
def session(
    file: Path,
    second: Path | None,
    scene: str | None,
    by: str | None,
    of: tuple[str, ...],
    choices: Choices,
    mishit: str,
    changes: dict[str, Any],
    was: tuple[str, ...],
    outputs: Outputs,
) -> None:
    """Summarize a session of shots on one page.

    By club, pitch or any column: count, mean and standard deviation of each result and of the launch, gaps, where shots
    come down, the model against the monitor. Mishits are set aside by a rule that is stated. --set asks for the same
    launches today: the change that the model gives in other air or wind, added to what was measured. A second file is
    compared, with 95 % intervals of the differences. Any columns will do.

    \b
    Examples:
      sandbox session shots.csv
      sandbox session shots.csv --html session.html
      sandbox session shots.csv --set air.temperature=5 --set air.wind=[-6,0] --was air.elevation=600
      sandbox session before.csv after.csv --plot compared.png
      sandbox session throws.csv --scene basketball --by player --map "made=went in"
    """
    from sandbox.lab.session.summary import summarized
    from sandbox.parameters import parse_assignment
    from sandbox.progress import bar

    with bar("session") as progress:
        air = dict(map(parse_assignment, was))
        found = summarized(file, second, scene, by, of, choices, changes, air, _limit(mishit), progress)
    outputs.write(found.report())


def _limit(text: str) -> float | None:
    """The score beyond which shots are mishits, or None. Raises RequestError."""
    if text == "none":
        return None
    try:
        limit = float(text)
    except ValueError:
        limit = 0.0
    if not 0.0 < limit < float("inf"):
        raise RequestError(f"--set-aside {text}: must be a number above 0, or none")
    return limit
