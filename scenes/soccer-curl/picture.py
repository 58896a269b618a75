"""Soccer from above: how far the kick bends from its straight line, round the wall and past the keeper."""

from __future__ import annotations

from functools import cached_property
from math import cos, dist, hypot, pi, radians, sin, tan

import numpy as np

from sandbox.kit import (
    AboveView,
    Box,
    Camera,
    Entry,
    Painter,
    Sheet,
    Story,
    first_touch,
    metres,
    mix,
    palette,
    plan,
    scene_colours,
)
from sandbox.kit import (
    goal as goal_at,
)
from sandbox.picture.lettering import around
from sandbox.picture.places.courts import PENALTY_SPOT, pitch_lines
from sandbox.sport.dive import place_of

from ..soccer.picture import LINE, STRIPE
from ..soccer.picture import Picture as FromTheSide
from .scene import BOARDS_ASIDE, BOARDS_BEHIND, BOARDS_BEYOND, SIDES, Parameters

CARD, COLOURS = palette("card"), scene_colours(__file__)
WALL, KICKER, KEEPER = (plan.Kit(shirt=shirt, **COLOURS["person"]) for shirt in COLOURS["shirts"])

#: Boards are so thick and so long, in m; behind them there is nothing to see, however far the camera looks.
BOARD, BOARD_LENGTH, FAR = 0.4, 6.0, 1000.0
#: Height of the goal, how far behind the ball the kicker stands, and room for him and beside each post, in m.
HEIGHT, BEHIND, ROOM, ASIDE = 2.44, 0.75, 1.3, 0.4
#: Way in m after which a keeper who dives lies stretched out.
LEANS = 0.3
#: A ball so near to the keeper, in m, is his; else the goal decides.
IN_REACH = 2.5
#: The poster follows a ball that was stopped for so long, in s.
AFTERMATH = 0.6
#: And one that has passed the goal line for so long, in s.
BEYOND = 0.2


