"""The static view: the whole place, with the path of the shot, its contacts, earlier shots and the balls."""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from functools import cached_property
from math import dist
from typing import Any

import numpy as np
import pygame

from sandbox.picture.camera import Camera
from sandbox.picture.painter import Painter, blank
from sandbox.picture.palette import Colour, mix, palette
from sandbox.picture.path import simplify
from sandbox.picture.sheet import Sheet
from sandbox.picture.story import Camerawork
from sandbox.picture.view import View as Picture
from sandbox.window.background import KeyedCache
from sandbox.window.canvas import Canvas
from sandbox.window.layout import Form, Layout
from sandbox.window.shots import Shot

_CARD, _TRACE = palette("card"), palette("trace")
_WHITE, _BLACK = (255, 255, 255), (0, 0, 0)

#: The parts of a picture that are the same for all shots from one place, and take long to make.
_GROUND = ("place", "plan")
#: A path closer than this to an edge of the stage, as a share of its size, makes it be composed anew.
_EDGE = 0.02
#: Where a line bends by more than this, in rad, it has a round joint.
_JOINT = 0.2
#: Distance in px from the edge of a line to its second smooth line, and to the end of its filling with rough edges.
_INSIDE, _FILLED = 1.2, 0.9
#: Up to this width, in px, the smooth lines fill a line between them.
_NARROW = 3.0
#: Overlap in px of the pieces of a line; without it a gap would show where they meet.
_OVERLAP = 0.35
#: The camera zooms in once the shot could be shown this many times larger.
_NEARER = 1.35
#: Opacity of earlier shots (of 255), how much lighter a label is than its line, and how many places
#: on its line are tried for a label.
_EARLIER, _LIGHTER, _PLACES = 215, 0.45, 9
#: Towards which colour, and how far, those of the earlier shots are mixed once all of them are taken.
_SHADES = ((_WHITE, 0.0), (_WHITE, 0.5), (_BLACK, 0.4), (_WHITE, 0.75))
#: So many squares along a path are left free where there is room.
_SQUARES = 50
#: What a headline leaves free for the wind at the right, in px on 720 rows.
_WIND = 100
#: Contacts closer together than this, in px, are marked once; and the largest number of marks.
_NEAR, _MOST_CONTACTS = 14, 24


