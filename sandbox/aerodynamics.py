"""What every scene with air has in common: the air, the simple models of drag and lift, and the forces they make."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

from sandbox.engine.setup import Force
from sandbox.parameters import Group, choice, quantity, vector
from sandbox.physics.air import LogWind, UniformWind
from sandbox.physics.coefficients import Coefficient, Constant, Scaled, spin_ratio_lift
from sandbox.physics.forces import Drag, Magnus, Wind


class Air(Group):
    """Still air, or an even wind."""

    density: float = quantity(1.204, "kg/m^3", 0, 1100, "density")
    wind: tuple[float, float] = vector((0.0, 0.0), "m/s", -100, 100, "along x and y; negative x is a headwind")


class OutdoorAir(Air):
    """The air over level ground, and how it moves."""

    profile: Literal["uniform", "log"] = choice("uniform", "even wind, or one that grows with height over the ground")
    reference_height: float = quantity(10.0, "m", 0.1, 100, "height at which a log profile has the wind given")
    roughness: float = quantity(0.03, "m", 0.0001, 2, "roughness length of a log profile")


def wind_in(air: Air) -> Wind | None:
    """The wind as a velocity field, or None for still air."""
    if air.wind == (0.0, 0.0):
        return None
    if isinstance(air, OutdoorAir) and air.profile == "log":
        return LogWind(air.wind, air.reference_height, air.roughness)
    return UniformWind(*air.wind)


class ConstantDrag(Group):
    """One drag coefficient for all speeds."""

    model: Literal["constant"] = choice("constant", "drag coefficient by its source")
    coefficient: float = quantity(0.47, "", 0, 10, "drag coefficient")


class NoDrag(Group):
    """No drag."""

    model: Literal["none"] = choice("none", "drag coefficient by its source")


class ConstantLift(Group):
    """One lift coefficient for all spins."""

    model: Literal["constant"] = choice("constant", "lift coefficient by its source")
    coefficient: float = quantity(0.2, "", 0, 10, "lift coefficient")
    velocity: Literal["air", "ground"] = choice("air", "velocity that lift is reckoned by: relative to air or ground")


class SpinRatioLift(Group):
    """A lift coefficient equal to the spin ratio r w / v."""

    model: Literal["spin-ratio"] = choice("spin-ratio", "lift coefficient by its source")
    velocity: Literal["air", "ground"] = choice("air", "velocity that lift is reckoned by: relative to air or ground")


class NoLift(Group):
    """No lift."""

    model: Literal["none"] = choice("none", "lift coefficient by its source")


def aerodynamic_forces(
    air: Air,
    radius: float,
    drag: Any,
    lift: Any,
    models: Mapping[str, Coefficient] | None = None,
    lift_share: float = 1.0,
) -> list[Force]:
    """Drag and Magnus lift on a ball of ``radius`` (m), each only where there is one.

    ``drag`` and ``lift`` are groups with a ``model``: one of the above, or a scene's own, named in ``models``.
    Of the lift only ``lift_share`` lies in the scene's plane, less than 1 where the spin's axis leans.
    """
    if air.density == 0.0:
        return []
    wind = wind_in(air)
    forces: list[Force] = []
    drag_coefficient = _coefficient(drag, models or {})
    if drag_coefficient is not None:
        forces.append(Drag(radius, air.density, drag_coefficient, wind))
    lift_coefficient = _coefficient(lift, models or {})
    if lift_coefficient is not None:
        if lift_share != 1.0:
            lift_coefficient = Scaled(lift_coefficient, lift_share)
        along_ground = lift.velocity == "ground"
        forces.append(Magnus(radius, air.density, lift_coefficient, wind, along_ground=along_ground))
    return forces


def _coefficient(chosen: Any, models: Mapping[str, Coefficient]) -> Coefficient | None:
    if isinstance(chosen, NoDrag | NoLift):
        return None
    if isinstance(chosen, ConstantDrag | ConstantLift):
        return Constant(chosen.coefficient)
    if isinstance(chosen, SpinRatioLift):
        return spin_ratio_lift
    return models[chosen.model]
