"""Numbers as people read them."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sandbox.sport.amounts import amount, converted, margin, metres, roughly, significant, times, yards


@given(st.floats(1e-9, 1e12), st.sampled_from([-1.0, 1.0]), st.integers(1, 5))
def test_significant_digits_are_those_of_the_number(size: float, sign: float, digits: int):
    """Half a unit of the last digit, which is never beyond the point of a number that needs no exponent."""
    value = sign * size
    shown = significant(value, digits)
    unit = 10.0 ** float(f"{size:.{digits - 1}e}".partition("e")[2]) * 10.0 ** (1 - digits)
    assert abs(float(shown) - value) <= 0.500001 * (min(unit, 1.0) if 1e-3 <= size < 1e6 else unit)
    assert len(shown) <= max(digits + 6, 8)


@pytest.mark.parametrize(
    ("value", "unit", "shown"),
    [
        (3, "", "3"),
        (7.47, "m/s", "7.47 m/s"),
        (74.7, "m/s", "74.7 m/s"),
        (12.34, "yd", "12.3 yd"),
        (123.4, "yd", "123 yd"),
        (-0.04, "deg", "0.0°"),
        (-38.14, "deg", "−38.1°"),
        (2545.4, "rpm", "2545 rpm"),
        (0.0004, "m", "0.00 m"),
        (0.0123, "m", "1.2 cm"),
        (0.0996, "m", "0.10 m"),
        (8.314, "m", "8.31 m"),
        (251.44, "m", "251.4 m"),
        (12345.0, "m", "12.3 km"),
        (0.123456, "kg", "0.123 kg"),
    ],
)
def test_amounts(value: float, unit: str, shown: str):
    assert amount(value, unit) == shown


def test_others():
    assert converted(10.0, "m/s", "km/h") == "36 km/h"
    assert [metres(0.004, 1), metres(-2.0)] == ["0.0 m", "−2.00 m"]
    assert [roughly(x) for x in (0.144, 0.99, 2.94, 9.94, 9.96, 252.4)] == [
        "0.14 m", "0.99 m", "2.9 m", "9.9 m", "10 m", "252 m",
    ]  # fmt: skip
    assert [times(x) for x in (1.44, 9.94, 9.96, 86.4)] == ["1.4 times", "9.9 times", "10 times", "86 times"]
    assert yards(91.44).startswith("100")


@pytest.mark.parametrize(
    ("error", "unit", "count", "shown"),
    [
        (0.0004, "m", False, "± 0.4 mm"),
        (0.1, "m", False, "± 0.1 m"),
        (1e-9, "m", False, "± less than 0.001 mm"),
        (0.02, "deg", False, "± 0.02°"),
        (25.0, "rpm", False, "± 25 rpm"),
        (0.0, "", True, ""),
        (2.0, "", True, "± 2"),
        (0.5, "", True, "± 0.5"),
    ],
)
def test_margins(error: float, unit: str, count: bool, shown: str):
    assert margin(error, unit, count) == shown
