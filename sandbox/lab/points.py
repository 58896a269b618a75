"""Points of a sweep, or of many runs, from a table: parameters in its first line, or the shots of a device."""

from __future__ import annotations

from pathlib import Path

from sandbox.errors import RequestError
from sandbox.lab.axes import Values, points_in
from sandbox.lab.mapped import EVERYTHING, Choices, Mapped, read_shots
from sandbox.lab.table_file import first_cells, read_table
from sandbox.parameters import walk
from sandbox.scene import Scene


def points_from(
    scene: Scene, option: str, path: Path, choices: Choices = EVERYTHING
) -> tuple[tuple[Values, ...], Mapped | None]:
    """The values of each parameter at the points of a table; and the shots, where it is one of these. Raises
    RequestError."""
    if not choices and _names_parameters(scene, path):
        return points_in(scene, option, path), None
    found = read_shots(scene, read_table(option, path), choices, launches_only=True)
    if not found.given:
        raise RequestError(f"{found.table.where}: has nothing of the launch among the columns that are used")
    return tuple(Values(key, tuple(one.values.tolist())) for key, one in found.given.items()), found


def _names_parameters(scene: Scene, path: Path) -> bool:
    """True if the first line has the key of a parameter, or cannot be read, as that of a pipe or a device."""
    first, keys = first_cells(path), {one.key for one in walk(scene.parameters, entries=True)}
    return first is None or any({name, name.partition("[")[0]} & keys for name in first)
