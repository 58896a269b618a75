"""Numbers as people read them: ``253.6 m``, ``38.1°``, ``2545 rpm``. JSON and CSV hold the numbers themselves."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache
from math import floor, log10
from typing import NamedTuple

from sandbox import units
from sandbox.errors import RequestError


class _Step(NamedTuple):
    """From ``least`` on, in the unit of its ladder, numbers are written in ``unit`` with so many ``digits`` after the
    point."""

    least: float
    unit: str
    digits: int


_Ladder = Sequence[_Step]

#: The steps by which numbers of a unit are written, the largest first; a unit that is not here has three figures.
DISPLAY_UNITS: dict[str, _Ladder] = {
    "m": (_Step(10_000, "km", 1), _Step(10, "m", 1), _Step(0.0995, "m", 2), _Step(0.0005, "cm", 1), _Step(0, "m", 2)),
    "m/s": (_Step(10, "m/s", 1), _Step(0, "m/s", 2)),
    "yd": (_Step(20, "yd", 0), _Step(0, "yd", 1)),
    **{unit: (_Step(0, unit, 0),) for unit in ("mph", "km/h", "rpm")},
    "ft": (_Step(100, "ft", 0), _Step(0, "ft", 1)),
    **{unit: (_Step(0, unit, 1),) for unit in ("deg", "arcmin", "J", "in", "cm")},
    "moa": (_Step(0, "arcmin", 1),),
    "s": (_Step(0, "s", 2),),
    "N": (_Step(9995, "kN", 1), _Step(9.995, "N", 1), _Step(0.0995, "N", 2), _Step(0, "mN", 0)),
}

#: The ladders that replace those, by kind of unit; they are in the kind's SI unit.
_SYSTEMS: dict[str, Mapping[str, _Ladder]] = {
    "si": {},
    "us": {
        "length": (
            *(_Step(160, "yd", 0), _Step(30, "ft", 0), _Step(0.3, "ft", 1)),
            *(_Step(0.001, "in", 1), _Step(0, "ft", 1)),
        ),
        "speed": (_Step(8.94, "mph", 0), _Step(0, "mph", 1)),
        "mass": (_Step(0.4536, "lb", 2), _Step(0, "oz", 2)),
        "force": (_Step(0, "lbf", 2),),
    },
}
_chosen: ContextVar[str] = ContextVar("units", default="si")


@cache
def _system_of(text: str) -> Mapping[str, _Ladder]:
    """The ladders by kind that ``us``, ``si``, or a list of units such as ``ft,mph`` asks for. Raises RequestError."""
    if text in _SYSTEMS:
        return _SYSTEMS[text]
    names = [units.suggestion(name.strip()) for name in text.split(",")]
    for name, given in zip(names, text.split(","), strict=True):
        if name not in units.KIND_OF or not name:
            raise RequestError(
                f'--units {text}: must be us, si or a list of units such as ft,mph, not "{given.strip()}"'
            )
    found = {units.KIND_OF[name]: DISPLAY_UNITS.get(name, (_Step(0, name, 2),)) for name in names}
    if len(found) < len(names):
        raise RequestError(f"--units {text}: two are of one kind; give one unit for each kind")
    return found


@contextmanager
def shown_in(text: str | None) -> Iterator[None]:
    """Inside, numbers for people are in these units; None changes nothing. What is stored is not affected."""
    if text is None:
        yield
        return
    _system_of(text)
    token = _chosen.set(text)
    try:
        yield
    finally:
        _chosen.reset(token)


def chosen_units() -> str:
    """The units that numbers are written in, as ``--units`` takes them."""
    return _chosen.get()


def _ladders() -> Mapping[str, _Ladder]:
    """The ladders by kind that were chosen."""
    return _system_of(_chosen.get())


def ladder(unit: str) -> _Ladder:
    """Return the steps by which numbers of a unit are written now; empty for one with three figures."""
    own = _ladders().get(units.KIND_OF.get(unit, ""))
    if own is None:
        return DISPLAY_UNITS.get(unit, ())
    first = next(iter(units.KINDS[units.KIND_OF[unit]])) if len(own) > 1 else unit
    return [_Step(units.convert(step.least, first, unit), *step[1:]) for step in own]


def written(value: float, unit: str, steps: _Ladder, digits: int | None = None) -> str:
    """A number of ``unit`` on a ladder; ``digits`` in place of the ladder's."""
    step = next((step for step in steps if abs(value) >= step.least), steps[-1])
    number = units.convert(value, unit, step.unit) if step.unit != unit else value
    text = signed(f"{number:.{step.digits if digits is None else digits}f}")
    return f"{text}°" if step.unit == "deg" else f"{text} {step.unit}"


def amount(value: float, unit: str = "", digits: int | None = None) -> str:
    """A number with its unit, in the units that were chosen; ``digits`` after the point where it is given."""
    if isinstance(value, int) and units.KIND_OF.get(unit) not in _ladders():
        return f"{value} {unit}".rstrip()
    steps = ladder(unit)
    return written(value, unit, steps, digits) if steps else f"{signed(f'{value:.3g}')} {unit}".rstrip()


