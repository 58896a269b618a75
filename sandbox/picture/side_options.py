"""Scene options of a picture from the side: what a scene may change in it, besides what it may in any picture."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, NamedTuple

import numpy as np

from sandbox.picture.camera import Box
from sandbox.picture.options import P, SceneOptions
from sandbox.picture.palette import Colour
from sandbox.picture.places import Ground, Hall, Scenery, Thing
from sandbox.picture.sheet import CARD
from sandbox.sport.sideways import GroundPlace


class Length(NamedTuple):
    """A distance along the ground, from ``start`` to ``end`` in m, and what is written on it."""

    text: str
    start: float
    end: float
    colour: Colour = CARD["text"]


@dataclass(frozen=True)
class Place:
    """A place: what lies behind, the ground, and the things on it, the farthest first."""

    scenery: Scenery = Hall()
    ground: Ground = Ground()
    things: Sequence[Thing] = ()


class SideOptions(SceneOptions[P]):
    """Everything that a scene may override in a picture from the side, with defaults."""

    SHARED_GROUND = True

    #: The unit of the ruler's lower row; the upper has metres.
    SECOND_UNIT: ClassVar[str] = "yd"
    #: Rows between ground and ruler for the distances that ``lengths`` returns.
    LENGTH_ROWS: ClassVar[int] = 2
    #: Free room between header and path, in px on 720 rows.
    HEADROOM: ClassVar[float] = 24
    #: A low flight is drawn at most so many times as high as it is; inf draws any as high as there is room.
    MAX_STRETCH: ClassVar[float] = 1.0
    #: The poster leaves out the ``preferred_view`` if the path would take up less than this share of its width.
    MIN_PATH_SHARE: ClassVar[float] = 0.15
    #: The origin of the distance in a frame's headline: 12.3 m "from the hand".
    MEASURED_FROM: ClassVar[str] = "from the start"
    #: The eye of the perspective: its height over the ground in px on 720 rows, its column as a share of the width.
    EYE_HEIGHT: ClassVar[float] = 150
    EYE_COLUMN: ClassVar[float] = 0.25
    #: How much of a closer look in frames is because the eye comes nearer, and not because it sees things larger.
    GOES_IN: ClassVar[float] = 0.5

    @property
    def must_be_visible(self) -> Box | None:
        """The part of the world that is visible in any case besides the path, in m, such as the player."""
        return None

    @property
    def preferred_view(self) -> Box | None:
        """The part of the world, in m, that is visible unless the path would then be too small."""
        return None

    def ground(self, x: np.ndarray) -> np.ndarray:
        """Height of the ground in m, at places in m."""
        return np.zeros_like(x)

    def profile(self, left: float, right: float) -> np.ndarray:
        """The ground's line from one place to another, in m."""
        return np.array([(x, self._under(x)) for x in (left, right)])

    @cached_property
    def place(self) -> Place:
        """The place that the ball flies through; without one a view draws its own backdrop."""
        raise NotImplementedError

    @property
    def standing(self) -> Sequence[Thing]:
        """The things that stand on the ground."""
        return self.place.things

    @property
    def track(self) -> Sequence[GroundPlace]:
        """The track over the ground of a ball that leaves the plane: shown from above on the poster."""
        return ()

    def lengths(self) -> Sequence[Length]:
        """Distances to be drawn along the ground; the first is drawn lowest."""
        return ()

    def closeup_boxes(self) -> Sequence[Box]:
        """The parts of the world, in m, where the run is decided: enlarged on the poster where there is free sky."""
        return ()

    def _under(self, x: float) -> float:
        return float(self.ground(np.array([x]))[0])
