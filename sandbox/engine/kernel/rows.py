"""Setups as rows of numbers, which the kernel flies; or as none, where it has no code for a part of one.

Here it is decided which setups fly in the kernel: one ball with forces, winds and coefficients that have a code, among
surfaces at rest, by Dormand-Prince. A contact law or a condition for the end without a code is asked at each impact.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain
from typing import Any, NamedTuple

import numpy as np

from sandbox.engine.contact.touch import Outline
from sandbox.engine.kernel.laws import (
    BULLET,
    CALM,
    COEFFICIENTS,
    CONSTANT,
    COURT,
    DECAY,
    DRAG,
    EVEN,
    FORCE_COLUMNS,
    LIFT,
    NATHAN,
    NET,
    PLAIN,
    PROFILE,
    STEADY,
    TURF,
)
from sandbox.engine.kernel.leg import ASKED, FIRST_SURFACE, LIMIT_COLUMNS, SURFACE_COLUMNS
from sandbox.engine.kernel.step_control import StepControl
from sandbox.engine.model.accuracy import Accuracy
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.bounce_laws import CourtBounce, PennerTurf
from sandbox.engine.model.setup import Rule, Setup, Until
from sandbox.engine.model.surface import BounceLaw, Surface
from sandbox.physics.air import LogWind, UniformWind
from sandbox.physics.ballistics import BulletDrag
from sandbox.physics.coefficients import Constant, NathanDrag, OfWholeSpin, Scaled
from sandbox.physics.forces import Drag, Gravity, Magnus, SpinDecay, Wind
from sandbox.physics.net import NetDrag

#: A row with its numbers, or arrays of one for each shot.
Numbers = Sequence[Any]


class Tables(NamedTuple):
    """The rows of shots: the first axis has one entry for each, or a single one for all."""

    balls: np.ndarray  # shape (shots, 4)
    forces: np.ndarray  # (shots, terms, columns)
    surfaces: np.ndarray  # (shots, surfaces, columns)
    regions: np.ndarray  # (shots, regions, 5)
    rules: np.ndarray  # (shots, rules, columns)
    limits: np.ndarray  # (shots, columns)

    def of(self, shots: np.ndarray) -> Tables:
        """The rows of some shots."""
        return Tables(*(each[shots] if len(each) > 1 else each for each in self))


class _NoCode(Exception):
    """There is no code for a part of the setup."""


def tables(setup: Setup, accuracy: Accuracy, count: int) -> Tables | None:
    """The rows of so many shots, from their setups in one, with arrays for the numbers that differ; None if the kernel
    cannot fly them."""
    control, ball = StepControl(accuracy), setup.balls[0]
    plain = setup.is_single_ball and accuracy.method == "exact" and control.integrator.by_hand is not None
    if not plain or ball.loss is not None or ball.timing.depends or len(setup.discontinuities) > 0:
        return None
    try:
        forces = _forces(ball)
    except _NoCode:
        return None
    rules, until = rules_of(setup), setup.until
    line = until.line() if isinstance(until, Until) else None
    limits = control.local_error, control.exponent, accuracy.settle, accuracy.skin, setup.duration, *setup.bounds
    return Tables(
        _spread([(ball.mass, ball.radius, ball.inertia_factor, ball.inertia)], count, 4)[:, 0],
        _spread(forces, count, FORCE_COLUMNS),
        _spread([_surface(surface, ball.radius) for surface in setup.surfaces], count, SURFACE_COLUMNS),
        _spread(setup.force_regions, count, 5),
        _spread([_rule(rule, setup) for rule in rules or ()], count, FIRST_SURFACE + len(setup.surfaces)),
        _spread([(*limits, 1.0 if rules is None else 0.0, *chain(*line or ()))], count, LIMIT_COLUMNS)[:, 0],
    )


def rules_of(setup: Setup) -> Sequence[Rule] | None:
    """The rules by which the runs of a setup end; None if its condition is asked after each impact."""
    until = setup.until
    return () if until is None else until.rules() if isinstance(until, Until) else None


def _rule(rule: Rule, setup: Setup) -> Numbers:
    about = (float(rule.about(setup.balls[0].name, surface.name)) for surface in setup.surfaces)
    return rule.times, rule.fastest, rule.left, rule.right, rule.after, *about


def _spread(rows: Sequence[Numbers], count: int, columns: int) -> np.ndarray:
    """Rows as an array (shots, rows, columns), with zeros after their numbers."""
    differ = any(isinstance(value, np.ndarray) and value.ndim > 0 for row in rows for value in row)
    found = np.zeros((count if differ else 1, len(rows), columns))
    for place, row in enumerate(rows):
        for column, value in enumerate(row):
            found[:, place, column] = value
    return found


def _forces(ball: Ball) -> list[Numbers]:
    """The rows of a ball's forces and torques, those that are constant first, as in ``acceleration_function``."""
    steady = [force for force in ball.forces if type(force) is Gravity and force.is_constant]
    others = [force for force in ball.forces if not any(force is each for each in steady)]
    rows: list[Numbers] = [(STEADY, *force(0.0, (0.0, 0.0), (0.0, 0.0), 0.0)) for force in steady]
    return rows + [_force(term) for term in (*others, *ball.torques)]


