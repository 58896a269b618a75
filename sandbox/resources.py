"""The folders of scenes and assets: next to the package in a checkout, inside it in an installed wheel."""

from __future__ import annotations

from functools import cache
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent


@cache
def folder(name: str) -> Path:
    """The folder ``scenes`` or ``assets`` that came with this sandbox."""
    inside = PACKAGE / name
    return inside if inside.is_dir() else PACKAGE.parent / name
