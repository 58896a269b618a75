"""Runs as data for the player of pages: the place, the paths as polynomials, the forces."""

from __future__ import annotations

from math import atan2, isinf, isnan
from typing import Any

import numpy as np
from PIL import Image

from sandbox.engine.model.surface import Surface
from sandbox.engine.paths.arc import Arc
from sandbox.engine.paths.path import Path
from sandbox.engine.paths.phase import Phase
from sandbox.page.parts import css, picture, what_changed
from sandbox.picture import ball as balls
from sandbox.picture.above import AboveView
from sandbox.picture.frames import to_image
from sandbox.picture.long import LongView
from sandbox.picture.moving import NOT_WORTH_NOTING, THINNEST
from sandbox.picture.palette import palette
from sandbox.picture.path import instants
from sandbox.picture.sheet import CARD, Sheet
from sandbox.picture.side import SideView
from sandbox.picture.vectors import FORCE_LENGTH, SHORTEST, VELOCITY_LENGTH, colour_of
from sandbox.picture.view import View
from sandbox.scene.scene_run import SceneRun
from sandbox.sport.amounts import DISPLAY_UNITS, ladder
from sandbox.sport.readings import words_of
from sandbox.units import convert

#: The picture that shows until the page's script draws, and where none runs, is at most so large, in px.
POSTER = (640, 640)
#: The forces are sampled at so many even times, and at each impact.
SAMPLES = 240
#: The poses a second of surfaces that move.
_POSES_A_SECOND = 120
#: Keyframes of the camera a second; what is seen larger than this at the decision has a layer of its own.
_KEYS_A_SECOND, _WORTH_NEAR = 30, 1.5
#: The ground's height is sampled at so many places.
GROUND = 400
#: Units of the numbers that the page itself writes.
_UNITS = ("m", "m/s", "deg", "rpm", "s", "N")
#: To what, in m and rad/s, the path of a ball in a heap is rounded.
_HEAPED = 1e-12
#: Most impacts and other events that are listed.
_MOST_EVENTS = 400


def layout_data(view: View[Any]) -> dict[str, Any]:
    """Return the poster of a run in its layers, with its camera; lengths in px."""
    whole = {name: np.array(to_image(view.sheet.surface)) for name in view.layers()}
    tall = round(view.card_row - 2 * view.sheet.gap)  # the card is below
    place, paths, along, drawn, over = (whole[name][:tall] for name in ("place", "paths", "along", "balls", "over"))
    poster = Image.fromarray(over)
    poster.thumbnail(POSTER)
    return {
        **_camera_of(view, tall),
        "room": view.heading.room,
        "poster": picture(poster),
        "place": picture(Image.fromarray(place)),
        "along": picture(what_changed(paths, along), exact=True),
        "over": picture(what_changed(drawn, over), exact=True),
        "lens": _lens(view, tall),
        "near": _near(view, tall),
    }


def stage_data(view: View[Any], turned: bool = False) -> dict[str, Any]:
    """Return the place of a run without the run, for aiming: its layers, with its camera; lengths in px. One that is
    shown ``turned``, by a quarter to the left, has no letters on it."""
    camera, tall = view.camera, view.size[1]
    sheet = Sheet(view.size, view.on_dark, view.stage())
    view.behind(sheet.painter, camera, 0.0)
    place = np.array(to_image(sheet.surface))
    view.before(sheet.painter, camera, 0.0)
    if not turned:
        view.measure(sheet, camera)
        if any(view.wind):
            sheet.wind(*view.wind, sheet.frame.right, sheet.frame.top)
    over = np.array(to_image(sheet.surface))
    lens = _lens(view, tall, quick=True)
    if lens is not None:
        (left, top), (wide, high) = lens["corner"], lens["size"]
        part = np.s_[top : top + high, left : left + wide]
        over[part] = place[part]  # what moves there is drawn by the page
    return {
        **_camera_of(view, tall),
        "turned": turned,
        "notes": view.notes(camera),
        "place": picture(Image.fromarray(place), quick=True),
        "along": None,
        "over": picture(what_changed(place, over), exact=True, quick=True),
        "lens": lens,
        "near": _near(view, tall, quick=True),
    }


