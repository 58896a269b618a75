"""Everything a scene is made of, in one import: ``from sandbox.kit import Ball, Setup, quantity``.

The parts of its picture come from here, too: ``from sandbox.kit import SideView, Look``. Those names are listed in
``sandbox/picture/views.py`` and imported where they are used, since they need pygame, which ``scene.py`` does without.

Families of sports have modules of their own: ``sandbox.sport.net_game``, and ``sandbox.sport.sliding`` for stones, pins
and pucks; other laws are in ``sandbox.physics``.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from sandbox.engine.model.ball import DISC, HOLLOW_SPHERE, SOLID_SPHERE, Ball, Body, Force, Torque
from sandbox.engine.model.event import Event
from sandbox.engine.model.motion import Given, InTurn, Motion, Placing, Sliding, Swinging, Turning
from sandbox.engine.model.setup import Bounds, ContactModel, EndsBy, ForceRegion, Rule, Setup, Touches, Until
from sandbox.engine.model.shapes import Ellipse, Polygon, Vector, box, capsule, regular
from sandbox.engine.model.surface import Bounce, BounceLaw, Circle, ConstantBounce, Moving, Segment, Surface, Trap
from sandbox.engine.paths.run import Run
from sandbox.errors import RequestError
from sandbox.parameters import (
    Group,
    SceneParameters,
    choice,
    group,
    groups,
    one_of,
    quantity,
    switch,
    text,
    vector,
    vectors,
)
from sandbox.physics.air import Gusts, LogWind, UniformWind
from sandbox.physics.cloth import Cloth
from sandbox.physics.coefficients import (
    GOLF_DRAG,
    GOLF_LIFT,
    SOCCER_DRAG,
    SOCCER_LIFT,
    TENNIS_DRAG,
    TENNIS_LIFT,
    Coefficient,
    Constant,
    Laws,
    spin_ratio_lift,
)
from sandbox.physics.elementwise import anywhere, clip, cos, exp, log, maximum, minimum, sin, smooth, where
from sandbox.physics.forces import Drag, Gravity, Inside, Magnus, SpinDecay
from sandbox.physics.ice import CurlingIce, Glide
from sandbox.physics.integrators import State
from sandbox.physics.plane import Strips
from sandbox.physics.slope import Slope
from sandbox.scene.scene_run import SceneRun
from sandbox.sport.air import Air, AirByDensity, ConstantDrag, NoForce, OutdoorAir, Weather, wind_in
from sandbox.sport.amounts import amount, in_two_units, metres, roughly, round_number_above, signed
from sandbox.sport.controls import Controls, Goal, Handle, Held, Spin, Spread
from sandbox.sport.facts import ENDED, Fact, cached_per_run
from sandbox.sport.flight import DEGREE, RPM, Directed, Flight, Launch, Release, Sphere, forces_in_flight, height_on
from sandbox.sport.readings import (
    APEX,
    BALL_SPEED,
    DISTANCE,
    FLIGHT_TIME,
    LANDING_ANGLE,
    LAUNCH,
    LAUNCH_ANGLE,
    LAUNCH_SPIN,
    Moment,
    Passes,
    apex,
    before,
    down_to,
    fact_from,
    first_contact_with,
    first_time,
    first_touch,
    of_each,
    passing,
    passing_at,
    travelled,
)
from sandbox.sport.solids import Extent, Solid, below, check_apart, disc, level, rectangle

if TYPE_CHECKING:
    from sandbox.picture.views import *  # noqa: F403
else:

    def __getattr__(name: str) -> Any:
        """Return a part of a picture, by name."""
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(import_module("sandbox.picture.views"), name)


__all__ = [
    "APEX",
    "BALL_SPEED",
    "DEGREE",
    "DISC",
    "DISTANCE",
    "ENDED",
    "FLIGHT_TIME",
    "GOLF_DRAG",
    "GOLF_LIFT",
    "HOLLOW_SPHERE",
    "LANDING_ANGLE",
    "LAUNCH",
    "LAUNCH_ANGLE",
    "LAUNCH_SPIN",
    "RPM",
    "SOCCER_DRAG",
    "SOCCER_LIFT",
    "SOLID_SPHERE",
    "TENNIS_DRAG",
    "TENNIS_LIFT",
    "Air",
    "AirByDensity",
    "Ball",
    "Body",
    "Bounce",
    "BounceLaw",
    "Bounds",
    "Circle",
    "Cloth",
    "Coefficient",
    "Constant",
    "ConstantBounce",
    "ConstantDrag",
    "ContactModel",
    "Controls",
    "CurlingIce",
    "Directed",
    "Drag",
    "Ellipse",
    "EndsBy",
    "Event",
    "Extent",
    "Fact",
    "Flight",
    "Force",
    "ForceRegion",
    "Given",
    "Glide",
    "Goal",
    "Gravity",
    "Group",
    "Gusts",
    "Handle",
    "Held",
    "InTurn",
    "Inside",
    "Launch",
    "Laws",
    "LogWind",
    "Magnus",
    "Moment",
    "Motion",
    "Moving",
    "NoForce",
    "OutdoorAir",
    "Passes",
    "Placing",
    "Polygon",
    "Release",
    "RequestError",
    "Rule",
    "Run",
    "SceneParameters",
    "SceneRun",
    "Segment",
    "Setup",
    "Sliding",
    "Slope",
    "Solid",
    "Sphere",
    "Spin",
    "SpinDecay",
    "Spread",
    "State",
    "Strips",
    "Surface",
    "Swinging",
    "Torque",
    "Touches",
    "Trap",
    "Turning",
    "UniformWind",
    "Until",
    "Vector",
    "Weather",
    "amount",
    "anywhere",
    "apex",
    "before",
    "below",
    "box",
    "cached_per_run",
    "capsule",
    "check_apart",
    "choice",
    "clip",
    "cos",
    "disc",
    "down_to",
    "exp",
    "fact_from",
    "first_contact_with",
    "first_time",
    "first_touch",
    "forces_in_flight",
    "group",
    "groups",
    "height_on",
    "in_two_units",
    "level",
    "log",
    "maximum",
    "metres",
    "minimum",
    "of_each",
    "one_of",
    "passing",
    "passing_at",
    "quantity",
    "rectangle",
    "regular",
    "roughly",
    "round_number_above",
    "signed",
    "sin",
    "smooth",
    "spin_ratio_lift",
    "switch",
    "text",
    "travelled",
    "vector",
    "vectors",
    "where",
    "wind_in",
]
