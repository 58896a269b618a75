"""Pictures from the side: the plane of play with its ground, and what lies behind it in central perspective."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from math import ceil, floor, isinf, log10

import numpy as np
import pygame

from sandbox.picture.ball import mark_radius
from sandbox.picture.camera import Area, Box, Camera, Eye
from sandbox.picture.closeup import CloseUp, arranged
from sandbox.picture.lettering import LabelPlace, Labels
from sandbox.picture.marks import draw_mark, draw_trace, label_mark, mark_impacts
from sandbox.picture.painter import Painter, Point, around_corners
from sandbox.picture.path import ImpactMark
from sandbox.picture.places import Person
from sandbox.picture.sheet import CARD, Entry, Sheet, SideRows
from sandbox.picture.side_options import SideOptions
from sandbox.picture.story import Story
from sandbox.picture.track import draw_track
from sandbox.picture.view import P, View
from sandbox.sport.amounts import metres, roughly

#: The picture shows at least so many radii of the ball along the ground.
_LEAST_WIDTH = 60
#: A flight that rises at least so much, in px on 720 rows, and at most over this share of the room is drawn
#: higher, where the ball is drawn at least so many times its size.
_LEAST_RISE, _LOW_FLIGHT, _LARGE_BALL = 24, 0.45, 3
#: Labels keep off so many points along the sides of a thing, and from there to its middle.
_ALONG, _ACROSS = 9, 4
#: A shadow is half as dark where the ball is so high over the ground, in px on 720 rows.
_SHADOW_FADES = 80


class SideView(SideOptions[P], View[P]):
    """A run seen from the side: x along the ground, y up. What a scene may change is in ``side_options.py``."""

    @property
    def sky(self) -> float:
        """The row down to which nothing is drawn, in px."""
        tops = [self.points[:, 1].max() + self.radius, self.subject.top]
        return self.camera.pixel(0.0, float(max(tops)))[1] - 20 * self.unit

    @cached_property
    def rows_at(self) -> SideRows:
        """The rows of ground, lengths and ruler, in px from the top."""
        return self.sheet.side_rows(len(self.ghosts), self.LENGTH_ROWS)

    def base(self, rows: SideRows, scale: float) -> int:
        """The row of the ground, in px, of a picture with ``scale`` px/m."""
        return rows.base

    @property
    def area(self) -> Area:
        """The part of the poster for the path, in px."""
        side, rows, subject = 0.085 * self.size[0], self.rows_at, self.subject
        base = self.base(rows, (self.size[0] - 2 * side) / (subject.right - subject.left))
        return Area(side, rows.top + self.HEADROOM * self.unit, self.size[0] - side, base)

    @cached_property
    def subject(self) -> Box:
        """The part of the world that the poster shows, in m."""
        (left, bottom), (right, top) = self.points.min(axis=0), self.points.max(axis=0)
        seen = _joined(Box(left, bottom, right, top + self.radius), self.must_be_visible)
        wide = _joined(seen, self.preferred_view)
        if max(seen.right - seen.left, seen.top) >= self.MIN_PATH_SHARE * (wide.right - wide.left):
            seen = wide
        short = max(0.0, _LEAST_WIDTH * self.radius - (seen.right - seen.left)) / 2
        seen = seen._replace(left=seen.left - short, right=seen.right + short)
        heights = self.ground(np.linspace(seen.left, seen.right, 500))
        return seen._replace(bottom=float(heights.min()), top=max(seen.top, float(heights.max())))

    @cached_property
    def camera(self) -> Camera:
        return self.fitted(self.area)

    def fitted(self, area: Area) -> Camera:
        """Shows the whole path and what belongs to it; a low flight higher than it is, where the scene allows it."""
        camera = Camera.fit(self.subject, area)
        rise, room = (self.subject.top - self.subject.bottom) * camera.scale, area.bottom - area.top
        low = _LEAST_RISE * self.unit < rise < _LOW_FLIGHT * room
        stretch = 1.0
        if low and self.min_radius > _LARGE_BALL * self.radius * camera.scale:
            stretch = min(self.MAX_STRETCH, max(1.0, floor(room / rise)))
        if isinf(self.MAX_STRETCH):  # in steps of half a power of ten
            most = max(1.0, room / rise)
            step = 0.5 * 10.0 ** floor(log10(most))
            stretch = step * floor(most / step)
        return Camera.fit(self.subject, area, stretch)

    def eye(self, camera: Camera) -> Eye:
        """Sees the place in central perspective, the plane of play as the camera shows it."""
        level = camera.anchor[1] - self.EYE_HEIGHT * self.unit
        return Eye(camera, self.EYE_COLUMN * self.size[0], level, self.size[0] / camera.scale, self.unit)

    def seen_from(self, camera: Camera) -> Eye:
        """Sees what the camera shows: a close-up of the poster from where the whole is seen, and what frames go in to
        also from nearer by, or the sky would be lost."""
        eye, closer = self.eye(self.camera), camera.scale / self.camera.scale
        if camera == self.camera:
            return eye
        if self.GOES_IN == 0.0 or any(camera == near.camera for near in self.closeups):
            centre, level = camera.pixel(*self.camera.world(eye.centre, eye.level))
            return replace(eye, camera=camera, centre=centre, level=level)
        up = (eye.base - eye.level) * closer ** (1.0 - self.GOES_IN)
        return replace(eye, camera=camera, level=camera.anchor[1] - up, distance=eye.distance / closer**self.GOES_IN)

    def backdrop(self, painter: Painter, camera: Camera) -> None:
        eye, place = self.seen_from(camera), self.place
        foot = min(place.ground.foot(eye), self.size[1])
        if foot > 0:
            place.scenery.draw(painter.surface, foot, self.moved(camera))
        place.ground.draw(painter, eye)
        self.draw_things(painter, eye, near=False)

    def before(self, painter: Painter, camera: Camera, t: float) -> None:
        self.draw_things(painter, self.seen_from(camera), near=True)

    def draw_things(self, painter: Painter, eye: Eye, near: bool) -> None:
        """Those of the place that are before the ball, or those that are not."""
        for thing in self.standing:
            if thing.near == near:
                thing.draw(painter, eye)

    def inset(self, sheet: Sheet, camera: Camera, t: float | None) -> pygame.Rect | None:
        """On the poster the track from above of a ball that leaves the plane."""
        track = self.track if t is None else ()
        return draw_track(sheet, track, self.datum[0][0], self.TRACE) if track else None

    def remarks(self, camera: Camera) -> list[str]:
        """The distance of what is aimed at, where that is not in sight; nothing of a start, which is at 0."""
        (x, _), what = self.datum
        seen = x == 0.0 or 0 <= camera.pixel(x, 0.0)[0] <= self.size[0]
        return [] if seen else [f"{what} is {roughly(abs(x))} away"]

    @property
    def floor(self) -> float:
        return self.camera.at[1]

    def moved(self, camera: Camera) -> float:
        """The way that the eye has gone to the right from where it was at first, in px of that distance."""
        return (camera.at[0] - self.camera.at[0]) * self.camera.scale

    def position(self, t: float) -> list[Entry]:
        x, y, *_ = self.run.state(self.ball, t)
        return [("height", metres(max(0.0, y - self.radius - self._under(x))))]

    def progress(self, t: float) -> tuple[str, str]:
        return metres(self.run.state(self.ball, t)[0] - self.path.points[0, 0]), self.MEASURED_FROM

    def spots(self, camera: Camera, points: np.ndarray, radius: float, name: str = "") -> np.ndarray:
        """On the path, raised so that balls which are drawn too large along it lie on the ground and not in it."""
        spots, ground = camera.pixels(points), self.ground(points[:, 0])
        if isinf(self.MAX_STRETCH):  # heights are to be read
            return spots
        rows = camera.pixels(np.column_stack([points[:, 0], ground]))[:, 1]
        raised = spots[:, 1] - max(0.0, mark_radius(self.rows) - self.radius * camera.scale)
        spots[:, 1] = np.where(points[:, 1] > ground, np.minimum(raised, rows - radius), spots[:, 1])
        return spots

    def shadow(self, painter: Painter, camera: Camera, name: str, t: float, at: Point, radius: float) -> None:
        """On the ground, the wider and fainter the higher the ball."""
        x, y, *_ = self.run.state(name, t)
        ground = self._under(x)
        height = y - self.radius - ground
        if height < -0.5 * self.radius:
            return
        near = 1 / (1 + max(0.0, height) * camera.scale * camera.stretch / (_SHADOW_FADES * self.unit))
        below = at[0], camera.pixel(x, ground)[1] + self.unit
        painter.shadow(below, radius * (2.2 - near), 0.35 * radius, CARD["shadow"], 0.15 + 0.45 * near)

    def scale(self, sheet: Sheet, camera: Camera) -> None:
        """The ruler, on dark ground of its own where it would stand on bright turf."""
        row, (over, under) = self.rows_at.ruler, sheet.ruler_heights()
        left, right = (camera.world(px, 0.0)[0] for px in (sheet.frame.left, sheet.frame.right))
        lowest = camera.pixel(0.0, float(self.ground(np.linspace(left, right, 60)).min()))[1]
        if lowest > row - over:
            backing = pygame.Rect(sheet.frame.left, row - over, sheet.frame.width, over + under)
            sheet.painter.panel(backing, CARD["background"], 0.5, 10 * self.unit)
        sheet.ruler(camera, row, self.SECOND_UNIT)

    def dimensions(self, sheet: Sheet, camera: Camera) -> None:
        """The distances along the ground, as far as they are seen; no label will be placed on them, nor below."""
        for row, length in zip(self.rows_at.lengths, self.lengths(), strict=False):
            start, end = camera.pixel(length.start, 0)[0], camera.pixel(length.end, 0)[0]
            if min(start, end) >= 0 and max(start, end) <= self.size[0] and abs(end - start) > 4:
                sheet.dimension(length.text, row, start, end, length.colour)
                tall = round(8 * self.unit)
                sheet.labels.take(
                    pygame.Rect(round(min(start, end)), round(row) - tall // 2, round(abs(end - start)), tall)
                )
        sheet.labels.take(pygame.Rect(0, round(self.rows_at.ruler - sheet.ruler_heights()[0]), *self.size))
        self.keep_off(sheet, camera)

    def keep_off(self, sheet: Sheet, camera: Camera) -> None:
        """No label goes over what stands on the ground if there is room elsewhere."""
        eye = self.seen_from(camera)
        for thing in (thing for thing in self.standing if thing.corners):
            points = eye.points(np.array([(*point, 0.0)[:3] for point in thing.corners]))
            if isinstance(thing, Person):
                (left, top), (right, bottom) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
                sheet.labels.avoid(pygame.Rect(round(left), round(top), ceil(right - left) + 1, ceil(bottom - top) + 1))
                continue
            along = np.linspace(points[:-1], points[1:], _ALONG).reshape(-1, 2)
            inside = np.linspace(along, points.mean(axis=0), _ACROSS) if len(points) > 2 else along
            for x, y in inside.reshape(-1, 2).tolist():
                sheet.labels.avoid(pygame.Rect(round(x), round(y), 1, 1))

    @cached_property
    def closeups(self) -> list[CloseUp]:
        """The close-ups of the poster."""
        if self.camera.stretch != 1.0:
            return []
        frame, top = self.sheet.frame, round(self.sheet.top_row + 12 * self.unit)
        free = pygame.Rect(frame.left, top, frame.width, round(self.sky) - top)
        return arranged(self.closeup_boxes(), free, self.camera, self.unit)

    def belongs(self, camera: Camera, place: tuple[float, float]) -> bool:
        """True if a place in m is labelled in what this camera shows: in a close-up if there is one of it."""
        near = next((near for near in self.closeups if near.shows(place)), None)
        return camera == near.camera if near else not any(camera == other.camera for other in self.closeups)

    def impacts(self, camera: Camera) -> list[ImpactMark]:
        return [mark for mark in super().impacts(camera) if self.belongs(camera, mark.at)]

    def enlarge(self, sheet: Sheet) -> None:
        """The close-ups, each with a beam from what it shows."""
        for near in self.closeups:
            self._enlarge(sheet, near)

    def _enlarge(self, sheet: Sheet, near: CloseUp) -> None:
        painter, camera, rect, unit = sheet.painter, near.camera, near.rect, self.unit
        (x, y), (end, low) = self.camera.pixel(near.box.left, near.box.top), self.camera.pixel(*near.box[2:0:-1])
        part = pygame.Rect(round(x), round(y), round(end - x), round(low - y))
        painter.polygon([part.topleft, part.topright, rect.bottomright, rect.bottomleft], sheet.ink, 0.10)
        pygame.draw.rect(sheet.surface, sheet.quiet_ink, part, max(1, round(unit)), round(3 * unit))
        corners = around_corners(sheet.surface, rect, 10 * unit)
        sheet.surface.set_clip(rect)
        outside, sheet.labels = sheet.labels, Labels(rect.inflate(-2 * sheet.gap, -2 * sheet.gap), sheet.gap)
        self.backdrop(painter, camera)
        self.behind(painter, camera, self.moment)
        placed = self._ball_places(camera, self.story_end)
        for name, spot in placed.items():
            self.shadow(painter, camera, name, self.story_end, *spot)
        for ghost in self.ghosts:
            ghost.draw(sheet, self.traced(camera, ghost.points))
        draw_trace(sheet, self.traced(camera, self.path.points), self.TRACE)
        self.strobe(sheet, camera)
        for name, spot in placed.items():
            self.draw_ball(painter, camera, name, self.story_end, *spot)
        self.before(painter, camera, self.moment)
        inner, larger = sheet.labels.frame, f"{camera.scale / self.camera.scale:.1f}×"
        left, right = ((inner.left, 1.0), (inner.right, -1.0))
        ends = [
            (x, y, across, down) for y, down in ((inner.top, 1.0), (inner.bottom, -1.0)) for x, across in (left, right)
        ]
        sheet.chip(larger, ends)
        self.keep_off(sheet, camera)
        self.annotate(sheet, camera)
        mark_impacts(sheet, camera, self.impacts(camera), self.last(camera))
        sheet.labels = outside
        sheet.surface.set_clip(None)
        sheet.surface.blit(corners, rect)
        sheet.labels.take(rect)

    def point_out(self, sheet: Sheet, camera: Camera, place: tuple[float, float], text: str) -> None:
        """Mark a place on the path, in m, and what it is."""
        at = camera.pixel(*place)
        sheet.labels.take(pygame.Rect(0, 0, self.size[0], sheet.top_row))  # the headline's
        draw_mark(sheet, at)
        label_mark(sheet, at, (0.0, 1.0), text)

    def gap(self, sheet: Sheet, camera: Camera, x: float, low: float, high: float, text: str) -> None:
        """A stroke from one height to another at x, all in m, and how long it is, off the path; in a close-up if there
        is one of it."""
        if not self.belongs(camera, (x, high)):
            return
        unit, ink = self.unit, CARD["accent"]
        sheet.labels.take(pygame.Rect(0, 0, self.size[0], sheet.top_row))  # the headline's
        (px, top), (_, bottom) = camera.pixel(x, high), camera.pixel(x, low)
        if bottom - top > 3 * unit:
            sheet.painter.line([(px, top), (px, bottom)], 1.6 * unit, ink)
            for y in (top, bottom):
                sheet.painter.line([(px - 4 * unit, y), (px + 4 * unit, y)], 1.6 * unit, ink)
        trace = self.traced(camera, self.path.points)
        path = trace[np.argmin(np.abs(trace[:, 0] - px))]
        spots: list[LabelPlace] = [
            (px + side * aside * unit, edge + way * far * unit, side * 0.7 if aside else 0.0, way)
            for far in (12, 20, 32, 46)
            for edge, way in ((min(top, path[1]), -1), (max(bottom, path[1]), 1))
            for aside, side in ((0, 0), (10, -1), (10, 1))
        ]
        spots += [
            (px + side * 12 * unit, row, side, 0.0) for row in ((top + bottom) / 2, top, bottom) for side in (1, -1)
        ]
        spots += [
            (px + side * far * unit, top - far * unit, side, -0.7) for far in (30, 45, 60, 80) for side in (1, -1)
        ]
        spots += [
            (px + side * far * unit, top - 0.4 * far * unit, side, 0.0) for far in (40, 55, 70) for side in (1, -1)
        ]
        sheet.chip(f"{metres(high - low)} {text}", spots, ink)


class NetView(SideView[P]):
    """The view of a ball that is played over a net: a game whose facts are ``sandbox.sport.net_game.FACTS``."""

    @property
    def story(self) -> Story:
        """The net, or where the ball comes down."""
        middle, high = 0.5 * self.parameters.court.length, self.parameters.net.height  # type: ignore[attr-defined]
        return self.meeting(Box(middle - 0.1, 0.0, middle + 0.1, high), share=0.3, spot=20 * self.radius)

    def closeup_boxes(self) -> list[Box]:
        """The net as the ball passes it, and the bounce."""
        place, radius = self.parameters, self.radius
        middle, high = 0.5 * place.court.length, place.net.height  # type: ignore[attr-defined]
        gap, landing = self.run.result["net_clearance"], self.run.result["landing"]
        boxes = []
        if gap is not None and abs(gap) < 1.5 * high:
            half = 0.5 * max(abs(gap) + 5 * radius, 0.7 * high)
            boxes.append(Box(middle - 2 * half, high - half, middle + 2 * half, high + max(gap + 3 * radius, half)))
        if landing is not None and boxes:
            tall = boxes[0].top - boxes[0].bottom
            boxes.append(Box(landing - tall, -0.15 * tall, landing + tall, 0.85 * tall))
        return boxes

    def annotate(self, sheet: Sheet, camera: Camera) -> None:
        """Mark how far over the net the ball is as it passes."""
        gap, place = self.run.result["net_clearance"], self.parameters
        if gap is not None and gap > 0.0:
            middle, high = 0.5 * place.court.length, place.net.height  # type: ignore[attr-defined]
            self.gap(sheet, camera, middle, high, high + gap, "over the net")


def _joined(box: Box, other: Box | None) -> Box:
    """The smallest box around both."""
    if other is None:
        return box
    low = min(box.left, other.left), min(box.bottom, other.bottom)
    return Box(*low, max(box.right, other.right), max(box.top, other.top))
