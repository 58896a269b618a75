"""The rows of a sweep as a Parquet file, if pyarrow is installed."""

from __future__ import annotations

from pathlib import Path

from sandbox.files import written_whole
from sandbox.lab.axes import Span
from sandbox.lab.plan import Plan


def write_parquet(plan: Plan, file: Path, path: Path) -> None:
    """The rows of the CSV ``file``: columns of numbers, booleans or text; empty cells are null."""
    import pyarrow as pa
    from pyarrow import csv, parquet

    numbers = {
        axis.key: pa.float64()
        for axis in plan.axes
        if isinstance(axis, Span) or all(isinstance(value, float) for value in axis.values)
    }
    options = csv.ConvertOptions(column_types=numbers | {"error": pa.string()}, strings_can_be_null=True)
    table = csv.read_csv(file, convert_options=options)
    with written_whole(path) as out:
        parquet.write_table(table, out.buffer)
