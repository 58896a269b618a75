"""A fit as a scene file that reproduces it, with the points next to it."""

from __future__ import annotations

import tomllib
from pathlib import Path

from sandbox.errors import RequestError
from sandbox.files import check_file, check_installed, check_replaced, write_together
from sandbox.lab.fit.report import residual_text, title, value_rows
from sandbox.lab.fit.squares import Fit
from sandbox.scene.writing import scene_text


def _points_file(path: Path) -> Path:
    """The file with the points of a scene file."""
    return path.with_suffix(".csv")


def check_saving(option: str, path: Path, has_points: bool) -> None:
    """Raise RequestError, before any work is done, if the scene file cannot be written, or its points, if it has some,
    would be written over a file that is not those of the scene file which is replaced."""
    check_file(option, path, ".toml")
    check_installed(option, "tomlkit")
    if not has_points:
        return
    points = _points_file(path)
    if points.exists() and _points_named(path) != points.resolve():
        raise RequestError(f"{option} {path}: its points would be written over {points}; choose another name")
    check_replaced(option, points)


def _points_named(path: Path) -> Path | None:
    """The file that an earlier scene file names as its points; None if there is none."""
    try:
        return (path.parent / tomllib.loads(path.read_text("utf-8"))["measured"]["track"]).resolve()
    except (OSError, ValueError, KeyError, TypeError):
        return None


def save(found: Fit, path: Path) -> list[Path]:
    """Write the scene file, and the points in the scene's coordinates next to it: both or none; what they replace is
    kept with ``~``. Returns their paths."""
    points = found.measured.points(found.scene, found.free)
    track = _points_file(path).name if points is not None else ""
    about = [f"Fitted: {title(found)}; residuals {residual_text(found)}."]
    about += [f"{key}: {low_to_high} {unit} (95 %)".replace("  ", " ")
              for key, _, unit, low_to_high, _ in value_rows(found)]  # fmt: skip
    files = {path: scene_text(found.scene, path.parent, "\n".join(about), track).encode()}
    if points is not None:
        files[_points_file(path)] = points.as_csv().encode()
    write_together(files, kept=True)
    return list(files)