def _force(term: Any) -> Numbers:
    kind: Any = type(term)
    if kind is Drag or kind is Magnus:
        half_density_area, law, reynolds_per_speed, radius = term.row
        of_ground = kind is Magnus and term.along_ground
        return (
            DRAG if kind is Drag else LIFT,
            *(half_density_area, 0.0, 0.0, 0.0, 0.0),
            *(reynolds_per_speed, radius),
            *_coefficient(law),
            *_wind(None if of_ground else term.wind),
        )
    if kind is SpinDecay:
        return DECAY, term.row, *[0.0] * 10, *_wind(term.wind)
    if kind is BulletDrag:
        return BULLET, *term.row, *[0.0] * 8, *_wind(term.wind)
    if kind is NetDrag:
        return NET, term.mass * term.damping, *term.middle, term.half_width, term.length
    raise _NoCode


def _coefficient(law: Any) -> Numbers:
    """Code, number, share and share of the whole spin."""
    value = share = of_spin = None
    while type(law) is not Constant:
        if type(law) is Scaled and share is None:
            law, share = law.coefficient, law.share
        elif type(law) is OfWholeSpin and of_spin is None:
            law, of_spin = law.coefficient, law.share
        else:
            break
    else:
        value = law.value if share is None else share * law.value
        return CONSTANT, value, 1.0, 1.0
    shares = 1.0 if share is None else share, 1.0 if of_spin is None else of_spin
    if type(law) is NathanDrag:
        return NATHAN, law.turns, *shares
    if law in COEFFICIENTS:
        return COEFFICIENTS.index(law), 0.0, *shares
    raise _NoCode


def _wind(wind: Wind | None) -> Numbers:
    if wind is None:
        return (CALM,)
    if type(wind) is UniformWind:
        return EVEN, wind.x, wind.y
    if type(wind) is LogWind:
        return PROFILE, *wind.row
    raise _NoCode


def _surface(surface: Surface, radius: Any) -> Numbers:
    outline = Outline.of(surface.shape, radius)
    return *outline, *outline.box(), surface.lowest_bounce, surface.kick, *_law(surface, surface.law)


def _law(surface: Surface, law: BounceLaw | None) -> Numbers:
    if law is None:
        return PLAIN, surface.restitution, surface.friction
    if type(law) is PennerTurf:
        return TURF, law.bounce, law.friction, law.give
    if type(law) is CourtBounce:
        return COURT, law.restitution, law.friction, law.slope, law.tangential
    return (ASKED,)
