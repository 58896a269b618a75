"""The air, and models of the drag and lift that it exerts on a ball."""

from __future__ import annotations

from collections.abc import Mapping
from types import new_class
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self

from sandbox.parameters import Group, choice, quantity, vector
from sandbox.physics.air import Gusts, LogWind, UniformWind, moist_density
from sandbox.physics.coefficients import ANY_LIFT, Coefficient, Constant
from sandbox.physics.elementwise import anywhere
from sandbox.physics.forces import Wind

if TYPE_CHECKING:
    from sandbox.sport.flight import Sphere


class AirByDensity(Group):
    """Still air, or a uniform wind: enough for drag that does not depend on the Reynolds number."""

    density: float = quantity(..., "kg/m^3", 0, 1100, "density")
    wind: tuple[float, float] = vector(..., "m/s", -100, 100, "along x and y; negative x is a headwind")

    @property
    def air(self) -> Self:
        """The air with its density."""
        return self


class Air(AirByDensity):
    """Still air, or a uniform wind."""

    viscosity: float = quantity(..., "Pa s", 1e-7, 10, "dynamic viscosity, for the Reynolds number")


class OutdoorAir(Air):
    """The air over level ground, and how it moves."""

    profile: Literal["uniform", "log"] = choice(..., "uniform wind, or one that grows with height above the ground")
    reference_height: float = quantity(..., "m", 0.1, 100, "height at which a log profile has the given wind")
    roughness: float = quantity(..., "m", 0.0001, 2, "roughness length of a log profile")
    gusts: float = quantity(0.0, "m/s", 0, 30, "standard deviation of gusts along the wind, by Dryden's spectra")
    gust_seed: int = quantity(0, "", 0, 1e9, "other gusts for each whole number")
    temperature: float | None = quantity(None, "C", -60, 60, "in place of the density, that of dry air so warm")
    elevation: float | None = quantity(None, "m", -500, 9000, "in place of the density, that of air so high at 20 C")

    @property
    def air(self) -> Self:
        """The air; by temperature and elevation, one of which may be 20 C or the sea, at 1013.25 hPa without vapour."""
        if self.temperature is None and self.elevation is None:
            return self
        kelvin = 293.15 if self.temperature is None else self.temperature + 273.15
        density = moist_density(kelvin, 101325.0, 0.0, 0.0 if self.elevation is None else self.elevation)
        return self.model_copy(update={"density": density, "temperature": None, "elevation": None})


class Weather(AirByDensity):
    """The air, by its weather unless its density is given."""

    density: float | None = quantity(  # type: ignore[assignment]
        None, "kg/m^3", 0, 1100, "density, if it does not follow from the weather"
    )
    temperature: float = quantity(..., "C", -60, 60, "temperature")
    pressure: float = quantity(..., "hPa", 500, 1100, "pressure reduced to sea level, as in weather reports")
    humidity: float = quantity(..., "", 0, 1, "relative humidity")
    elevation: float = quantity(..., "m", -500, 9000, "above the sea")

    @property
    def air(self) -> Self:
        if self.density is not None:
            return self
        density = moist_density(self.temperature + 273.15, 100.0 * self.pressure, self.humidity, self.elevation)
        return self.model_copy(update={"density": density})


def wind_in(air: AirByDensity) -> Wind | None:
    """The wind as a velocity field, or None for still air."""
    outdoors = air if isinstance(air, OutdoorAir) else None
    gusty = outdoors is not None and anywhere(outdoors.gusts > 0.0)
    if not gusty and not any(anywhere(part != 0.0) for part in air.wind):
        return None
    mean: UniformWind | LogWind = UniformWind(*air.wind)
    if outdoors is not None and outdoors.profile == "log":
        mean = LogWind(air.wind, outdoors.reference_height, outdoors.roughness)
    if outdoors is None or not gusty:
        return mean
    return Gusts(mean, outdoors.gusts, outdoors.reference_height, int(outdoors.gust_seed))


class Model(Group):
    """One model of drag or lift, chosen by the key ``model``: one of the ``LAWS`` of a sport's ball, by name."""

    LAWS: ClassVar[Mapping[str, Coefficient]] = {}
    model: str = choice(..., "coefficient by its source")

    @classmethod
    def __pydantic_init_subclass__(cls, **options: Any) -> None:
        """The names of the laws are the words that ``model`` may be."""
        super().__pydantic_init_subclass__(**options)
        if cls.LAWS:
            words: Any = Literal[tuple(cls.LAWS)]
            cls.model_fields["model"].annotation = words

    def coefficient_in(self, air: Air, ball: Sphere) -> Coefficient | None:
        """The coefficient by Reynolds number and spin ratio, of a ball by its mass, radius and other parameters; None
        for no force."""
        return self.LAWS[self.model]


class Lift(Model):
    """A model of lift, or of any force across the flow."""

    velocity: Literal["air", "ground"] = choice("air", "velocity that lift is computed from: relative to air or ground")


class ConstantDrag(Model):
    """One drag coefficient for all speeds."""

    model: Literal["constant"] = choice("constant", "coefficient by its source")
    coefficient: float = quantity(0.47, "", 0, 10, "drag coefficient")

    def coefficient_in(self, air: Air, ball: Sphere) -> Coefficient:
        return Constant(self.coefficient)


class ConstantLift(Lift):
    """One lift coefficient for all spins."""

    model: Literal["constant"] = choice("constant", "coefficient by its source")
    coefficient: float = quantity(0.2, "", 0, 10, "lift coefficient")

    def coefficient_in(self, air: Air, ball: Sphere) -> Coefficient:
        return Constant(self.coefficient)


class SpinRatioLift(Lift):
    """A lift coefficient equal to the spin ratio r w / v."""

    LAWS = ANY_LIFT
    model: str = choice("spin-ratio", "coefficient by its source")


class NoForce(Model):
    """No drag, or no lift."""

    model: Literal["none"] = choice("none", "coefficient by its source")

    def coefficient_in(self, air: Air, ball: Sphere) -> None:
        return None


#: The models that every ball may have, besides those of its sport.
AnyDrag = ConstantDrag | NoForce
AnyLift = ConstantLift | SpinRatioLift | NoForce


def model_of(name: str, laws: Mapping[str, Coefficient], base: type[Model]) -> type[Model]:
    """The group of that name for a sport's own models, by the words of its ``laws``."""
    return new_class(name, (base,), exec_body=lambda body: body.update(LAWS=laws, __module__=__name__))
