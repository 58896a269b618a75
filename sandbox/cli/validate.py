"""``sandbox validate``: results compared with what was measured."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sandbox.cli.arguments import changes_options, optional_scene, pairs, table_options
from sandbox.cli.reports import Outputs, report_options
from sandbox.errors import RequestError
from sandbox.text import printable

if TYPE_CHECKING:
    from sandbox.lab.mapped import Choices


@click.command()
@optional_scene
@click.option("--against", metavar="F.csv", type=Path, help="A table of your own in place of the published ones.")
@table_options
@click.option(
    "--within",
    metavar="NAME=WIDTH",
    multiple=True,
    help='How far off a result of a launch may be, as carry="5 yd" or carry=2%; repeatable.',
)
@click.option("--by", metavar="COLUMN", help="Compare by the words of a column too, or by bins of its numbers.")
@click.option("--all", "everything", is_flag=True, help="List the launches one by one.")
@changes_options
@click.option("--teeth", is_flag=True, help="Switch off, or change by 20 %, what each row tests: does it fall?")
@report_options
def validate(
    scene: str | None,
    against: Path | None,
    choices: Choices,
    within: tuple[str, ...],
    by: str | None,
    everything: bool,
    changes: dict[str, Any],
    teeth: bool,
    outputs: Outputs,
) -> None:
    """Compare results with published numbers and their sources.

    Each row is exact, fitted, of another program, of a model, measured, or held out of a fit. Only measured and
    held-out rows are counted. The exit code is 0 however many hold: a number that the models miss is a finding.

    A table of your own has the columns result, value and tolerance, and as you like scene, case, set, unit, source,
    kind and the others of the published tables; or one launch in each row, with its columns known or
    named by --map. Launches without --within are compared without tolerances: the bias of each result, and its scatter.

    \b
    Examples:
      sandbox validate
      sandbox validate golf --teeth
      sandbox validate golf --set ball.drag.model=usga --set ball.lift.model=usga
      sandbox validate golf --against shots.csv --by Club
      sandbox validate golf --against shots.csv --within carry=3% --within apex="3 yd"
    """
    from sandbox.lab import teeth as of_rows
    from sandbox.lab import validate as lab
    from sandbox.progress import bar

    own = None
    notes: tuple[str, ...] = ()
    if against is not None:
        from sandbox.lab import misfit
        from sandbox.lab.against import Shots, cases_of_shots, read_against

        if teeth:
            raise RequestError("--teeth: says what the published numbers test; it cannot be combined with --against")
        given = read_against(against, scene, replace(choices, decided=tuple(changes)))
        tolerances = pairs("--within", within)
        if isinstance(given, Shots) and not tolerances:
            with bar("validate") as progress:
                found = misfit.misfit(given, changes, by, choices.strict, progress)
            outputs.write(misfit.report_of(found), everything)
            return
        if by is not None or everything:
            raise RequestError("--by and --all are for a table of launches without --within")
        if isinstance(given, Shots):
            own, left_out, notes = cases_of_shots(given, tolerances)
            notes = tuple(filter(None, (left_out, *notes)))
            if outputs.as_json and left_out:  # JSON is a list of the rows that are used
                click.echo(printable(left_out), err=True)
        elif tolerances:
            raise RequestError(f"--within: the table has its own tolerances: {against}")
        else:
            own = given
    elif choices or within or by is not None or everything:
        raise RequestError("--map, --where, --without, --within, --by, --all and --strict require --against F.csv")
    with bar("validate") as progress:
        rows = lab.validate(scene, changes, progress, own)
    if teeth:
        with bar("teeth") as progress:
            outputs.write(of_rows.report_of(rows, of_rows.teeth(rows, changes, progress)))
        return
    outputs.write(lab.report_of(rows, "published" if own is None else "given", notes))
