"""Units that a scene file may use: a small table, and the conversion between two units of one kind."""

from __future__ import annotations

import math
import re

# A value in SI is (value + offset) * factor. The first unit of each kind is the SI one, with factor 1 and offset 0.
KINDS: dict[str, dict[str, tuple[float, float]]] = {
    "length": {
        "m": (1.0, 0.0),
        "cm": (1e-2, 0.0),
        "mm": (1e-3, 0.0),
        "km": (1e3, 0.0),
        "yd": (0.9144, 0.0),
        "ft": (0.3048, 0.0),
        "in": (0.0254, 0.0),
    },
    "area": {"m^2": (1.0, 0.0), "cm^2": (1e-4, 0.0), "mm^2": (1e-6, 0.0)},
    "speed": {
        "m/s": (1.0, 0.0),
        "km/h": (1 / 3.6, 0.0),
        "mph": (0.44704, 0.0),
        "kn": (1852 / 3600, 0.0),
        "ft/s": (0.3048, 0.0),
    },
    "angle": {
        "rad": (1.0, 0.0),
        "deg": (math.pi / 180, 0.0),
        "moa": (math.pi / 10800, 0.0),
        "arcmin": (math.pi / 10800, 0.0),
    },
    "spin": {
        "rad/s": (1.0, 0.0),
        "rpm": (math.pi / 30, 0.0),
        "rev/s": (2 * math.pi, 0.0),
        "deg/s": (math.pi / 180, 0.0),
    },
    "mass": {"kg": (1.0, 0.0), "g": (1e-3, 0.0), "oz": (0.028349523125, 0.0), "lb": (0.45359237, 0.0)},
    "time": {"s": (1.0, 0.0), "ms": (1e-3, 0.0), "min": (60.0, 0.0)},
    "rate": {"1/s": (1.0, 0.0), "1/min": (1 / 60, 0.0)},
    "density": {"kg/m^3": (1.0, 0.0), "g/cm^3": (1e3, 0.0)},
    "acceleration": {"m/s^2": (1.0, 0.0), "ft/s^2": (0.3048, 0.0), "g0": (9.80665, 0.0)},
    "pressure": {"Pa": (1.0, 0.0), "hPa": (1e2, 0.0), "kPa": (1e3, 0.0)},
    "temperature": {"K": (1.0, 0.0), "C": (1.0, 273.15), "F": (5 / 9, 459.67)},
    "viscosity": {"Pa s": (1.0, 0.0)},
    "inertia": {"kg m^2": (1.0, 0.0)},
    "force": {"N": (1.0, 0.0), "mN": (1e-3, 0.0), "kN": (1e3, 0.0), "lbf": (4.4482216152605, 0.0)},
    "impulse": {"N s": (1.0, 0.0)},
    "torque": {"N m": (1.0, 0.0)},
    "energy": {"J": (1.0, 0.0), "kJ": (1e3, 0.0)},
    "momentum": {"kg m/s": (1.0, 0.0)},
    "power": {"W": (1.0, 0.0), "kW": (1e3, 0.0)},
    "stiffness": {"N/m": (1.0, 0.0), "N/mm": (1e3, 0.0)},
    "contact stiffness": {"N/m^1.5": (1.0, 0.0)},
    "damping": {"N s/m": (1.0, 0.0)},
    "curvature": {"1/m": (1.0, 0.0), "1/cm": (1e2, 0.0)},
    "ratio": {"": (1.0, 0.0), "%": (1e-2, 0.0)},
}

KIND_OF = {unit: kind for kind, units in KINDS.items() for unit in units}

#: A number as files have it, for regular expressions of Python and of JSON schemas.
NUMBER = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
#: A number with a decimal comma, or with commas between thousands.
_COMMAS = re.compile(r"\s*([+-]?[0-9][0-9.]*,[0-9][0-9,.]*)")
_QUANTITY = re.compile(rf"\s*({NUMBER}|[+-]?(?:nan|inf))\s*(.*?)\s*")
_SPELLINGS = str.maketrans({"²": "^2", "³": "^3", "°": "", "·": " "})