class Stage:
    """The place of one shot, composed for its parameters at ``size`` px; and what is drawn on it."""

    def __init__(
        self, shot: Shot, size: tuple[int, int], chosen: Camera | None = None, before: Stage | None = None
    ) -> None:
        """The camera is ``chosen`` if given, and otherwise shows all of the shot; the camera of ``before``, the stage
        so far, is kept if it does so too, or each small change of the aim would shift the picture.
        """
        self.shot, self.size, self.chosen = shot, size, chosen
        self.picture = shot.run.scene.picture(shot.run, size)
        vars(self.picture)["story_end"] = self.story = _story_of(shot, self.picture.story_end)
        self.whole = self.picture.camera
        vars(self.picture)["camera"] = chosen or self._camera_of(before) or self.whole
        self.camera = self.picture.camera
        self.aimed = self._camera_of(before, anyway=True) or self.camera  # from which the shot was aimed
        self.compose(self.picture.stage())

    def compose(self, backdrop: pygame.Surface) -> None:
        """Draw what stands still, as the camera sees it."""
        self.backdrop = backdrop
        sheet = Sheet(self.size, self.picture.on_dark, backdrop)
        self.picture.measure(sheet, self.camera)
        self.notes = self.picture.notes(self.camera)  # what is not drawn to scale
        along, up = self.picture.wind
        wind = [sheet.wind(along, up, sheet.frame.right, sheet.frame.top)] if along or up else []
        self.texts = [*wind, *(rect for _, rect in sheet.written)]  # of the place, in px
        self._once = KeyedCache()

    @cached_property
    def camerawork(self) -> Camerawork | None:
        """The camera that goes with the story of the shot, from where it was aimed; None if it stays where it is."""
        return self.picture.camerawork_from(self.aimed, self.camera) if self.chosen is None else None

    def at(self, t: float) -> Stage:
        """The stage as the camera of the story sees it, at a time in s of the shot."""
        camera = self.camera if self.camerawork is None else self.camerawork.camera(t)
        if camera == self.camera:
            return self
        stage: Stage = self._once("moved", camera, lambda: self._seen_by(camera))
        return stage

    def _seen_by(self, camera: Camera) -> Stage:
        stage = copy(self)
        stage.camera = camera
        stage.compose(self.picture.backdrop_of(camera))
        return stage

    def _camera_of(self, before: Stage | None, anyway: bool = False) -> Camera | None:
        """The camera so far, if it shows the same place and, or ``anyway``, all of the shot, large enough."""
        if before is None or before.chosen is not None or before.size != self.size:
            return None
        if not before.is_place_of(self.shot):
            return None
        near = anyway or (self.whole.scale <= _NEARER * before.camera.scale and before.holds(self.shot))
        return before.camera if near and before.camera.stretch == self.whole.stretch else None

    def shows(self, shot: Shot, chosen: Camera | None) -> bool:
        """True if it was composed for this shot and this choice of camera."""
        return self.shot.run is shot.run and self.chosen == chosen

    def is_place_of(self, shot: Shot) -> bool:
        """True if a shot differs from the composed one only in what a player aims with."""
        return self.shot.place == shot.place

    def holds(self, shot: Shot) -> bool:
        """True if the path of another shot stays in sight."""
        shares = self.pixels(shot.track(shot.ball)[:, 1:]) / self.size
        return shot.run is self.shot.run or bool((shares >= _EDGE).all() and (shares <= 1 - _EDGE).all())

    def ball_at(self, shot: Shot, t: float = 0.0, ball: str = "") -> tuple[float, float]:
        """The place of a ball, by default the one that is played, in px."""
        ((x, y),) = self.pixels(np.array([shot.run.state(ball or shot.ball, t)[:2]])).tolist()
        return x, y

    def pixels(self, points: np.ndarray) -> np.ndarray:
        """The places in px where the picture draws points of a path (m), both of shape (n, 2): in a view from the side
        higher than its camera has them, where balls are drawn larger than they are."""
        return self.picture.spots(self.camera, points, 0.0)

    def draw_measured(self, sheet: Canvas) -> None:
        """The measured points that the scene's file names."""
        if self.shot.scene.measured is not None:
            sheet.surface.blit(self._once("measured", (), self._measured), (0, 0))

    def _measured(self) -> pygame.Surface:
        layer = blank(self.size, transparent=True)
        self.picture.draw_measured(Painter(layer), self.camera)
        return layer

    def draw_ghosts(self, sheet: Canvas, ghosts: Sequence[Shot]) -> None:
        """The paths of earlier shots."""
        shown = tuple(ghosts)
        if shown:
            sheet.surface.blit(self._once("ghosts", shown, lambda: self._ghost_lines(shown)), (0, 0))

    def _ghost_lines(self, shown: Sequence[Shot]) -> pygame.Surface:
        layer = blank(self.size, transparent=True)
        for shot in shown:
            line = self.line(shot)
            draw_line(layer, line, 4, _TRACE["rim"])
            draw_line(layer, line, 2, self.colour_of(shot.number))
        layer.set_alpha(_EARLIER)
        return layer

    def label_ghosts(self, sheet: Canvas, ghosts: Sequence[Shot], around: Shot, layout: Layout) -> None:
        """Number and result of each earlier shot, where on its path there is room around the path of a shot."""
        off = tuple(tuple(rect) for rect in layout.occupied)
        shown = tuple(ghosts)
        found: Sheet = self._once(
            "labels", (shown, around, off), lambda: self._ghost_labels(sheet, shown, around, layout)
        )
        sheet.surface.blit(found.surface, (0, 0))
        layout.placed |= {f"earlier {number}": rect for number, (_, rect) in enumerate(found.written)}

    def _ghost_labels(self, sheet: Canvas, shown: Sequence[Shot], around: Shot, layout: Layout) -> Sheet:
        labels = Sheet(self.size, surface=blank(self.size, transparent=True))
        labels.labels.frame = layout.room.copy()
        labels.labels.taken += layout.occupied
        labels.labels.take_path(self.line(around).tolist(), 5 * sheet.unit)
        for shot in shown:
            name = str(shot.number) if shot.number else shot.called
            text = sheet.shortened(f"{name}:  {shot.verdict}", "small", 0.3 * sheet.size[0])
            line = self.line(shot)
            places = line[np.linspace(len(line) - 1, 0, _PLACES).round().astype(int)]
            beyond = ((1.0, -1.0), (-1.0, -1.0), (1.0, 1.0), (-1.0, 1.0))
            spots = [(x + 9 * a, y + 9 * d, a, d) for x, y in places.tolist() for a, d in beyond]
            labels.chip(text, spots, mix(self.colour_of(shot.number), _CARD["text"], _LIGHTER))
        return labels

    def kept_clear(self, shot: Shot, t: float) -> list[pygame.Rect]:
        """The parts in px that nothing may cover at time t in s: balls, what is aimed at, the texts of the place."""
        return [*self.clear_of(shot, t), *self.texts]

    def clear_of(self, shot: Shot, t: float) -> list[pygame.Rect]:
        """The balls at time t in s, and what is aimed at, as far as they are seen."""
        whole = pygame.Rect((0, 0), self.size)
        return [rect for rect in self.picture_of(shot).kept_clear(self.camera, t) if rect.colliderect(whole)]

    def along(self, shot: Shot) -> list[pygame.Rect]:
        """Squares along the path of a shot, in px: cards leave it free where they can."""
        line = self.line(shot)
        far = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
        every = np.linspace(0.0, far[-1], _SQUARES)
        points = np.column_stack([np.interp(every, far, axis) for axis in line.T])
        return [pygame.Rect(round(x) - 6, round(y) - 6, 12, 12) for x, y in points.tolist()]

    def colour_of(self, number: int) -> Colour:
        """The colour of an earlier shot, which stays the same; those whose paths are kept differ."""
        own, usual = self.picture.OTHER_TRACES, [each for each in _TRACE["colours"] if each != self.picture.TRACE]
        colours = list(dict.fromkeys([*own, *usual]))
        round_, place = divmod(number - 1, len(colours))
        towards, share = _SHADES[round_ % len(_SHADES)]
        return mix(colours[place], towards, share)

    def draw_path(self, sheet: Canvas, shot: Shot, until: float | None = None) -> None:
        """The path of every ball that moves, that of the played one last and strongest, and where they touch."""
        colour_of = self.picture.colour_of
        thin = max(1, round(1.4 * sheet.unit))
        for ball in shot.movers[:-1]:
            draw_line(sheet.surface, self.line(shot, ball, until), thin, colour_of(ball))
        width, line = max(3, round(3.6 * sheet.unit)), self.line(shot, shot.ball, until)
        draw_line(sheet.surface, line, width + 2, _TRACE["rim"])
        draw_line(sheet.surface, line, width, colour_of(shot.ball))
        self._contacts(sheet, shot, until)

    def draw_balls(
        self, sheet: Canvas, shot: Shot, t: float, until: float | None = None, answering: float | None = None
    ) -> None:
        """The balls of a shot at time t in s; in a lens their paths until a time in s, or all of them. What was hit
        answers at a time in s, or stands still."""
        ahead = shot.run.duration if until is None else until
        self.picture_of(shot).draw_balls(sheet.painter, self.camera, t, ahead, answering)

    def picture_of(self, shot: Shot) -> Picture[Any]:
        """The picture of a shot from the same place, as this stage's camera shows it and on the same ground."""
        if shot.run is self.shot.run:
            return self.picture
        picture: Picture[Any] = self._once("picture", shot, lambda: shot.run.scene.picture(shot.run, self.size))
        composed = {
            "camera": self.picture.camera,
            **{name: vars(self.picture)[name] for name in _GROUND if name in vars(self.picture)},
        }
        vars(picture).update(composed)
        return picture

    def line(self, shot: Shot, ball: str = "", until: float | None = None) -> np.ndarray:
        """Points in px of the path of a ball, by default the played one, shape (n, 2); up to the time ``until`` (s)."""
        ball = ball or shot.ball
        if until is None:
            line: np.ndarray = self._once(ball, shot, lambda: self._drawn(shot.track(ball)))
            return line
        track = shot.track(ball)
        track = track[track[:, 0] <= until]
        return self._drawn(np.vstack([track, (until, *shot.run.state(ball, until)[:2])]))

    def _drawn(self, track: np.ndarray) -> np.ndarray:
        return simplify(np.clip(self.pixels(track[:, 1:]), -4000, 8000))

    def _contacts(self, sheet: Canvas, shot: Shot, until: float | None) -> None:
        marked: list[tuple[float, float]] = []
        begins = shot.track(shot.ball)[0, 0]
        for event in shot.run.events:
            if event.kind != "impact" or event.ball != shot.ball or (until is not None and event.t > until):
                continue
            if event.t < begins:
                continue
            x, y = self.pixels(np.array([[event.x, event.y]]))[0].tolist()
            if all(dist((x, y), other) >= _NEAR * sheet.unit for other in marked):
                marked.append((x, y))
        for at in marked[:_MOST_CONTACTS]:
            sheet.painter.disc(at, 5.0 * sheet.unit, _TRACE["rim"], 0.7)
            sheet.painter.disc(at, 3.6 * sheet.unit, _CARD["accent"])


