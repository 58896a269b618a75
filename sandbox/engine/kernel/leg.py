"""Flight of one ball among fixed surfaces by numbers alone: steps, touches and impacts, until something else happens.

It is what ``flight.py`` does with objects: the step, its control, the arc, the touch, the laws of force and bounce are
the same functions. Setups are rows of numbers (``rows.py``), tuples or arrays, and what happens is written into rows:
both Python and numba take it (``building.py``). The impulses are pymunk's, in closed form (``physics/impulse.py``).
"""

from __future__ import annotations

from collections.abc import Sequence
from math import inf
from typing import Any

from sandbox.engine.contact.fixed_touch import first_touch_of_quintics, nearest
from sandbox.engine.contact.surfaces import press, takeoff_speed, tilted
from sandbox.engine.kernel import laws
from sandbox.engine.kernel.laws import BALL_RADIUS, FACTOR, MASS, Row
from sandbox.engine.kernel.step_control import allowed_near, judged, not_too_long, shortest, size_of_ball
from sandbox.engine.model.setup import passes
from sandbox.engine.model.tolerances import CLOSING, CREATED, FLUSH, TOUCHING_GAP
from sandbox.engine.paths.arc import curves_between
from sandbox.engine.paths.quintic import first_of_cubic, first_of_quartic, first_part
from sandbox.physics.dormand_prince import step_of
from sandbox.physics.elementwise import of_floats
from sandbox.physics.impulse import after_plane_impulse, exchange, plane_speeds

#: Why a leg ends: the run is over, by its duration or its condition; the ball touches what is to be resolved elsewhere,
#: before the impact; it has had an impact, after which it may stay on what it hit, or its run may be over; its next
#: step is an error; it has passed the line that may end its run; there is no room for more rows.
DURATION, UNTIL, BEFORE_IMPACT, AFTER_IMPACT, ERROR, PASSED, _FULL = range(7)

#: Places in the row of a surface: the shape's as in ``fixed_touch.py``, its box, and how it responds: the height of
#: its lowest bounce in m, its kick in N s, its contact law with four numbers.
_LEFT, _BOTTOM, _RIGHT, _TOP, LOWEST, KICK, LAW, _LAW_A, _LAW_B, _LAW_C, _LAW_D = range(8, 19)
SURFACE_COLUMNS = _LAW_D + 1

#: Code of a contact law that is asked elsewhere: an impact on it ends the leg before.
ASKED = -1

#: Most arcs of one leg: a ball that bounces on and on is followed elsewhere, which notices it.
_MOST_ARCS = 5_000

#: Places in the row of a rule (``model/setup.py``); then a number for each surface, 1 for those it is about.
_TIMES, _FASTEST, _RULE_LEFT, _RULE_RIGHT, AFTER, FIRST_SURFACE = range(6)

#: Places in the row of limits: of the local error in m, its exponent, lowest bounce and skin in m, duration in s, the
#: world's edges in m, 1 if every impact ends a leg, and the ends of a line in m that may end the run: equal for none.
_LOCAL_ERROR, _EXPONENT, _SETTLE, _SKIN, _LAST, _WEST, _SOUTH, _EAST, _NORTH, _STOPS, _A, _B, _C, _D = range(14)
LIMIT_COLUMNS = _D + 1

#: Places in the row of a shot, before and after a leg: time in s, state, step to try next in s.
T, X, Y, VX, VY, SPIN, STEP = range(7)
#: After it also: why it ended, the surface it is on, with its normal and the curvature in 1/m; steps, refined steps,
#: impacts and queries; how many rows of arcs and events there are up to here, of all shots.
WHY, MET, NX, _NY, CURVATURE, STEPS, REFINED, IMPACTS, QUERIES, ARCS, EVENTS = range(7, 18)
SHOT_COLUMNS = EVENTS + 1

#: Columns of a row of an arc, as in ``many/arc_rows.py``.
ARC_COLUMNS = 39

#: Columns of a row of an event: time in s, surface, speed in m/s, x and y in m.
EVENT_COLUMNS = 5

_acceleration: Any = laws.acceleration
_step: Any = step_of(_acceleration, False)
_curves_between, _exchange, _tilted = of_floats(curves_between), of_floats(exchange), of_floats(tilted)
_press, _takeoff_speed, _passes = of_floats(press), of_floats(takeoff_speed), of_floats(passes)


