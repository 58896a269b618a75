"""Tables and numbers for people."""

from __future__ import annotations

from collections.abc import Sequence

#: Lengths from the smallest unit up, with the length in m at which it begins.
_LENGTHS = (
    (1e3, "km", 1e-3),
    (1.0, "m", 1.0),
    (1e-2, "cm", 1e2),
    (1e-3, "mm", 1e3),
    (1e-6, "µm", 1e6),
    (0.0, "nm", 1e9),
)
_TIMES = ((60.0, "min", 1 / 60), (1.0, "s", 1.0), (1e-3, "ms", 1e3), (0.0, "µs", 1e6))


def table(headings: Sequence[str], rows: Sequence[Sequence[str]], align: str, indent: str = "  ") -> list[str]:
    """Lines with columns aligned as ``align`` says, a letter for each: l or r."""
    cells = [list(headings), *(list(row) for row in rows)]
    widths = [max(len(row[column]) for row in cells) for column in range(len(headings))]

    def line(row: Sequence[str]) -> str:
        parts = [
            text.ljust(width) if side == "l" else text.rjust(width)
            for text, width, side in zip(row, widths, align, strict=True)
        ]
        return (indent + "  ".join(parts)).rstrip()

    return [line(row) for row in cells]


#: Lengths below this, in m, are rounding.
_ROUNDING = 1e-12


def length(metres: float | None) -> str:
    """``0.0032`` as ``3.2 mm``; what is less than rounding is 0."""
    return _scaled(0.0 if metres is not None and abs(metres) < _ROUNDING else metres, _LENGTHS)


def length_above(metres: float | None, least: float) -> str:
    """The same, but what is less than ``least`` (m), and so cannot be told from nothing, as ``< 3.2 mm``."""
    if metres is None or metres >= least or least <= _ROUNDING:
        return length(metres)
    return f"< {length(least)}"


def time(seconds: float | None) -> str:
    """``0.0032`` as ``3.2 ms``."""
    return _scaled(seconds, _TIMES)


def percent(share: float) -> str:
    """``0.0032`` as ``0.3 %``; what is less than rounding is none."""
    return "none" if share < 1e-12 else f"{significant(100.0 * share, 1)} %"


def _scaled(value: float | None, units: Sequence[tuple[float, str, float]]) -> str:
    if value is None:
        return ""
    if value == 0.0:
        return f"0 {units[-1][1]}"
    for begins, unit, factor in units:
        if abs(value) >= begins:
            return f"{significant(value * factor)} {unit}"
    raise AssertionError("the smallest unit begins at 0")


def significant(value: float, digits: int = 2) -> str:
    """A number with so many significant digits, whole from 100 on; a power of ten where it is very small or large."""
    if value == 0.0:
        return "0"
    if not 1e-3 <= abs(value) < 1e6:
        return f"{value:.{digits - 1}e}"
    text = f"{float(f'{value:.{digits}g}'):f}" if abs(value) < 10**digits else f"{value:.0f}"
    return text.rstrip("0").rstrip(".") if "." in text else text
