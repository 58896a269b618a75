"""The bench: balls with their velocities before and after the blow, and bars of momentum and energy that add up."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property, partial
from itertools import product

import numpy as np

from sandbox.engine.setup import Segment
from sandbox.picture.above import AboveView
from sandbox.picture.ball import Look, Mark, near
from sandbox.picture.camera import Camera
from sandbox.picture.painter import Painter, from_colours
from sandbox.picture.palette import Colour, palette, scene_colours
from sandbox.picture.sheet import Sheet, nice
from sandbox.sport.amounts import signed

from .scene import Parameters, blow, energy, hangs, momentum

CARD, COLOURS = palette("card"), scene_colours(__file__)
SPOTS = near(np.array(list(product((-1.0, 1.0), repeat=3))) / 3**0.5, 0.25)  # so that one sees them turn
LOOKS = [Look(colour, Mark(COLOURS["spot"], SPOTS), gloss=0.7) for colour in COLOURS["balls"]]
SUMS = partial(momentum, axis=0), partial(momentum, axis=1), energy
BARS, LONGEST = 0.27, 90.0  # share of the width that bars take; px on 720 rows of the longest arrow


class Picture(AboveView[Parameters]):
    LEAST_IMPACT = np.inf  # marks would hide the arrows
    STRING = COLOURS["string"]

    @property
    def _area(self) -> tuple[tuple[float, float], tuple[float, float]]:
        (left, top), (right, bottom) = super()._area
        return (left, top), (right - BARS * self.size[0], bottom)

    def look_of(self, name: str) -> Look:
        return LOOKS[min(self.balls.index(name), 2 + (self.balls.index(name) - 2) % (len(LOOKS) - 2))]

    def colour_of(self, name: str) -> Colour:
        return self.look_of(name).colour

    def backdrop(self, painter: Painter, camera: Camera) -> None:
        """A dark board with a grid of round lengths, floor or bowl, and the strings' beam."""
        top, foot = (np.array(colour, float) for colour in COLOURS["board"])
        painter.surface.blit(
            from_colours(np.broadcast_to(np.linspace(top, foot, self.size[1]), (*self.size, 3))), (0, 0)
        )
        width, height = self.size
        step = nice(60 * self.unit / camera.scale)
        (left, high), (right, low) = camera.world(0, 0), camera.world(width, height)
        for x in np.arange(np.floor(left / step), right / step) * step:
            painter.line([camera.pixel(x, low), camera.pixel(x, high)], 1.0, COLOURS["grid"])
        for y in np.arange(np.floor(low / step), high / step) * step:
            painter.line([camera.pixel(left, y), camera.pixel(right, y)], 1.0, COLOURS["grid"])
        shapes = (surface.shape for surface in self.run.setup.surfaces)
        for shape in (shape for shape in shapes if isinstance(shape, Segment)):
            ends = [(min(max(x, left - 1), right + 1), y) for x, y in (shape.a, shape.b)]
            painter.line([camera.pixel(*end) for end in ends], 4 * self.unit, COLOURS["floor"])

    @cached_property
    def seen(self) -> np.ndarray:
        """With the ends of the strings."""
        return np.vstack(
            [
                self.surroundings,
                *([(hangs(self.parameters)[0], self.parameters.strings)] * bool(self.parameters.strings)),
            ]
        )

    @property
    def strings(self) -> Sequence[tuple[str, tuple[float, float]]]:
        """Of a cradle."""
        up = self.parameters.strings
        return [(name, (x, up)) for name, x in zip(self.balls, hangs(self.parameters), strict=True)] if up else ()

    @property
    def moment(self) -> float:
        return self.told

    def annotate(self, sheet: Sheet, camera: Camera) -> None:
        """The line of action, and the velocities that the blow changes, before (pale) and after it."""
        met = blow(self.run, self.parameters)
        if met is None:
            return
        painter, unit = sheet.painter, self.unit
        a, b = (np.array(met.before[name][:2]) for name in met.pair)
        line = [camera.pixel(*(at + way * (b - a))) for at, way in ((a, -1.2), (b, 1.2))]
        painter.dashes(line, 1.6 * unit, CARD["accent"], 7 * unit, 5 * unit)
        speeds = {name: [np.array(states[name][2:4]) for states in (met.before, met.after)] for name in self.balls}
        fastest = max(np.hypot(*velocity) for both in speeds.values() for velocity in both)
        for name, (before, after) in speeds.items():
            if np.hypot(*(after - before)) < 0.01 * fastest:
                continue
            at = camera.pixel(*met.before[name][:2])
            painter.ring(at, self.radii[name] * camera.scale, 1.5 * unit, self.colour_of(name))
            for velocity, colour, width in ((before, COLOURS["before"], 3.0), (after, CARD["text"], 4.0)):
                along, up = velocity / fastest * LONGEST * unit
                if np.hypot(along, up) > 6 * unit:
                    painter.arrow(at, (at[0] + along, at[1] - up), width * unit, colour)

    def scale(self, sheet: Sheet, camera: Camera) -> None:
        """The scale bar, and the sums that have to stay."""
        super().scale(sheet, camera)
        met, run, top = blow(self.run, self.parameters), self.run, sheet.top_row + 1.2 * sheet.lettering.height("small")
        if met is None:
            return
        along, up, joule = ([what(run, states) for states in (met.before, met.after)] for what in SUMS)
        joule[1] += [max(0.0, sum(joule[0]) - sum(joule[1]))]
        least = 0.02 * max(map(abs, [*along[0], *along[1], *up[0], *up[1]]))
        for title, unit, sums in (
            ("momentum x", "kg m/s", along),
            ("momentum y", "kg m/s", up),
            ("energy", "J", joule),
        ):
            if max(map(abs, [*sums[0], *sums[1]])) > least:
                top = self._bars(sheet, top, f"{title}: {signed(format(round(sum(sums[0]), 9), '.3g'))} {unit}", sums)

    def _bars(self, sheet: Sheet, top: float, title: str, sums: Sequence[Sequence[float]]) -> float:
        """Two bars of shares in the balls' colours, negative ones to the left, with a tick at their sum; what is lost
        comes last. Returns the row below."""
        unit, right, room, thick = (
            self.unit,
            sheet.frame.right,
            (BARS - 0.06) * self.size[0],
            0.75 * sheet.lettering.height("small"),
        )
        most = max(sum(max(part, 0.0) for part in parts) for parts in sums)
        least = min(sum(min(part, 0.0) for part in parts) for parts in sums)
        scale, left = room / (most - least), right - room
        zero = left - least * scale
        sheet.write(title, "small", (right, top), CARD["quiet"], "bottomright")
        for parts, word in zip(sums, ("before", "after"), strict=True):
            top += 0.3 * thick
            ends = [zero, zero]
            for part, colour in zip(parts, [*map(self.colour_of, self.balls), COLOURS["lost"]], strict=False):
                start = ends[part > 0.0]
                ends[part > 0.0] = end = start + part * scale
                corners = [(start, top), (end, top), (end, top + thick), (start, top + thick)]
                sheet.painter.polygon(corners, colour)
            total = zero + sum(parts) * scale
            sheet.painter.line([(total, top - 3 * unit), (total, top + thick + 3 * unit)], 2 * unit, CARD["accent"])
            sheet.write(word, "small", (left - 8 * unit, top + thick / 2), CARD["quiet"], "midright")
            top += thick
        return top + 2.4 * thick