class Picture(AboveView[Parameters]):
    """One kick, seen by a camera that stays near the ball."""

    LOOK, TRACE, OTHER_TRACES = FromTheSide.LOOK, FromTheSide.TRACE, FromTheSide.OTHER_TRACES
    FAINT_TRACE = mix(TRACE, COLOURS["grass"][0], 0.3)
    TRAIL, MIN_STROBE_SHARE, DUSK, STANDS_UPRIGHT = 0.4, 0.6, COLOURS["dusk"], True

    @property
    def balls(self) -> list[str]:
        return ["ball"]

    @cached_property
    def story_end(self) -> float:
        """A ball that passes the goal is followed little farther."""
        end, passed = self.run.duration, self.run.result["flight_time"]
        if self.run.result["goal"]:
            return end
        touched = first_touch(self.run)
        ends = [touched.t + AFTERMATH] if touched else []
        return min([end, *ends, *([passed + BEYOND] if passed is not None else [])])

    @property
    def moment(self) -> float:
        """The time in s at which the ball is at the goal line or touched."""
        t = self.run.result["flight_time"]
        return self.run.duration if t is None else t

    @property
    def datum(self) -> tuple[tuple[float, float], str]:
        return (self.parameters.goal.distance, self.parameters.goal.offset), "the goal"

    # The place

    def draw_driven(self, painter: Painter, camera: Camera, t: float, opacity: float = 1.0) -> None:
        """Nothing moves but the keeper, who is drawn as a person."""

    def keeper_at(self, t: float) -> tuple[float, float]:
        """Return the place of the keeper at time t in s, in m."""
        dives = place_of(self.run.setup.surfaces, "keeper", t)
        if dives is not None:
            return dives
        x, y, *_ = self.run.state("keeper", t)
        return x, y

    @cached_property
    def plan(self) -> plan.Plan:
        """Grass between boards, lines, goal, wall and kicker."""
        goal, wall = self.parameters.goal, self.parameters.wall
        left, end, right, middle = BOARDS_BEHIND, goal.distance, goal.distance + BOARDS_BEYOND, goal.offset
        grass = Box(left, -BOARDS_ASIDE, right, BOARDS_ASIDE)
        boards = grass._replace(left=left - BOARD, right=left), grass._replace(left=right, right=right + BOARD)
        everywhere = Box(-FAR, -FAR, FAR, FAR)
        sides = {"right": left}, {"left": right}, {"top": -BOARDS_ASIDE}, {"bottom": BOARDS_ASIDE}
        count = max(1, round(wall.width / plan.BREADTH)) if wall.present else 0
        players = [wall.offset + (i - (count - 1) / 2) * wall.width / count for i in range(count)]
        aside, mouth = goal.width / 2 + goal.post_radius, (end, goal.depth, HEIGHT, goal.width, goal.post_radius)
        return (
            plan.Stripes(grass, COLOURS["grass"], STRIPE, end),
            *(plan.Line(tuple(points), LINE, COLOURS["line"]) for points in pitch_lines(end, middle)),
            plan.Spot((end - PENALTY_SPOT, middle), LINE, COLOURS["line"]),
            *(plan.Ground(everywhere._replace(**edge), COLOURS["beyond"]) for edge in sides),
            *(plan.Stripes(box, COLOURS["boards"], BOARD_LENGTH, -BOARDS_ASIDE, along=True) for box in boards),
            plan.Worn((end - 0.3, middle), 1.2, 0.42 * goal.width, COLOURS["worn"], 0.4),
            *goal_at(*mouth, **COLOURS["goal"], side=middle - aside, opacity=0.4),
            *(plan.Person((wall.distance, y), 180.0, WALL, wall.width / count) for y in players),
            plan.Person((0.0, 0.0), self.parameters.launch.angle, KICKER, behind=BEHIND),
        )

    @property
    def aims(self) -> list[Box]:
        goal = self.parameters.goal
        aside = goal.width / 2 + goal.post_radius
        return [Box(goal.distance, goal.offset - aside, goal.distance + goal.depth, goal.offset + aside)]

    @property
    def story(self) -> Story:
        """Keeper, wall or goal, as the ball meets them."""
        touched, keeper, at = first_touch(self.run), self.parameters.keeper, self.moment
        if touched is not None and (self.run.result["flight_time"] is None or touched.t < at):
            return self.meeting(share=0.3, spot=2.0, at=touched.t)
        x, y = stands = self.keeper_at(at) if keeper.present else (0.0, 0.0)
        if not keeper.present or dist(stands, self.run.state("ball", at)[:2]) > IN_REACH:
            return self.meeting(*self.aims, share=0.6, spot=4.0, at=at)
        reach = keeper.radius
        return Story(Box(x - reach, y - reach, x + reach, y + reach), at, 0.22)

    @cached_property
    def must_show(self) -> np.ndarray:
        """The paths, the kicker, the goal, and where the straight line meets the goal line."""
        goal = self.parameters.goal
        half, back = goal.width / 2 + ASIDE, goal.distance + goal.depth
        corners = [(-ROOM, 0.0), (back, goal.offset - half), (back, goal.offset + half)]
        return np.concatenate([self.points, corners, [self.straight] if self.straight else np.empty((0, 2))])

    def behind(self, painter: Painter, camera: Camera, t: float) -> None:
        """Draw where the ball would have gone without spin, and the keeper."""
        straight = [camera.pixel(0.0, 0.0), camera.pixel(*self._without_spin(t))]
        if dist(*straight) > 20 * self.unit:
            faint = mix(COLOURS["straight"], COLOURS["grass"][0], 0.4)
            painter.dashed_thread(straight, 1.4 * self.unit, faint, 7 * self.unit, 6 * self.unit)
        keeper = self.parameters.keeper
        if not keeper.present:
            return
        stands = self.keeper_at(t)
        start, at = (camera.pixel(*place) for place in (self.parameters.stand, stands))
        colour, reach, thin = KEEPER.shirt, keeper.radius * camera.scale, max(1.0, 1.2 * self.unit)
        if dist(start, at) > 4 * self.unit:
            painter.dashes([start, at], thin, colour, 4 * self.unit, 5 * self.unit, 0.6)
            painter.ring(start, reach, thin, colour, 0.5)
        painter.disc(at, reach, colour, 0.25)
        painter.ring(at, reach, thin, colour, 0.7)
        broad = min(plan.BREADTH, 1.25 * keeper.radius)
        far = stands[1] - self.parameters.stand[1]
        if keeper.dive.dives and abs(far) > LEANS:
            plan.Person(stands, 90.0 if far > 0.0 else -90.0, KEEPER, broad, stretched=True).draw(painter, camera)
        else:
            plan.Person(stands, 180.0, KEEPER, broad, arms=keeper.radius).draw(painter, camera)

    # How far it bends

    @cached_property
    def straight(self) -> tuple[float, float] | None:
        """The point in m where the launch's straight line meets the goal line; None if the ball does not come there."""
        angle, line = self.parameters.launch.angle, self.parameters.goal.distance
        if abs(angle) >= 89.0 or self.run.result["deviation"] is None:
            return None
        return line, line * tan(radians(angle))

    def _without_spin(self, t: float) -> tuple[float, float]:
        """Along the straight line as far as the ball is at time t in s; on the goal line once it is there."""
        if self.straight is not None and t >= self.moment:
            return self.straight
        far, angle = hypot(*self.run.state("ball", t)[:2]), radians(self.parameters.launch.angle)
        return far * cos(angle), far * sin(angle)

    def annotate(self, sheet: Sheet, camera: Camera) -> None:
        """Mark how far from its straight line the ball comes to the goal line."""
        unit, accent, keeper = self.unit, CARD["accent"], self.parameters.keeper
        if keeper.present:
            at = camera.pixel(*self.keeper_at(self.moment))
            sheet.labels.take_path([at], keeper.radius * camera.scale)
        line = np.linspace(camera.pixel(0.0, 0.0), camera.pixel(*self._without_spin(self.moment)), 80)
        sheet.labels.take_path(line, 2 * unit)
        if self.straight is None:
            return
        deviation = self.run.result["deviation"]
        (x, start), (_, end) = line[-1], camera.pixel(self.straight[0], self.straight[1] + deviation)
        if abs(end - start) > 12 * unit:
            sheet.painter.arrow((x, start), (x, end), 2.6 * unit, accent)
        sheet.painter.line([(x - 6 * unit, start), (x + 6 * unit, start)], 2.0 * unit, accent)
        sheet.labels.take_path([(x, row) for row in np.linspace(start, end, 30)], 3 * unit)
        way = 1.0 if end < start else -1.0
        turns = [-way * turn for turn in (pi / 2, 1.0, 2.1, 0.0, pi)]
        spots = around((x, start), [far * unit for far in (12, 20, 32)], turns)
        sheet.chip(f"{metres(abs(deviation))} to the {SIDES[deviation >= 0.0]}", spots, accent)
        anchor = "midtop" if way > 0 else "midbottom"
        beside = [(*(line[i] + (0, way * far * unit)), anchor) for i in (49, 40, 59, 30) for far in (10, 16, 24)]
        sheet.label("without spin", "small", beside, sheet.ink)

    # Frames

    def progress(self, t: float) -> tuple[str, str]:
        away = self.parameters.goal.distance - self.run.state("ball", t)[0]
        return metres(abs(away)), "to the goal line" if away >= 0 else "behind the goal line"

    def position(self, t: float) -> list[Entry]:
        """The ball's distance from its straight line."""
        (x, y, *_), angle = self.run.state("ball", t), radians(self.parameters.launch.angle)
        aside = float(y * cos(angle) - x * sin(angle))
        return [("off the straight", f"{metres(abs(aside))} {SIDES[aside >= 0.0]}" if abs(aside) >= 0.005 else "–")]

    def heading_text(self, angle: float) -> str:
        return f"{abs(angle):.0f}° {SIDES[angle >= 0.0]}"
