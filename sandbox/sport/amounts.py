"""Numbers as people read them: ``253.6 m``, ``38.1°``, ``2545 rpm``. JSON and CSV hold the numbers themselves."""

from __future__ import annotations

from sandbox import units

#: Digits after the point, by unit; three figures for a unit that is not here.
DIGITS = {"m/s": 1, "mph": 0, "km/h": 0, "deg": 1, "moa": 1, "rpm": 0, "s": 2, "yd": 0, "ft": 1, "J": 1}

#: Below this a number has one more digit: 7.47 m/s, 12.3 yd.
FINER_BELOW = {"m/s": 10.0, "yd": 20.0}


def amount(value: float, unit: str = "") -> str:
    """A number with its unit. A length shorter than 10 cm is written in cm, one from 10 km on in km."""
    if isinstance(value, int):
        return f"{value} {unit}".rstrip()
    if unit == "m":
        return f"{signed(f'{100 * value:.1f}')} cm" if 0.0005 <= abs(value) < 0.0995 else metres(value)
    if unit not in DIGITS:
        return f"{signed(f'{value:.3g}')} {unit}".rstrip()
    number = signed(f"{value:.{DIGITS[unit] + (abs(value) < FINER_BELOW.get(unit, 0.0))}f}")
    return f"{number}°" if unit == "deg" else f"{number} {unit}"


def converted(value: float, unit: str, other: str) -> str:
    """A number of ``unit`` written in the unit ``other``."""
    return amount(units.convert(value, unit, other), other)


def margin(error: float, unit: str, count: bool = False) -> str:
    """An estimated error: ``± 0.4 mm``; "" for a count that stays the same."""
    if count and error == int(error):
        return f"± {error:.0f}" if error else ""
    if unit == "m" and error < 0.1:
        error, unit = error * 1e3, "mm"
    written = f"± {significant(error, 1)}" if error >= 1e-3 else "± less than 0.001"
    return f"{written}°" if unit == "deg" else f"{written} {unit}".rstrip()


def significant(value: float, digits: int = 2) -> str:
    """A number with this many significant digits, an integer from 100, with an exponent if very small or large."""
    if value == 0.0:
        return "0"
    if not 1e-3 <= abs(value) < 1e6:
        return f"{value:.{digits - 1}e}"
    text = f"{float(f'{value:.{digits}g}'):f}" if abs(value) < 10**digits else f"{value:.0f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def signed(number: str) -> str:
    """With a real minus sign, and without one before zero."""
    return number.replace("-", "−") if float(number) else number.lstrip("-")


def metres(value: float, digits: int | None = None) -> str:
    """A length as people write it: 0.42 m, 8.31 m, 251.4 m, 12.3 km; or with ``digits`` after the point."""
    if abs(value) >= 10_000:
        return signed(f"{value / 1000:.1f}") + " km"
    if digits is None:
        digits = 2 if abs(value) < 10 else 1
    return signed(f"{value:.{digits}f}") + " m"


def roughly(value: float) -> str:
    """A length of 0 or more, rounded for a sentence: 0.14 m, 2.9 m, 252 m."""
    return metres(value, 0 if value >= 9.95 else 1 if value >= 0.995 else 2)


def times(factor: float) -> str:
    """How many times as large: 1.4 times, 86 times."""
    return f"{factor:.{0 if factor >= 9.95 else 1}f} times"


def yards(value: float) -> str:
    """A length in m as people write it in yards."""
    return converted(value, "m", "yd")
