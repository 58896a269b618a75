"""Hockey from above: the ice with its lines, or a table; who stands there, and where the puck goes."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from sandbox.picture.palette import Colour, scene_colours
from sandbox.picture.places import plan
from sandbox.picture.views import AboveView, Camera, Look, Mark, Painter, near

from .rink import air_table, ice_rink
from .scene import Parameters, decided

COLOURS = scene_colours(__file__)
MARK = Mark(COLOURS["shine"], near(np.array([(0.0, 0.7, 0.7)]), 0.25))
LOOKS = {name: Look(COLOURS[name], MARK, gloss=0.6) for name in ("puck", "air_puck", "mallet")}


class Picture(AboveView[Parameters]):
    EARLIER, THING, CAVEAT = COLOURS["earlier"], "puck", "not validated"

    @property
    def table(self) -> bool:
        return self.parameters.rink.goal_line == 0.0

    @property
    def balls(self) -> list[str]:
        """With the mallets of a table; players are drawn as people."""
        return [ball.name for ball in self.run.setup.balls if self.table or ball.name == "puck"]

    @cached_property
    def told(self) -> float:
        return min(self.run.duration, decided(self.run, self.parameters)[0] + 0.5)

    @cached_property
    def seen(self) -> np.ndarray:
        rink = self.parameters.rink
        return 0.51 * np.array([(-rink.length, -rink.width), (rink.length, rink.width)])

    @cached_property
    def plan(self) -> plan.Plan:
        return air_table(self.parameters.rink) if self.table else ice_rink(self.parameters.rink)

    def look_of(self, name: str) -> Look:
        return LOOKS["mallet" if name != "puck" else "air_puck" if self.table else "puck"]

    def colour_of(self, name: str) -> Colour:
        return COLOURS["mallet" if name != "puck" else "air_trace" if self.table else "trace"]

    def behind(self, painter: Painter, camera: Camera, t: float) -> None:
        """Whoever is on the ice, at time t in s, in the circle that the puck cannot enter."""
        for who in [] if self.table else self.run.setup.balls[1:]:
            shirt, place = COLOURS["shirts"][who.name.partition(" ")[0]], self.run.state(who.name, t)[:2]
            kit = plan.Kit(**COLOURS["kit"], shirt=shirt)
            painter.disc(camera.pixel(*place), who.radius * camera.scale, shirt, 0.35)
            plan.Person(place, 180.0, kit).draw(painter, camera)