def _near(view: View[Any], tall: int, quick: bool = False) -> dict[str, Any] | None:
    """Return the place as the camera sees it where a run is decided, in a picture of so many rows, with the corner of
    that and its size in px of the whole; None where that is hardly larger."""
    camera, near = view.camera, view.closest
    if isinstance(view, LongView) or near.scale < _WORTH_NEAR * camera.scale:
        return None
    if isinstance(view, AboveView):
        view.lit = True
    sheet = Sheet(view.size, view.on_dark, view.backdrop_of(near))
    view.behind(sheet.painter, near, view.moment)
    view.before(sheet.painter, near, view.moment)
    corner, far = (camera.pixel(*near.world(*at)) for at in ((0.0, 0.0), (view.size[0], tall)))
    return {
        "place": picture(to_image(sheet.surface).crop((0, 0, view.size[0], tall)), quick=quick),
        "corner": corner,
        "size": (far[0] - corner[0], far[1] - corner[1]),
    }


def _lens(view: View[Any], tall: int, quick: bool = False) -> dict[str, Any] | None:
    """Return the part of a long place that is seen from near by, without what moves, and its camera; in a picture of so
    many rows, in px. None for other views."""
    if not isinstance(view, LongView):
        return None
    camera, lens = view.near_camera, view.lens
    high = min(lens.height, tall - lens.top)
    return {
        "corner": lens.topleft,
        "size": (lens.width, high),
        "place": picture(to_image(view.empty_lens()).crop((0, 0, lens.width, high)), quick=quick),
        "at": camera.at,
        "anchor": camera.anchor,
        "scale": camera.scale,
        "stretch": 1.0,
        "unit": view.unit,
        "least": view.min_radius,
    }


def _camera_of(view: View[Any], tall: int) -> dict[str, Any]:
    """The camera of a picture of so many rows, and the sizes of what is drawn on it, in px."""
    camera = view.camera
    too_large = max(0.0, balls.mark_radius(view.rows) - view.radius * camera.scale)
    return {
        "size": (view.size[0], tall),
        "at": camera.at,
        "anchor": camera.anchor,
        "scale": camera.scale,
        "stretch": camera.stretch,
        "unit": view.unit,
        "least": view.min_radius,
        "lift": too_large if isinstance(view, SideView) and not isinf(view.MAX_STRETCH) else None,
    }


def place_data(view: View[Any]) -> dict[str, Any]:
    """Return what a page needs of a place besides its layouts: looks, light, ground, colours, ladders of units."""
    return {
        "looks": [_look(look, view) for look in _looks(view)],
        "light": {
            "towards": (balls.LIGHT / np.linalg.norm(balls.LIGHT)).tolist(),
            "dark": balls.DARK,
            "edge": balls.EDGE,
            "rim": balls.RIM,
        },
        "string": css(view.STRING_COLOUR),
        "ground": _ground(view),
        "arrow": {
            "velocity": VELOCITY_LENGTH,
            "force": FORCE_LENGTH,
            "shortest": SHORTEST,
            "colour": css(CARD["text"]),
        },
        "driver": {"colour": css(view.DRIVEN), "thinnest": THINNEST},
        "shadows": isinstance(view, AboveView),
        "spins": view.SPIN_NAMES,
        "ladders": {unit: _ladder(unit) for unit in _UNITS},
        "heaped": _HEAPED,
        "unsaid": NOT_WORTH_NOTING,
        "earlier": palette("trace")["earlier"],
        "rim": css(palette("trace")["rim"]),
        **{name: css(CARD[name]) for name in ("accent", "shadow", "quiet")},
        "card": css(CARD["background"]),
    }


