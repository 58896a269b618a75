"""Numbers as people read them."""

from __future__ import annotations

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from sandbox.errors import RequestError
from sandbox.sport.amounts import (
    amount,
    converted,
    in_chosen_unit,
    in_two_units,
    margin,
    metres,
    roughly,
    scale_unit,
    shown_in,
    significant,
    times,
)
from sandbox.sport.facts import Fact


@given(st.floats(1e-9, 1e12), st.sampled_from([-1.0, 1.0]), st.integers(1, 5))
@example(0.0078125, -1.0, 5)
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
    assert in_two_units(91.44, "yd") == "91.4 m   100 yd"


def test_chosen_units():
    """Everything that is written for people follows, a scale included; what stands in a second unit swaps its place."""
    with shown_in("us"):
        lengths, speeds = (0.0123, 0.5, 8.3, 84.0, 252.3), (3.2, 76.4)
        assert [amount(x, "m") for x in lengths] == ["0.5 in", "1.6 ft", "27.2 ft", "276 ft", "276 yd"]
        assert [amount(x, "m/s") for x in speeds] == ["7.2 mph", "171 mph"]
        assert [amount(45.2, "deg"), amount(1234, "")] == ["45.2°", "1234"]
        assert [roughly(252.3), roughly(0.2), metres(2.0, 2)] == ["276 yd", "7.9 in", "6.56 ft"]
        assert in_two_units(129.0, "ft") == "423 ft   129.0 m"
        assert margin(0.0004, "m") == "± 0.02 in"
        assert in_chosen_unit(3.048, "m") == (pytest.approx(10.0), "ft")
        assert in_chosen_unit(2.0, "deg") == (2.0, "deg")
        assert scale_unit(0.4) == ("ft", 0.3048)
    with shown_in("ft, km/h"):
        assert [amount(252.3, "m"), amount(10.0, "m/s"), amount(1.0, "N")] == ["828 ft", "36 km/h", "1.00 N"]
    assert amount(8.3, "m") == "8.30 m"
    for wrong, told in (
        ("us,ft", 'must be us, si or a list of units such as ft,mph, not "us"'),
        ("ft,m", "two are of one kind; give one unit for each kind"),
    ):
        with pytest.raises(RequestError, match=f"--units {wrong}: {told}"), shown_in(wrong):
            pass


def test_a_fact_of_several_numbers_says_each_as_it_says_one():
    fact = Fact("heights", "heights", "m", lambda run, parameters: None)
    assert fact.text([1.806986702774693, 0.25, 4.9e-17]) == ", ".join(map(amount, (1.807, 0.25, 0.0), "mmm"))
    assert fact.text(("left", True)) == "left, yes"
    assert fact.text([]) == ""


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
