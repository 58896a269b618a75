"""Causes of scatter: parameters that a player does not hit exactly, and the points at which shots are computed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import ceil, inf, log2
from typing import Any

import numpy as np

from sandbox import parameters as declared
from sandbox import units
from sandbox.errors import RequestError
from sandbox.lab.axes import Normal, Span, checked, span, unit_of
from sandbox.lab.scatter import players_spread
from sandbox.parameters import value_at
from sandbox.scene import Scene
from sandbox.sport.amounts import significant
from sandbox.toml import toml_value

#: The ways in which points are drawn.
SAMPLINGS = ("sobol", "random")


@dataclass(frozen=True)
class Cause:
    """One parameter that scatters: normally around the scene's own value, or evenly over a range."""

    axis: Normal | Span
    unit: str
    given: str = ""  # as a share of the value, such as 1%

    @property
    def key(self) -> str:
        return self.axis.key

    @property
    def sd(self) -> float:
        """Standard deviation, in the parameter's unit."""
        return self.axis.sd if isinstance(self.axis, Normal) else (self.axis.high - self.axis.low) / 12.0**0.5

    def values(self, shares: np.ndarray) -> np.ndarray:
        """The values with these shares of the distribution below them."""
        if isinstance(self.axis, Normal):
            return np.array([self.axis.value(share) for share in shares.tolist()])
        return np.asarray(self.axis.low + shares * (self.axis.high - self.axis.low))

    def as_text(self) -> str:
        """``launch.speed 7.391 ± 0.074 m/s (1%)``."""
        axis, given = self.axis, f" ({self.given})" if self.given else ""
        if isinstance(axis, Span):
            return f"{axis.key} from {axis.low:g} to {axis.high:g} {self.unit}".rstrip()
        return f"{axis.key} {significant(axis.mean, 4)} ± {significant(axis.sd)} {self.unit}".rstrip() + given


def cause(scene: Scene, option: str, key: str, given: Any) -> Cause:
    """A cause from a standard deviation: a number in the parameter's unit, ``"1 deg"``, ``"1%"`` of the scene's own
    value, or evenly over ``"-3:3"``. Raises RequestError."""
    text = given.strip() if isinstance(given, str) else given
    key = next((item.key for item in scene.controls.spread if item.sd and item.sd == key), key)  # it is a deviation
    if key not in {it.key for it in declared.walk(scene.parameters, entries=True)}:
        checked(scene, option, key, 0.0)  # raises if there is no such key, and says what is wrong with it
    value = value_at(scene.parameters, key)
    unit = unit_of(scene, key)
    if not isinstance(value, int | float) or isinstance(value, bool):
        raise RequestError(f"{option} {key}: is {_named(value)}; only a number scatters")
    value = float(value)
    if isinstance(text, str) and ":" in text:
        ends = [checked(scene, option, key, toml_value(part.strip())) for part in text.split(":")]
        if len(ends) != 2:
            raise RequestError(f"{option} {key}={text}: a range is LOW:HIGH")
        return Cause(span(option, key, *ends), unit)
    sd, share = _standard_deviation(option, key, text, value, unit)
    if not 0.0 < sd < inf:
        raise RequestError(f"{option} {key}={text}: the standard deviation must be more than 0, and finite")
    return Cause(Normal(key, value, sd, _bounds(scene, key)), unit, share)


def _named(value: Any) -> str:
    return "not set" if value is None else "a group of parameters" if isinstance(value, declared.Group) else repr(value)


def _standard_deviation(option: str, key: str, text: Any, value: float, unit: str) -> tuple[float, str]:
    """The standard deviation in the parameter's unit, and the share of the value that it was given as."""
    if isinstance(text, str) and text.endswith("%") and unit != "%":
        try:
            share = float(text[:-1])
        except ValueError:
            raise RequestError(f"{option} {key}={text}: write a share of its value as 1%") from None
        if value == 0.0:
            raise RequestError(
                f"{option} {key}={text}: the scene's own value is 0; give the standard deviation as a number"
                + (f" in {unit}" if unit else "")
            )
        return abs(value) * share / 100.0, f"{share:g}%"
    if isinstance(text, bool) or not isinstance(text, int | float | str):
        raise RequestError(
            f"{option} {key} = {text!r}: must be a standard deviation, such as 0.5, or '1%' of its value"
        )
    try:
        return units.parse(text, unit) if isinstance(text, str) else float(text), ""
    except ValueError as error:
        raise RequestError(f'{option} {key}: the standard deviation "{text}" {error}') from None


