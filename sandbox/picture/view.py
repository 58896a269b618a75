"""Pictures of all scenes: poster and frames, drawn in layers, with headline, notes and card.

What a scene may override is in :class:`~sandbox.picture.options.SceneOptions`, what moves is drawn by
:class:`~sandbox.picture.moving.BallDrawing`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import pygame

from sandbox.engine.model.surface import Circle, Segment, Surface
from sandbox.errors import RequestError
from sandbox.picture.camera import Area, Camera, Eye
from sandbox.picture.marks import Ghost, mark_impacts, mark_measured
from sandbox.picture.moving import NOT_WORTH_NOTING, BallDrawing
from sandbox.picture.options import P
from sandbox.picture.painter import Painter, blank
from sandbox.picture.sheet import Entry, Sheet
from sandbox.picture.story import Camerawork, frame_times
from sandbox.scene.scene_run import SceneRun
from sandbox.sport.amounts import times
from sandbox.text import with_noun

#: Surfaces are around a path that reach no farther beyond it than it is long, or than so many radii of the ball.
_NEAR = 12.0
#: The reach of a surface that moves is judged at so many times.
_POSES = 48
#: What frames show has at least so much of the picture's height: in small ones it is also behind the headline.
_LEAST_AREA = 0.35
#: Text is dark on a place at least this light, in levels of 255: between the darkest sky by day and the lightest hall.
_LIGHT = 150


class _Heading(NamedTuple):
    """The words above a poster: the headline, the notes under it, and the room for them in px."""

    text: str
    notes: list[str]
    room: float


class View(BallDrawing[P]):
    """One run of a scene at ``size`` px: whole, as a poster, or as it is at a time t.

    ``ghosts`` are other runs of the scene by what they are called, drawn pale behind this one.
    """

    def __init__(
        self,
        run: SceneRun,
        parameters: P,
        size: tuple[int, int] = (1280, 720),
        ghosts: Mapping[str, SceneRun] | None = None,
    ) -> None:
        self.run, self.parameters, self.size = run, parameters, size
        self.sheet = Sheet(size)  # the one drawn last
        self.unit, self.rows = self.sheet.unit, self.sheet.rows
        self.radii = {ball.name: ball.radius for ball in run.setup.balls}  # m
        self.radius = self.radii[self.ball]
        self.ghosts = [self._ghost(i, *other) for i, other in enumerate((ghosts or {}).items())]
        self.ahead = 0.0  # s; until then paths are shown that balls are still to go
        self.still = False  # True keeps the camera where it is, and time even
        self.filmed = False  # True if frames are shown at the pace of the story, which they say
        self._standing: tuple[Camera, pygame.Surface] | None = None

    def _ghost(self, i: int, label: str, run: SceneRun) -> Ghost:
        """Another run of the same scene, laid over this one where its ``datum`` says.

        Raises RequestError where it cannot be: from the side, all share one ground.
        """
        parameters: Any = run.scene.parameters
        other = type(self)(run, parameters, self.size)
        ((x, y), what), ((there_x, there_y), _) = self.datum, other.datum
        if self.SHARED_GROUND and there_y != y:
            raise RequestError(f"{label}: {what} is at {there_y:g} m, and here at {y:g} m: these cannot be compared")
        return Ghost(label, other, self.OTHER_TRACES[i % len(self.OTHER_TRACES)], (x - there_x, y - there_y))

    # What a view from the side and one from above say

    @property
    def area(self) -> Area:
        """The part of the picture for what must be seen, in px."""
        raise NotImplementedError

    @cached_property
    def on_dark(self) -> bool:
        """True if text stands on dark ground: as the scene says, or as the place is where the headline stands."""
        if self.ON_DARK is not None:
            return self.ON_DARK
        frame = self.sheet.frame
        head = pygame.Rect(frame.left, frame.top, frame.width // 2, max(1, self.sheet.top_row - frame.top))
        red, green, blue, *_ = pygame.transform.average_color(self._still(self.camera), head)
        return 0.299 * red + 0.587 * green + 0.114 * blue < _LIGHT

    @property
    def card_row(self) -> float:
        """The row at which the card begins, in px from the top."""
        return self.sheet.card_row(len(self.ghosts))

    def scale(self, sheet: Sheet, camera: Camera) -> None:
        """A ruler or a scale bar."""

    def dimensions(self, sheet: Sheet, camera: Camera) -> None:
        """The lengths that the run came to, on its poster."""

    def enlarge(self, sheet: Sheet) -> None:
        """Draw on the poster what is enlarged besides."""

    # The camera of frames

    @property
    def frame_area(self) -> Area:
        """The part of a frame for what must be seen, in px."""
        area = self.area
        return area._replace(top=min(area.top, area.bottom - _LEAST_AREA * self.size[1]))

    def fitted(self, area: Area) -> Camera:
        """The camera that shows in an area of the picture, in px, all that must be seen."""
        raise NotImplementedError

    @cached_property
    def camerawork(self) -> Camerawork | None:
        """The camera that goes with the story of the run; None if it stays where it is."""
        return self.camerawork_from(self.camera if self.frame_area == self.area else self.fitted(self.frame_area))

    def camerawork_from(self, first: Camera, last: Camera | None = None) -> Camerawork | None:
        """The same, where another camera shows the start, or another the end."""
        if self.story is None or self.still:
            return None
        slower, height = self.slow_motion, self.size[1]
        return Camerawork(self.run, self.story, self.ball, self.frame_area, height, first, slower, self.floor, last)

    def view(self, t: float) -> Camera:
        """The camera of the frame at time t in s."""
        return self.camera if self.camerawork is None else self.camerawork.camera(t)

    @property
    def closest(self) -> Camera:
        """The camera of frames where it is nearest."""
        return self.view(self.camerawork.decided) if self.camerawork is not None else self.camera

    def slower(self, t: float) -> float:
        """The factor by which time is slower in a film, at time t in s of the run."""
        return float(self.slow_motion) if self.camerawork is None else self.camerawork.slower(t)

    def film(self, fps: float) -> list[float]:
        """The times in s of the frames of a film, so many for each s of who sees it."""
        if self.camerawork is None:
            return frame_times(self.run.duration, fps * self.slow_motion)
        return self.camerawork.film(fps)

    # What must be seen

    @property
    def wind(self) -> tuple[float, float]:
        """In m/s, along and up; none for a scene without air."""
        wind: tuple[float, float] = getattr(getattr(self.parameters, "air", None), "wind", (0.0, 0.0))
        return wind

    @cached_property
    def points(self) -> np.ndarray:
        """All places in m that must be seen: of every path, and of the other runs'; shape (n, 2)."""
        own = [path.points for path in self.paths.values()]
        measured = [] if self.run.scene.measured is None else [self.run.scene.measured.positions]
        return np.concatenate([*own, *measured, *(ghost.points for ghost in self.ghosts)])

    @cached_property
    def surroundings(self) -> np.ndarray:
        """Lower left and upper right corner in m of all that must be seen and of the surfaces around it: all of those
        that do not reach far beyond, of others the place next to its middle; shape (2, 2)."""
        radius = max(self.radii.values())
        low, high = self.points.min(axis=0) - radius, self.points.max(axis=0) + radius
        reach, middle = max(_NEAR * radius, *(high - low)), (low + high) / 2
        for shape in self.solids:
            a, b = map(np.array, shape.ends)
            next_to = a + np.clip((middle - a) @ (b - a) / max((b - a) @ (b - a), 1e-99), 0.0, 1.0) * (b - a)
            for seen in (np.array([np.minimum(a, b) - shape.radius, np.maximum(a, b) + shape.radius]), next_to[None]):
                if np.all(seen > low - reach) and np.all(seen < high + reach):
                    low, high = np.minimum(low, seen.min(axis=0)), np.maximum(high, seen.max(axis=0))
        return np.array([low, high])

    @property
    def solids(self) -> list[Segment | Circle]:
        """Surfaces that are shown where they are near; those that move at some times of the run."""
        return [shape for surface in self.run.setup.surfaces for shape in self._seen_of(surface)]

    def _seen_of(self, surface: Surface) -> list[Segment | Circle]:
        times = [0.0] if surface.motion is None else np.linspace(0.0, self.story_end, _POSES).tolist()
        return [surface.at(t).shape for t in times]

    # Poster and frames

    def poster(self) -> pygame.Surface:
        """The whole run in one picture."""
        for _ in self.layers():
            pass
        sheet = self.sheet
        sheet.headline(*self.heading)
        rows = [(ghost.light, ghost.run.scene.rows(ghost.run)) for ghost in self.ghosts]
        sheet.columns(self.card_row, self.run.scene.rows(self.run), rows)
        for ghost in self.ghosts:
            ghost.name(sheet, self.traced(self.camera, ghost.points), self.trace)
        return sheet.surface

    def layers(self) -> Iterator[str]:
        """Draw the poster on ``sheet``, from the lowest layer to the highest; the name of each is said when it is
        drawn. Then all is there but text, and ``heading`` is known."""
        camera = self.camera
        sheet = self.sheet = Sheet(self.size, self.on_dark, self._still(camera).copy())
        painter = sheet.painter
        placed = self._ball_places(camera, self.story_end)
        self.behind(painter, camera, self.moment)
        yield "place"
        self._sweep(painter, camera)
        self._strings(painter, camera, self.story_end)
        for name, spot in placed.items():
            self.shadow(painter, camera, name, self.story_end, *spot)
        sheet.surface.set_clip(self.opening)
        self._traces(sheet, camera)
        sheet.surface.set_clip(None)
        yield "paths"
        every = self.strobe(sheet, camera)
        yield "along"
        for name, spot in placed.items():
            self.draw_ball(painter, camera, name, self.story_end, *spot)
        yield "balls"
        self.draw_measured(painter, camera)
        self.before(painter, camera, self.moment)
        self.dimensions(sheet, camera)
        self.measure(sheet, camera)
        self.annotate(sheet, camera)
        mark_impacts(sheet, camera, self.impacts(camera), self.last(camera))
        self.enlarge(sheet)
        room = self._draw_inset(sheet, camera, None)
        yield "over"
        points = self.run.scene.measured
        dots = [] if points is None else [f"dots: {with_noun(len(points.t), 'measured point')}"]
        others = [*dots, *(ghost.note for ghost in self.ghosts)]
        notes = [*others, *self.aligned, *every[:1], *self.notes(camera), *every[1:]]
        self.heading = _Heading(self.run.scene.verdict(self.run), notes, room)

    def frame(self, t: float) -> pygame.Surface:
        """The scene at time t in s of the run, after whose end only the camera goes on."""
        camera, self.answering, t = self.view(t), t, min(max(t, 0.0), self.run.duration)
        sheet = self.sheet = Sheet(self.size, self.on_dark, self._still(camera).copy())
        painter = sheet.painter
        placed = self._ball_places(camera, t, in_frame=True)
        self.behind(painter, camera, t)
        self._pull_nets(painter, camera)
        self.draw_driven(painter, camera, t)
        self._strings(painter, camera, t)
        for name, spot in placed.items():
            self.shadow(painter, camera, name, t, *spot)
        self._trails(sheet, camera, t)
        self.draw_measured(painter, camera)
        if self.ball in placed and t < self.caught[self.ball]:
            sheet.surface.set_clip((0, min(sheet.top_row, self.area.top), *self.size))
            self.vectors.draw(sheet, *placed[self.ball], t)
            sheet.surface.set_clip(None)
        for name, spot in placed.items():
            self.draw_ball(painter, camera, name, t, *spot)
        self.before(painter, camera, t)
        self.scale(sheet, camera)
        room = self._draw_inset(sheet, camera, t)
        headline, note = (self.run.scene.verdict(self.run), "") if t >= self.story_end else self.progress(t)
        others = " and ".join(ghost.label for ghost in self.ghosts)
        compared = [f"compared with {others}"] if others else []
        larger = self._larger(camera, in_frame=True)
        slower = self.slower(t) if self.filmed else 1.0
        slow = f"slow motion, {slower:g} times slower" if slower > 1.0 and slower.is_integer() else ""
        notes = [slow, note, *compared, *self.aligned, *self._stretched(camera), *self._caveat, *larger]
        sheet.headline(headline, [note for note in notes if note], room)
        rows = [(ghost.light, ghost.view.live(min(t, ghost.run.duration))) for ghost in self.ghosts]
        sheet.columns(self.card_row, self.live(t), rows)
        return sheet.surface

    def _pull_nets(self, painter: Painter, camera: Camera) -> None:
        """Draw the nets that the ball pulls out."""
        if self.answering is not None:
            for net in self.pulled:
                net.draw(painter, self.seen_from(camera), self.answering)

    def seen_from(self, camera: Camera) -> Camera | Eye:
        """Sees what the camera shows."""
        return camera

    def live(self, t: float) -> list[Entry]:
        """The entries of a frame's card at time t in s; a ball that was caught does nothing any more."""
        speed, way, spin = self.moving(self.ball, t)
        does = [speed, way, *self.vectors.entries(t), spin]
        if t >= self.caught[self.ball]:
            does = [(label, "–") for label, *_ in does]
        return [("time", self.clock(t)), *self.position(t), *does]

    def _still(self, camera: Camera) -> pygame.Surface:
        """The place; kept while the camera stands still."""
        if self._standing is None or self._standing[0] != camera:
            surface = blank(self.size) if self._standing is None else self._standing[1]  # new memory is slow
            self.backdrop(Painter(surface), camera)
            self._standing = camera, surface
        return self._standing[1]

    def _draw_inset(self, sheet: Sheet, camera: Camera, t: float | None) -> float:
        """Draw what is in the upper right corner; how much room that leaves for the headline, in px."""
        inset = self.inset(sheet, camera, t)
        if inset is not None:
            sheet.labels.take(inset)
        right = sheet.frame.right if inset is None else inset.left - 2 * sheet.gap
        if any(self.wind):
            right = sheet.wind(*self.wind, right, sheet.frame.top).left - 2 * sheet.gap
        return right - sheet.frame.left

    # For the window and the page

    def draw_measured(self, painter: Painter, camera: Camera) -> None:
        """The measured points that the scene's file names, over the path."""
        points = self.run.scene.measured
        if points is not None:
            mark_measured(painter, self.spots(camera, points.positions, 0.0), self.unit)

    def stage(self) -> pygame.Surface:
        """The place alone, as the poster's camera sees it."""
        return self.backdrop_of(self.camera)

    def backdrop_of(self, camera: Camera) -> pygame.Surface:
        """The place alone, as a camera sees it."""
        return self._still(camera).copy()

    def draw_balls(
        self, painter: Painter, camera: Camera, t: float, ahead: float = 0.0, answering: float | None = None
    ) -> None:
        """All that moves, at time t in s, on the stage that the camera sees; paths in a lens until ``ahead`` in s.
        What was hit answers at the time ``answering`` in s; with None it stands still."""
        self.ahead, self.answering = ahead, answering
        self.behind(painter, camera, t)
        self._pull_nets(painter, camera)
        self.draw_driven(painter, camera, t)
        self._strings(painter, camera, t)
        self.place_balls(painter, camera, t)
        self.before(painter, camera, t)

    def measure(self, sheet: Sheet, camera: Camera) -> None:
        """Draw ruler or scale bar, and the labels that hold for any shot."""
        self.scale(sheet, camera)
        self.landmarks(sheet, camera)

    # Notes

    def notes(self, camera: Camera) -> list[str]:
        """Notes on what is not drawn as it is."""
        return [*self._stretched(camera), *self.remarks(camera), *self._larger(camera), *self._caveat]

    @property
    def aligned(self) -> list[str]:
        """To note where the other runs were moved to lie over this one."""
        return [f"aligned at {self.datum[1]}"] if any(any(ghost.shift) for ghost in self.ghosts) else []

    @property
    def _caveat(self) -> list[str]:
        return [self.caveat] if self.caveat else []

    @property
    def caveat(self) -> str:
        """The warning about what is not validated."""
        return self.CAVEAT

    def _stretched(self, camera: Camera) -> list[str]:
        """To note how much larger heights are drawn than lengths."""
        return [f"{self.STRETCHED} drawn {camera.stretch:g} times as large as lengths"] if camera.stretch != 1 else []

    def _larger(self, camera: Camera, in_frame: bool = False) -> list[str]:
        """To note how many times their size balls are drawn; in frames, whose camera may move, that they are larger."""
        alone, radius = len(self.balls) == 1, self.radius
        if in_frame:  # which need not be true of all
            radius = min(self.radii[name] for name in self.balls)
        factor = self._least(in_frame) / (radius * camera.scale)
        whose, are = ("its", "it is") if alone else ("their", "they are")
        how = f"larger than {are}" if in_frame else f"{times(factor)} {whose} size"
        return [f"{self.thing if alone else self.things} drawn {how}"] if factor > NOT_WORTH_NOTING else []