def _story_of(shot: Shot, told: float) -> float:
    """The time in s at which a shot's story ends in the window: with the next impact of the ball that is played after
    the verdict is in, at the time ``told``."""
    impacts = (e.t for e in shot.run.events if e.kind == "impact" and e.ball == shot.ball and e.t > told)
    return min(impacts, default=shot.run.duration)


def draw_line(surface: pygame.Surface, points: np.ndarray, width: float, colour: Colour) -> None:
    """A smooth line through points (px, shape (n, 2)), equally wide in every direction: faster than the painter's.

    pygame's own smooth lines are ``width`` px wide only where they are horizontal or vertical.
    """
    if width < 2.5:
        Painter(surface).thread(points, width, colour)
        return
    steps = np.diff(points, axis=0)
    lengths = np.maximum(np.hypot(*steps.T), 1e-9)
    along = steps / lengths[:, None]
    across = np.column_stack([-along[:, 1], along[:, 0]])
    bends = np.hypot(*np.diff(across, axis=0).T) > _JOINT
    for point in points[1:-1][bends]:
        pygame.draw.aacircle(surface, colour, point, width / 2)
    sides = np.array([width / 2 - 0.5, width / 2 - _INSIDE, _INSIDE - width / 2, 0.5 - width / 2])[:, None, None]
    starts, ends = points[:-1] - _OVERLAP * along, points[1:] + _OVERLAP * along
    if width > _NARROW:
        half = (width / 2 - _FILLED) * across
        begin, end = starts + 0.5, ends + 0.5  # pygame cuts the corners of a polygon off to whole px
        for quad in np.stack([begin + half, end + half, end - half, begin - half], axis=1).tolist():
            pygame.draw.polygon(surface, colour, quad)
    for one, other in zip((starts + sides * across).tolist(), (ends + sides * across).tolist(), strict=True):
        for a, b in zip(one, other, strict=True):
            pygame.draw.aaline(surface, colour, a, b)


