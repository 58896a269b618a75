"""Arrows at a ball: how fast it goes and what acts on it, by cause."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from math import hypot

import numpy as np

from sandbox.engine.motion.forces_on_ball import by_cause
from sandbox.engine.paths.phase import Phase
from sandbox.engine.paths.run import Run
from sandbox.picture.palette import Colour, palette
from sandbox.picture.sheet import CARD, Entry, Sheet
from sandbox.sport.amounts import amount

_FORCE = palette("force")

#: Length of the longest arrow of a run, px on 720 rows: of a force, of the velocity; and the shortest that is drawn.
FORCE_LENGTH, VELOCITY_LENGTH, SHORTEST = 64.0, 100.0, 5.0
#: Widths of the arrows, px on 720 rows.
_FORCE_WIDTH, _VELOCITY_WIDTH = 4.2, 3.4
#: The longest arrows are found at so many times.
_SAMPLES = 60
#: A ball slower than this, in m/s, is at rest.
_AT_REST = 1e-9


def colour_of(name: str) -> Colour:
    """The colour of the arrows for a cause; causes of a user's own share out what is left."""
    own = _FORCE["own"]
    return _FORCE[name] if name in _FORCE and name != "own" else own[sum(name.encode()) % len(own)]


class Vectors:
    """The velocity of one ball and the forces on it, at any time of a run."""

    def __init__(self, run: Run, name: str):
        self.run, self.name = run, name
        self.ball = next(ball for ball in run.setup.balls if ball.name == name)
        self.arcs = run.arcs[name]

    def forces(self, t: float) -> dict[str, tuple[float, float]]:
        """The forces on the ball at time t (s) by cause, in N; "contact" or the plane's name is what it lies on."""
        found: dict[str, tuple[float, float]] = {}
        angle = (self.run.angle(self.name, t),) if self.ball.rotates else ()
        for name, (fx, fy) in by_cause(self.ball.forces, t, (*self.run.state(self.name, t), *angle)):
            before = found.get(name, (0.0, 0.0))
            found[name] = before[0] + float(fx), before[1] + float(fy)
        arc = self.arcs.at(t)
        plane = self.run.setup.plane and self.run.setup.plane_of(self.name)
        surface = plane.name if plane is not None else "contact" if arc.phase is not Phase.FREE else None
        if surface is not None:
            others = [sum(axis) for axis in zip((0.0, 0.0), *found.values(), strict=True)]
            moves = hypot(*self.run.state(self.name, t)[2:4]) >= _AT_REST
            ax, ay = arc.acceleration(t) if moves else (0.0, 0.0)
            mass = self.ball.mass * float(self.ball.mass_fraction(t))
            found[surface] = mass * ax - others[0], mass * ay - others[1]
        return found

    def over(self, times: Sequence[float] | np.ndarray) -> dict[str, np.ndarray]:
        """The components of each force in N at times in s, shape (n, 2); NaN where it does not act."""
        found = [self.forces(float(t)) for t in times]
        names = dict.fromkeys(name for forces in found for name in forces)
        return {name: np.array([forces.get(name, (np.nan, np.nan)) for forces in found]) for name in names}

    @cached_property
    def longest(self) -> tuple[float, float]:
        """The largest speed in m/s and the largest force in N of the run; those of surfaces set no scale."""
        times = np.linspace(0.0, self.run.duration, _SAMPLES)
        forces = [np.zeros((1, 2)), *(force for name, force in self.over(times).items() if name != "contact")]
        speeds = self.run.states(self.name, times)[:, 2:4]
        return float(np.hypot(*speeds.T).max()), float(np.nanmax([np.nanmax(np.hypot(*force.T)) for force in forces]))

    def draw(self, sheet: Sheet, at: tuple[float, float], radius: float, t: float) -> None:
        """The arrows at time t, from the edge of a ball of ``radius`` px; what is too short to see is left out."""
        unit = sheet.unit
        speed, force = self.longest

        def arrow(vector: tuple[float, float], longest: float, length: float, width: float, colour: Colour) -> None:
            size = hypot(*vector)
            shown = min(1.5, size / longest if longest > 0 else 0.0) * length * unit
            if shown >= SHORTEST * unit:
                width = min(width, shown / unit / 4.2)
                along, down = vector[0] / size, -vector[1] / size
                tail = at[0] + along * radius, at[1] + down * radius
                tip = tail[0] + along * shown, tail[1] + down * shown
                sheet.painter.arrow(tail, tip, width * unit, colour, rim=(CARD["shadow"], max(0.7, unit)))

        arrow(self.run.state(self.name, t)[2:4], speed, VELOCITY_LENGTH, _VELOCITY_WIDTH, CARD["text"])
        for name, vector in self.forces(t).items():
            arrow(vector, force, FORCE_LENGTH, _FORCE_WIDTH, colour_of(name))

    def entries(self, t: float) -> list[Entry]:
        """For the card: each force in N, in the colour of its arrow."""
        return [(name, amount(hypot(*vector), "N"), colour_of(name)) for name, vector in self.forces(t).items()]
