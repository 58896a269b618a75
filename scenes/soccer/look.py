"""How ball and pitch look, from the side and from above: colours, and how wide stripes and lines are."""

from __future__ import annotations

from sandbox.picture.palette import scene_colours
from sandbox.picture.views import Look, patches

COLOURS = scene_colours(__file__)
BALL, TRACE, EARLIER = COLOURS["ball"], COLOURS["trace"], COLOURS["earlier"]
LOOK = Look(BALL["colour"], patches(BALL["patch"]))
STRIPE, LINE = 5.5, 0.12  # m: as wide as the goal area is deep; the most that the Laws of the Game allow