#: Other spellings of units, in lower case and singular.
_OTHER_SPELLINGS = {
    "m": "meter metre mtr",
    "cm": "centimeter centimetre",
    "mm": "millimeter millimetre",
    "km": "kilometer kilometre",
    "yd": "yard",
    "ft": "foot feet",
    "in": "inch inche",
    "m/s": "mps m/sec ms-1",
    "km/h": "kph kmh km/hr kmph",
    "mph": "mi/h mile/h miles/h mile miles mi mile/hour",
    "kn": "kt knot",
    "ft/s": "fp ft/sec",
    "deg": "degree",
    "rad": "radian",
    "rev/s": "rp rev rev/sec",
    "kg": "kilogram kilo",
    "g": "gram gr",
    "oz": "ounce",
    "lb": "pound lbm",
    "s": "sec second",
    "min": "minute",
    "C": "celsiu degc",
    "F": "fahrenheit degf",
    "K": "kelvin",
    "N": "newton",
}


def alternatives(unit: str) -> list[str]:
    """The units of the same kind as ``unit``, itself first."""
    return [unit, *(other for other in KINDS[KIND_OF[unit]] if other != unit)]


def has_offsets(unit: str) -> bool:
    """True if units of this kind do not have their zeros in common, as those of temperature."""
    return any(offset for _, offset in KINDS[KIND_OF[unit]].values())


def listed(unit: str) -> str:
    """The units of the same kind as ``unit``, for a message: ``"m/s, km/h, mph, kn or ft/s"``."""
    names = [other or "no unit" for other in alternatives(unit)]
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} or {names[-1]}"


def suggestion(given: str) -> str:
    """The unit meant by ``given``, which may be another spelling of it; "" if none is known."""
    if given in KIND_OF:
        return given
    lowered = given.lower().rstrip(".")
    spellings = {unit.lower(): unit for unit in KIND_OF} | {
        other: unit for unit, others in _OTHER_SPELLINGS.items() for other in others.split()
    }
    return spellings.get(lowered) or spellings.get(lowered.removesuffix("s"), "")


def comma_error(text: str) -> str:
    """The problem with a number that has commas, such as ``"60,5 m/s"``, and how to write it; "" if none has."""
    match = _COMMAS.match(text)
    if match is None:
        return ""
    number, rest = match[1], text[match.end() :].strip()
    without = number.replace(",", "")
    if "." in number.rpartition(",")[2] or number.count(",") > 1:  # 1,234.5
        return f"has commas; write {f'{without} {rest}'.strip()}"
    with_point = number.replace(".", "").replace(",", ".")  # 1.234,5
    thousands = re.fullmatch(r"[+-]?[1-9][0-9]{0,2},[0-9]{3}", number)
    written = " or ".join(f"{each} {rest}".strip() for each in ([with_point, without] if thousands else [with_point]))
    return f"has a decimal comma; write {written}"


def parse(text: str, unit: str) -> float:
    """The number in ``text`` expressed in ``unit``; a text without a unit is in ``unit``.

    Raises ValueError if the text is not a number with a unit of the same kind.
    """
    match = _QUANTITY.fullmatch(text)
    if comma := comma_error(text):
        raise ValueError(comma)
    if match is None:
        raise ValueError(f"is not a number with a unit; use {listed(unit)}")
    number = float(match[1])
    given = match[2] if "°" not in match[2] else match[2].translate(_SPELLINGS) or "deg"
    return convert(number, given.translate(_SPELLINGS) or unit, unit)


def convert(number: float, given: str, unit: str) -> float:
    """``number`` of unit ``given`` expressed in ``unit``.

    Raises ValueError if the two are not units of the same kind.
    """
    if given == unit:
        return number
    units = KINDS[KIND_OF[unit]]
    if given not in units:
        if given in KIND_OF:
            raise ValueError(f"{given} is a unit of {KIND_OF[given]}; use {listed(unit)}")
        meant = suggestion(given)
        if meant in units:
            raise ValueError(f"{given} is not a known unit; did you mean {meant}?")
        raise ValueError(f"{given} is not a known unit; use {listed(unit)}")
    factor, offset = units[given]
    target_factor, target_offset = units[unit]
    # 14 digits: "140 F" is exactly 60 C, not out of bounds by a rounding error.
    return float(f"{(number + offset) * factor / target_factor - target_offset:.14g}")