def fly(
    shot: Row,
    ball: Row,
    forces: Sequence[Row],
    surfaces: Sequence[Row],
    regions: Sequence[Any],
    rules: Sequence[Row],
    counted: Any,
    limits: Row,
    arcs: Any,
    arc: int,
    events: Any,
    event: int,
) -> tuple[float, ...]:
    """Fly a shot from where it is to the end of its leg. ``counted`` has for each rule the impacts so far; arcs and
    events are written into their rows from places ``arc`` and ``event`` on. Returns the shot's row."""
    radius, factor, mass = ball[BALL_RADIUS], ball[FACTOR], ball[MASS]
    local, exponent, settle = limits[_LOCAL_ERROR], limits[_EXPONENT], limits[_SETTLE]
    skin, duration = limits[_SKIN], limits[_LAST]
    west, south, east, north = limits[_WEST], limits[_SOUTH], limits[_EAST], limits[_NORTH]
    t, state, following = shot[T], (shot[X], shot[Y], shot[VX], shot[VY], shot[SPIN]), shot[STEP]
    known = laws.acceleration(t, state, ball, forces)
    met, nx, ny, curvature = -1, 0.0, 0.0, 0.0
    steps, refined, impacts, queries = 0, 0, 0, 0
    while True:
        why = ERROR
        if arc + 2 > len(arcs) or event >= len(events):
            why = _FULL
            break
        if steps >= _MOST_ARCS:
            break
        # a step
        wanted = following
        h = not_too_long(t, min(wanted, duration - t), state, known)
        h = allowed_near(regions, h, state, known)
        while True:
            end, last, error = _step(t, state, known, h, ball, forces)
            steps += 1
            fits, following = judged(size_of_ball(error, radius), local, exponent, h, wanted)
            if fits or following < shortest(t):
                break
            refined += 1
            h = wanted = following
        motion = end[2] + end[3] + end[4]
        if not (fits and west <= end[0] <= east and south <= end[1] <= north and motion - motion == 0.0):
            following = h
            break
        # its arc, up to the first touch
        xs, ys, vxs, vys, spins = _curves_between(h, state, known, end, last)
        left, bottom, right, top, u = min(xs), min(ys), max(xs), max(ys), inf
        for i in range(len(surfaces)):
            surface = surfaces[i]
            if (
                right >= surface[_LEFT]
                and left <= surface[_RIGHT]
                and bottom <= surface[_TOP]
                and top >= surface[_BOTTOM]
            ):
                queries += 1
                u = min(u, first_touch_of_quintics(surface, xs, ys, skin))
        t0, start, t = t, state, t + h
        if u < inf:
            t = t0 + u * h
            following = min(following, h)
            xs, ys = first_part(xs, u), first_part(ys, u)
            vxs, vys, spins = first_of_quartic(vxs, u), first_of_quartic(vys, u), first_of_cubic(spins, u)
            end = (xs[5], ys[5], vxs[4], vys[4], spins[3])
        arcs[arc] = (t0, t) + start + xs + ys + vxs + vys + spins + end + (-1.0,)  # noqa: RUF005, numba takes it
        arc += 1
        state = end
        if u == inf:
            known = last
            if t >= duration:
                why = DURATION
                break
            if _passes(start[0], start[1], end[0], end[1], limits[_A], limits[_B], limits[_C], limits[_D]):
                why = PASSED
                break
            continue
        # the impact
        x, y, vx, vy, spin = state
        count, met, nx, ny, curvature = 0, -1, 0.0, 0.0, 0.0
        for i in range(len(surfaces)):
            surface = surfaces[i]
            if surface[_LEFT] <= x <= surface[_RIGHT] and surface[_BOTTOM] <= y <= surface[_TOP]:
                gap, mx, my, bent = nearest(surface, x, y)
                if gap <= TOUCHING_GAP:
                    if met < 0:
                        count, met, nx, ny, curvature = 1, i, mx, my, bent
                    elif mx * nx + my * ny <= FLUSH:
                        count += 1
        why = BEFORE_IMPACT
        approach, along = -(vx * nx + vy * ny), vx * ny - vy * nx
        surface = surfaces[met]
        if count != 1 or approach <= CLOSING or surface[LAW] == ASKED:
            break
        restitution, friction, tilt, tangential = laws.bounce(
            surface[LAW], approach, abs(along), surface[_LAW_A], surface[_LAW_B], surface[_LAW_C], surface[_LAW_D]
        )
        within = 0.0 <= restitution <= 1.0 and 0.0 <= friction < inf and 0.0 <= tangential <= 1.0
        if not within or tilt - tilt != 0.0:
            break  # an error
        tx, ty = nx, ny
        if tilt != 0.0:
            tx, ty = _tilted(nx, ny, tilt, along)
        closing, slip = plane_speeds(vx, vy, spin, tx, ty, radius)
        push, rub = _exchange(closing, (1.0 + tangential) * slip, factor, restitution, friction)
        push = push + surface[KICK] / mass
        ux, uy, turns = after_plane_impulse(vx, vy, spin, tx, ty, radius, factor, push, rub)
        if surface[KICK] == 0.0:
            before = vx * vx + vy * vy + factor * (radius * spin) * (radius * spin)
            if ux * ux + uy * uy + factor * (radius * turns) * (radius * turns) > (1.0 + CREATED) * before:
                break  # an error
        vx, vy, spin = ux, uy, turns
        impacts += 1
        events[event] = (t, float(met), approach, x, y)
        event += 1
        state = (x, y, vx, vy, spin)
        if _is_over(rules, counted, met, t, approach, x):
            arcs[arc] = _resting(t, x, y, spin, state)
            arc += 1
            why = UNTIL
            break
        known = laws.acceleration(t, state, ball, forces)
        pressed = _press(state, known, nx, ny, curvature)
        why = AFTER_IMPACT
        if limits[_STOPS] != 0.0 or vx * nx + vy * ny <= _takeoff_speed(pressed, max(settle, surface[LOWEST])):
            break
        if t >= duration:
            why = DURATION
            break
    counts = float(steps), float(refined), float(impacts), float(queries), float(arc), float(event)
    return (t,) + state + (following, float(why), float(met), nx, ny, curvature) + counts  # noqa: RUF005