def path_data(view: View[Any], run: SceneRun) -> dict[str, Any]:
    """Return the paths of a run, with what moves, as a page draws and plays them on a place."""
    scores = run.scene.controls.scores
    names, looks = view.balls, [id(look) for look in _looks(view)]
    return {
        "ball": view.ball,
        "balls": [
            {
                "name": name,
                "radius": view.radii[name],
                "colour": css(view.colour_of(name)),
                "thickness": view.thickness(name),
                "look": looks.index(id(view.looks[name])),
                "lying": view.initial_turn(name).tolist(),
                "rolls": view.rolls(name),
                "turned": _turned(view, name, run.duration),
                "caught": run.caught_at(name),
                "fall": _fall(view, name),
                "path": _path(run.arcs[name]),
            }
            for name in names
        ],
        "ghosts": [
            {
                "label": ghost.label,
                "radius": ghost.view.radius,
                "colour": css(ghost.colour if not view.on_dark else ghost.light),
                "light": css(ghost.light),
                "shift": ghost.shift,
                "path": _path(ghost.run.arcs[ghost.view.ball]),
                "told": ghost.view.story_end,
            }
            for ghost in view.ghosts
        ],
        "strings": [[names.index(name), *at] for name, at in view.strings],
        "driven": _driven(view, run),
        "shown": view.driven_moment,
        "events": [event.t for event in run.events[:_MOST_EVENTS]],
        "duration": max([run.duration, *(ghost.run.duration for ghost in view.ghosts)]),
        "told": view.story_end,
        "scored": bool(run.result.get(scores)) if scores else None,
    }


def story_data(view: View[Any]) -> dict[str, Any]:
    """Return the keyframes of the camera: times in s, the middle of what is seen in m, how many times larger it is than
    at first, and how much slower time is; none for one that stands still."""
    work = view.camerawork
    if work is None:
        return {"story": None}
    still = work.story.share == 0.0
    rows = [(t, x, y, 1.0 if still else larger, slower) for t, x, y, larger, slower in work.keyframes(_KEYS_A_SECOND)]
    keys = [[float(f"{value:.5g}") for value in row] for row in rows]
    return {"story": {"keys": keys, "after": work.goes_on}}


def event_rows(run: SceneRun) -> list[tuple[str, ...]]:
    """Return the events of a run in words: of each its time, then what happened."""
    several = len(run.setup.balls) > 1
    return [words_of(run, event, several) for event in run.events[:_MOST_EVENTS]]


def force_data(view: View[Any], run: SceneRun) -> dict[str, Any]:
    """Return the forces on the ball that is played, and how long their arrows are."""
    return {
        "forces": _forces(view, run),
        "longest": dict(zip(("fastest", "strongest"), view.vectors.longest, strict=True)),
    }


def _looks(view: View[Any]) -> list[balls.Look]:
    """The looks of all balls, each once."""
    return list({id(view.looks[name]): view.looks[name] for name in view.balls}.values())


def path_until(arcs: Path, until: float) -> dict[str, Any]:
    """Return the path of a ball until a time in s; at 0 s, where it begins."""
    return _path(Path([arc.until(until) for arc in arcs if arc.t0 <= until]))


def _path(arcs: Path) -> dict[str, Any]:
    """The arcs of a ball, each until the next begins where it does not say otherwise.

    Of the thousands of short steps in a heap and in contacts, whose last digits are not those of the physics, each
    coefficient is what it differs from the one before, in units of HEAPED.
    """
    rows, last = [], [0, 0, 0]
    for arc, end in zip(arcs, [*arcs.starts[1:], arcs[-1].t1], strict=True):
        curves, within = [list(arc.x), list(arc.y), list(arc.curves[4])], _within(arc)
        if within and isinstance(within[0], float):
            whole = [[round(value / _HEAPED) for value in curve] for curve in curves]
            curves = [np.diff([start, *curve]).tolist() for start, curve in zip(last, whole, strict=True)]
            last = [curve[-1] for curve in whole]
        else:
            last = [0, 0, 0]
        times = arc.t0 if arc.t1 == end else [arc.t0, arc.t1]
        rows.append([times, *curves, within])
        if arc.curves[5:]:
            rows[-1].append([list(curve) for curve in arc.curves[5:]])
    return {"arcs": rows, "until": arcs[-1].t1}