def headline(sheet: Canvas, text: str, notes: Sequence[str], colour: Colour) -> list[Form]:
    """The headline, large on a dark card, and a line below it with as many notes as there is room for; then smaller,
    and with fewer notes."""
    room = sheet.frame.width - 4 * sheet.gap - _WIND * sheet.unit
    rooms = [("large", 0.66 * sheet.size[0]), ("medium", room), ("small", room), ("small", 0.5 * room)]
    width = sheet.lettering.width
    forms = [_headline(sheet, text, notes, colour, size, room) for size, most in rooms
             if width(text, size, bold=True) <= most]  # fmt: skip
    last = [_headline(sheet, text, some, colour, "small", share * room) for share in (1.0, 0.6, 0.4)
            for some in (notes[:1], ())]  # fmt: skip
    return [*forms, *(form._replace(whole=False) for form in last)]


def _headline(sheet: Canvas, text: str, notes: Sequence[str], colour: Colour, size: str, room: float) -> Form:
    """A headline of one size with as many notes as there is room for, in px."""
    letters, inset = sheet.lettering, 2 * sheet.gap
    text = letters.cut(text, size, room, bold=True)
    lines = ["   ·   ".join(notes[:count]) for count in range(len(notes), 0, -1)]
    cut = letters.cut(lines[-1], "small", room) if lines else ""
    note = next((line for line in lines if letters.width(line, "small") <= room), cut)
    width = max(letters.width(text, size, bold=True), letters.width(note, "small"))
    height = letters.height(size) + (letters.height("small") + sheet.gap) * bool(note)

    def draw(rect: pygame.Rect) -> None:
        sheet.painter.panel(rect, _CARD["background"], _CARD["opacity"], 10 * sheet.unit)
        at = sheet.write(text, size, (rect.left + inset, rect.top + sheet.gap), colour, bold=True)
        sheet.write(note, "small", (at.left, at.bottom + sheet.gap), _CARD["quiet"])

    return Form((width + 2 * inset, height + inset), draw)