def _is_over(rules: Sequence[Row], counted: Any, met: int, t: float, speed: float, x: float) -> bool:
    """Count an impact, at this time (s) and place (m), with this speed (m/s), for the rules it is about. Returns True
    if one of them ends the run."""
    over = False
    for i in range(len(rules)):
        rule = rules[i]
        where = t > rule[AFTER] and speed <= rule[_FASTEST] and not rule[_RULE_LEFT] < x < rule[_RULE_RIGHT]
        if where and rule[FIRST_SURFACE + met] != 0.0:
            counted[i] += 1.0
            over = over or counted[i] >= rule[_TIMES]
    return over


def _resting(t: float, x: float, y: float, spin: float, state: tuple[float, ...]) -> tuple[float, ...]:
    """The row of an arc without duration: the last state."""
    still = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    xs, ys, spins = (x, x, x, x, x, x), (y, y, y, y, y, y), (spin, spin, spin, spin)
    return (t, t) + state + xs + ys + still + spins + state + (-1.0,)  # noqa: RUF005


def fly_all(
    first: int,
    shots: Sequence[Row],
    balls: Sequence[Row],
    forces: Sequence[Sequence[Row]],
    surfaces: Sequence[Sequence[Row]],
    regions: Sequence[Sequence[Any]],
    rules: Sequence[Sequence[Row]],
    counted: Any,
    limits: Sequence[Row],
    arcs: Any,
    events: Any,
    found: Any,
) -> int:
    """Fly shots from the ``first`` on, one after another, into the rows ``found``. A table with one entry holds for
    all. Returns the first shot for which there was no room, or how many there are."""
    arc, event = 0, 0
    for i in range(first, len(shots)):
        row = fly(
            shots[i],
            balls[i if len(balls) > 1 else 0],
            forces[i if len(forces) > 1 else 0],
            surfaces[i if len(surfaces) > 1 else 0],
            regions[i if len(regions) > 1 else 0],
            rules[i if len(rules) > 1 else 0],
            counted[i],
            limits[i if len(limits) > 1 else 0],
            arcs,
            arc,
            events,
            event,
        )
        if row[WHY] == _FULL:
            return i
        found[i] = row
        arc, event = int(row[ARCS]), int(row[EVENTS])
    return len(shots)