def _within(arc: Arc) -> Any:
    """Its velocity where it is not the derivative of its place, at an impact; else 0. In a heap and in contacts, what
    position correction adds to it, in m/s."""
    if arc.t1 <= arc.t0:
        return [[arc.start[2]], [arc.start[3]]]
    return [round(speed, 9) for speed in arc.drift] if arc.phase in (Phase.CLUSTER, Phase.HEAP) else 0


def _turned(view: View[Any], name: str, until: float) -> dict[str, Any] | None:
    """Angles in rad at some times in s of what turns in a way of its own; None for what turns by its spin."""
    if type(view).turn is View.turn:
        return None
    times = np.linspace(0.0, until, SAMPLES)
    turns = [view.turn(name, float(t)) for t in times]
    return {"times": times, "angles": np.unwrap([atan2(turn[1, 0], turn[0, 0]) for turn in turns])}


def _driven(view: View[Any], run: SceneRun) -> dict[str, Any]:
    """The surfaces that move, at even times often enough for straight lines between them: the ends of each in m, or
    twice its middle."""
    times = np.linspace(0.0, run.duration, max(2, round(run.duration * _POSES_A_SECOND)))

    def ends(surface: Surface, t: float) -> list[float]:
        a, b = surface.at(t).shape.ends
        return [*a, *b]

    surfaces = [
        {"radius": each.shape.radius, "ends": [[round(x, 6) for x in ends(each, float(t))] for t in times]}
        for each in view.driven
    ]
    return {"step": times[1], "surfaces": surfaces}


def _fall(view: View[Any], name: str) -> dict[str, Any] | None:
    """Return the fall of a ball that begins standing: from when in s, where to, its look then; None for others."""
    fall = view.fall_of(name)
    return fall and fall._asdict() | {"shapes": [[corners, css(colour)] for corners, colour in fall.shapes]}


def _look(look: balls.Look, view: View[Any]) -> dict[str, Any]:
    """Return the shapes of a flat thing, or the two halves of a ball's skin next to each other, as large as needed."""
    if isinstance(look, balls.Silhouette):
        shapes = [[np.asarray(corners), css(colour)] for corners, colour in look.shapes]
        return {"shapes": shapes, "rimmed": look.rimmed}
    radius = max(view.min_radius, view.radius * view.camera.scale)
    halves = look.skin(sum(radius >= mark.least for mark in look.marks))  # by half, column, row
    skin = np.concatenate(list(halves), axis=0).transpose(1, 0, 2)
    return {"skin": picture(Image.fromarray(np.ascontiguousarray(skin)), exact=True), "face": balls.FACE,
            "gloss": look.gloss}  # fmt: skip


def _ground(view: View[Any]) -> dict[str, Any] | None:
    """Heights in m at even places; None in a view from above."""
    if not isinstance(view, SideView):
        return None
    margin = 0.1 * float(np.ptp(view.points[:, 0])) + view.radius
    places = np.linspace(view.points[:, 0].min() - margin, view.points[:, 0].max() + margin, GROUND)
    heights = view.ground(places)
    if np.ptp(heights) == 0.0:
        places, heights = places[[0, -1]], heights[[0, -1]]
    return {"from": places[0], "step": places[1] - places[0], "heights": heights.tolist()}


def _forces(view: View[Any], run: SceneRun) -> dict[str, Any]:
    """The components of each force in N at some times in s, None where it does not act."""
    until = min(run.duration, run.caught_at(view.ball) or run.duration)
    times = [float(t) for t in instants(run, SAMPLES, [view.ball]) if t <= until]
    causes = [
        {"name": name, "colour": css(colour_of(name))}
        | {axis: [None if isnan(part) else float(f"{part:.6g}") for part in force[:, i]] for i, axis in enumerate("xy")}
        for name, force in view.vectors.over(times).items()
    ]
    return {"times": times, "causes": causes}


def _ladder(unit: str) -> list[list[Any]]:
    """Return the steps by which numbers of a unit are written: the least size, the factor, unit and digits."""
    steps = ladder(unit) or DISPLAY_UNITS["m"][-1:]
    return [[step.least, convert(1.0, unit, step.unit), step.unit, step.digits] for step in steps]