def _bounds(scene: Scene, key: str) -> tuple[float, float]:
    known = next((it for it in declared.walk(scene.parameters) if it.key == key.partition("[")[0]), None)
    return (-inf, inf) if known is None else known.bounds


def parse_cause(scene: Scene, option: str, text: str) -> Cause:
    """``KEY=SD``. Raises RequestError."""
    key, equals, body = (part.strip() for part in text.partition("="))
    if not key or not equals or not body:
        raise RequestError(f"{option} {text}: write it as KEY=SD, for example {option} launch.speed=1%")
    return cause(scene, option, key, body)


def causes_of(scene: Scene, given: Sequence[Cause], option: str) -> list[Cause]:
    """The causes to compute with: those that are given, with what the picture does not show, or by default the scene's
    own, as the window's fan has them. Raises RequestError if there is none, or one twice."""
    keys = [each.key for each in given]
    twice = next((key for key in keys if keys.count(key) > 1), None)
    if twice is not None:
        raise RequestError(f"{option} {twice}: given twice")
    own = players_spread(scene)
    if given:
        always = {item.key for item in scene.controls.spread if item.sd} - set(keys)
        own = {key: each for key, each in own.items() if key in always}
    elif not own:
        why = (
            "this shot does not start from the player's controls" if scene.controls.set_on_pull else "nothing scatters"
        )
        raise RequestError(f"{why}: give {option} KEY=SD, for example {option} launch.speed=1%")
    return [
        *given,
        *(
            Cause(Normal(key, parameter.value, sd, _bounds(scene, key)), parameter.unit or "")
            for key, (parameter, sd) in own.items()
        ),
    ]


# ---------------------------------------------------------------------------------------------------------------------
# Points
# ---------------------------------------------------------------------------------------------------------------------


def shares_of(samples: int, columns: int, seed: int, sampling: str) -> np.ndarray:
    """So many points in the unit cube, shape (samples, columns): of Sobol's sequence, scrambled by the seed (Owen), or
    at random."""
    if sampling == "random":
        return np.random.default_rng(seed).random((samples, columns))
    from scipy.stats import qmc

    drawn = qmc.Sobol(columns, scramble=True, seed=np.random.default_rng(seed)).random_base2(ceil(log2(samples)))
    return np.asarray(drawn[:samples])


@dataclass(frozen=True)
class Points:
    """The points of all shots: those that scatter, and those with which causes are told apart.

    By the scheme of Saltelli (2010, Comput. Phys. Commun. 181:259): matrices A and B of independent shots, and for each
    cause the shots of A with that cause from B.
    """

    values: Mapping[str, np.ndarray]  # of each cause, shape (points,)
    samples: int  # the first ones, which scatter: A
    pairs: int  # shots of B, and of each cause after it; a power of 2, or 0

    def rows(self, matrix: int) -> slice:
        """Return the places of the shots of B (0), or of those of A with the first, second... cause from B."""
        start = self.samples + matrix * self.pairs
        return slice(start, start + self.pairs)


def points_of(causes: Sequence[Cause], samples: int, seed: int, sampling: str, apart: bool) -> Points:
    """The points for these causes; with those by which causes are told ``apart``, unless there is only one."""
    count = len(causes)
    pairs = 1 << (samples.bit_length() - 1) if apart and count > 1 else 0  # the largest power of 2 that is not above
    shares = shares_of(samples, 2 * count, seed, sampling)
    columns = {}
    for place, each in enumerate(causes):
        a = each.values(shares[:, place])
        parts = [a]
        if pairs:
            b = each.values(shares[:pairs, count + place])
            parts += [b, *(b if other == place else a[:pairs] for other in range(count))]
        columns[each.key] = np.concatenate(parts)
    return Points(columns, samples, pairs)