def converted(value: float, unit: str, other: str) -> str:
    """A number of ``unit`` written in the unit ``other``, whatever was chosen."""
    return written(units.convert(value, unit, other), other, DISPLAY_UNITS.get(other, (_Step(0, other, 2),)))


def exact(value: float, unit: str) -> str:
    """A number with its unit and all its digits; six of them where it is converted to chosen units."""
    steps = ladder(unit) if units.KIND_OF.get(unit) in _ladders() else ()
    if not steps:
        return f"{signed(repr(value).removesuffix('.0'))} {unit}".rstrip()
    step = next((step for step in steps if abs(value) >= step.least), steps[-1])
    return f"{signed(f'{units.convert(value, unit, step.unit):.6g}')} {step.unit}"


def in_both(value: float, unit: str, other: str, digits: int | None = None) -> tuple[str, str]:
    """A number of ``unit`` as it is written, with ``digits`` after the point where they are given, and for those who
    count in ``other``: which comes first where another system of units was chosen."""
    second = converted(value, unit, other)
    own = _ladders().get(units.KIND_OF[unit])
    if own is None:
        return amount(value, unit, digits), second
    first = second if any(step.unit == other for step in own) else amount(value, unit)
    return first, written(value, unit, DISPLAY_UNITS[unit]) if unit in DISPLAY_UNITS else f"{value:.3g} {unit}"


def in_chosen_unit(size: float, unit: str) -> tuple[float, str]:
    """Return a size of 0 or more and its unit, in the units that were chosen; as it is if none were for its kind."""
    if units.KIND_OF.get(unit) not in _ladders():
        return size, unit
    steps = ladder(unit)
    smallest = min((step.unit for step in steps), key=lambda name: units.convert(1.0, name, unit))
    named = next((step.unit for step in steps[:-1] if size >= step.least), smallest)
    return units.convert(size, unit, named), named


def margin(error: float, unit: str, count: bool = False) -> str:
    """An estimated error: ``± 0.4 mm``; "" for a count that stays the same."""
    if count and error == int(error):
        return f"± {error:.0f}" if error else ""
    if units.KIND_OF.get(unit) in _ladders():
        error, unit = in_chosen_unit(error, unit)
    elif unit == "m" and error < 0.1:
        error, unit = error * 1e3, "mm"
    written = f"± {significant(error, 1)}" if error >= 1e-3 else "± less than 0.001"
    return f"{written}°" if unit == "deg" else f"{written} {unit}".rstrip()


def significant(value: float, digits: int = 2) -> str:
    """A number with this many significant digits, an integer from 100, with an exponent if very small or large."""
    if value == 0.0:
        return "0"
    if not 1e-3 <= abs(value) < 1e6:
        return f"{value:.{digits - 1}e}"
    text = f"{float(f'{value:.{digits}g}'):.{digits + 2}f}" if abs(value) < 10**digits else f"{value:.0f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def signed(number: str) -> str:
    """Return the number with a real minus sign, and without one before zero."""
    return number.replace("-", "−") if float(number) else number.lstrip("-")


def in_two_units(length: float, other: str) -> str:
    """Return a length in m for a picture, in two units: ``252.3 m   276 yd``."""
    return "   ".join(in_both(length, "m", other))


def scale_unit(length: float) -> tuple[str, float]:
    """The unit in which a scale of at least so many m is given, and that unit in m."""
    found = [(step.unit, units.convert(1.0, step.unit, "m")) for step in ladder("m") if step.unit != "km"]
    return next(((unit, metre) for unit, metre in found if 1.998 * length >= metre), min(found, key=lambda one: one[1]))


def metres(value: float, digits: int | None = None) -> str:
    """A length in m as people write it on a scale, without cm: 0.42 m, 8.31 m, 251.4 m, 12.3 km; or with ``digits``
    after the point. It is in the units that were chosen."""
    steps = [step for step in ladder("m") if step.unit != "cm" or _ladders()]
    return written(value, "m", steps, None if digits is not None and abs(value) >= steps[0].least else digits)


def roughly(value: float) -> str:
    """A length in m of 0 or more, rounded for a sentence: 0.14 m, 2.9 m, 252 m."""
    steps = [step for step in ladder("m") if step.unit != "cm" or _ladders()]
    step = next((step for step in steps if value >= step.least), steps[-1])
    number = units.convert(value, "m", step.unit)
    return written(value, "m", steps, 0 if number >= 9.95 and step.unit != "km" else 1 if number >= 0.995 else 2)


def times(factor: float) -> str:
    """Return a factor in words: 1.4 times, 86 times."""
    return f"{factor:.{0 if factor >= 9.95 else 1}f} times"


def round_number_above(value: float) -> float:
    """The smallest of 1, 2 and 5 times powers of ten that is at least this."""
    power = 10.0 ** floor(log10(value))
    return next(factor * power for factor in (1, 2, 5, 10) if factor * power >= value * 0.999)
