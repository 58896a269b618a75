"""Sustained contact of many shots: each slides or rolls on a straight side of one surface."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from sandbox.engine.contact.surfaces import press, takeoff_speed
from sandbox.engine.contact.touch import SIDE
from sandbox.engine.many.arc_rows import CURVES, END, T1, resting_columns
from sandbox.engine.many.batch_forces import accelerations, raise_if_ctrl_c
from sandbox.engine.many.batch_record import QUERIES, BatchRecord
from sandbox.engine.many.bernstein_many import elevated, first_downward_crossing
from sandbox.engine.many.continuation import ExitReason
from sandbox.engine.many.in_flight import InFlight
from sandbox.engine.many.outlines import BatchSurfaces
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.event import Event
from sandbox.engine.model.setup import is_over
from sandbox.engine.model.tolerances import SEAM
from sandbox.engine.motion.forces_on_ball import acceleration_function
from sandbox.engine.motion.sustained_contact import BECOMES, SustainedContact, motion_on
from sandbox.engine.paths.phase import Phase


class _Held(NamedTuple):
    """Shots that slide, or that roll."""

    lanes: np.ndarray
    ball: Ball
    contact: SustainedContact


class _NextMotion(NamedTuple):
    """The motion of shots that have met a surface, or whose slide or roll has ended: masks, and arrays."""

    shots: np.ndarray
    surface: np.ndarray  # that they have met, or that they are on
    hit: np.ndarray  # it has just met it
    held: np.ndarray  # it was on it already
    flies: np.ndarray
    holds: np.ndarray  # it slides or rolls
    rests: np.ndarray
    state: np.ndarray  # without speed away from the surface
    phase: np.ndarray
    direction: np.ndarray


class BatchContacts:
    """The shots of a batch that slide or roll. What does so elsewhere than within a straight side is to be continued
    alone."""

    def __init__(self, flying: InFlight, outlines: BatchSurfaces, record: BatchRecord, bounce_height: float) -> None:
        """A bounce that is lower than ``bounce_height`` (m) counts as sustained contact."""
        self._flying = flying
        self._outlines = outlines
        self._record = record
        self._bounce_height = bounce_height
        self._held: list[_Held] = []

    @property
    def any_held(self) -> bool:
        """True if some shots slide or roll."""
        return bool(self._held)

    # ------------------------------------------------------------------ during contact

    def hold(self) -> None:
        """Find the shots that slide or roll now, and place them exactly on their surfaces."""
        flying = self._flying
        phases = set(flying.phase[flying.surface >= 0].tolist())
        self._held = [self._held_in(flying.phase == phase, phase) for phase in Phase if phase in phases]

    def _held_in(self, mask: np.ndarray, phase: Phase) -> _Held:
        """The shots of this mask, projected onto their surfaces in this phase of motion."""
        flying = self._flying
        lanes = mask.nonzero()[0]
        shots, state = flying.shot[lanes], tuple(flying.state[:, lanes])
        obstacles, ball = self._outlines.of(flying.surface[lanes], shots), flying.ball_of(shots)
        contact = SustainedContact(phase, obstacles, obstacles.on_feature(SIDE, *state[:2]), flying.direction[lanes])
        for row, part in zip(flying.state, contact.projected_onto_surface(ball, state), strict=True):
            row[lanes] = part
        return _Held(lanes, ball, contact)

    def acceleration_at(self, t: np.ndarray, state: Any) -> Any:
        """The accelerations of all shots, in flight and in contact."""
        found = accelerations(self._flying.acceleration_at, t, state)
        for lanes, ball, contact in self._held:
            found[:, lanes] = contact.forces(ball, found[:, lanes], state[:, lanes])[0]
        return found

    def changes(self, rows: np.ndarray, accepted: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return, for these arcs of shots whose step is ``accepted``, the u at which slip or speed ends, inf if it does
        not; and a mask of those that stay on their surface until then, as far as can be told here."""
        changes, lasts = np.full(rows.shape[1], np.inf), np.ones(rows.shape[1], dtype=bool)
        if not (self._held and accepted.any()):
            return changes, lasts
        place = accepted.cumsum() - 1
        for lanes, ball, contact in self._held:
            here = rows[:, place[lanes]]
            x, y, vx, vy, spin = (here[part] for part in CURVES)
            end: Any = here[END]
            applied = accelerations(acceleration_function(ball, floats=False), here[T1], end)
            _, normal, grip_margin = contact.forces(ball, applied, end)
            progress = contact.progress(ball, (x, y, vx, vy, elevated(spin, len(vx) - 1)))
            u, unclear = first_downward_crossing(progress)
            ends = progress[-1] < 0.0
            side = contact.obstacle.outline
            along = side.along(x, y)
            inside = (along.min(axis=0) > 0.0) & (along.max(axis=0) < side.length)
            stays = inside & (normal >= 0.0) & (grip_margin >= 0.0) & ~(ends & (unclear | ~np.isfinite(u)))
            some = accepted[lanes]
            changes[place[lanes[some]]] = np.where(ends, u, np.inf)[some]
            lasts[place[lanes[some]]] = stays[some]
        return changes, lasts

    def end_motions(self, lanes: np.ndarray, ended: np.ndarray) -> None:
        """Make shots of these lanes exactly rolling, or at rest, where their slide or roll has ``ended`` (a mask)."""
        flying = self._flying
        if self._held:
            flying.motion_ended[lanes] = ended
            for held in self._held:
                some = flying.motion_ended & (flying.phase == held.contact.phase)
                if some.any():
                    self._held_in(some, BECOMES[held.contact.phase])

    # ------------------------------------------------------------------ where contact begins or changes

    def find_next_motions(self, acceleration: np.ndarray) -> None:
        """Let shots that have met a surface, or whose slide or roll has ended, fly on, or slide, roll or rest."""
        flying = self._flying
        lanes = ((flying.met >= 0) | flying.motion_ended).nonzero()[0]
        if not len(lanes):
            return
        found = self._next_motion(lanes, acceleration)
        flying.met[lanes], flying.motion_ended[lanes] = -1, False
        flying.surface[lanes] = np.where(found.flies, -1, found.surface)
        flying.phase[lanes[found.flies]] = Phase.FREE
        alone = np.where(found.hit, ExitReason.AFTER_IMPACT, ExitReason.CONTACT_CHANGE)
        flying.exit[lanes[~found.flies]] = alone[~found.flies]  # unless it is clear, below, how it goes on
        here = lanes[found.holds]
        flying.state[:, here], flying.phase[here] = found.state[:, found.holds], found.phase[found.holds]
        flying.direction[here] = found.direction[found.holds]
        self._note(lanes, found)

    def _next_motion(self, lanes: np.ndarray, acceleration: np.ndarray) -> _NextMotion:
        """Return how these lanes go on, with the accelerations (m/s^2, rad/s^2) that they would have in flight."""
        flying = self._flying
        hit, held, shots = flying.met[lanes] >= 0, flying.surface[lanes] >= 0, flying.shot[lanes]
        surface = np.where(held, flying.surface[lanes], flying.met[lanes])
        (x, y, vx, vy, spin), applied = flying.state[:, lanes], tuple(acceleration[:, lanes])
        obstacles, (nx, ny, curvature) = self._outlines.of(surface, shots), flying.normal[:, lanes]
        if held.any():
            nx, ny, curvature = np.where(held, obstacles.near(x, y)[1:4], flying.normal[:, lanes])
        pressed = press((x, y, vx, vy, spin), applied, nx, ny, curvature)
        away = vx * nx + vy * ny
        stays = away <= takeoff_speed(pressed, np.maximum(self._bounce_height, obstacles.surface.lowest_bounce))
        clear = ~(hit & held)
        if not clear.all():
            most = abs(applied[0]) + abs(applied[1]) + obstacles.surface.friction * pressed
            clear |= self._leaves(lanes, most)
        flies = hit & ~stays & clear
        state, none = np.array((x, y, vx - away * nx, vy - away * ny, spin)), np.zeros(len(lanes), dtype=bool)
        if flies.all():
            return _NextMotion(shots, surface, hit, held, flies, none, none, state, none, none)
        phase, direction = motion_on(
            flying.ball_of(shots), tuple(state), obstacles.surface, obstacles.near(x, y), applied
        )
        along = obstacles.outline.along(x, y)
        inside = clear & stays & (along > SEAM) & (along < obstacles.outline.length - SEAM)
        holds = inside & ((phase == Phase.SLIDING) | (phase == Phase.ROLLING))
        waits = flying.setup.balls[0].timing.depends  # a rest that may end is followed alone
        rests = inside & ~hit & (phase == Phase.RESTING) & (not waits)
        return _NextMotion(shots, surface, hit, held, flies, holds, rests, state, phase, direction)

    def _leaves(self, lanes: np.ndarray, most: np.ndarray) -> np.ndarray:
        """A mask of the shots that leave what they have met, on which no more than this presses them, in m/s^2."""
        flying = self._flying
        (x, y, vx, vy, _), met = flying.state[:, lanes], self._outlines.of(flying.met[lanes], flying.shot[lanes])
        near, height = met.near(x, y), np.maximum(self._bounce_height, met.surface.lowest_bounce)
        leaves: np.ndarray = vx * near.nx + vy * near.ny > takeoff_speed(most, height)
        return leaves

    def _note(self, lanes: np.ndarray, found: _NextMotion) -> None:
        """Note what is clear to become of these lanes, as events and contacts."""
        flying, record = self._flying, self._record
        some = (found.flies | found.holds | found.rests).nonzero()[0]
        arrays = (lanes, found.shots, found.surface, found.hit, found.held, found.flies, found.rests)
        for i, lane, shot, surface, hit, held, flies, rests in zip(
            some.tolist(), *(array[some].tolist() for array in arrays), strict=True
        ):
            what = "rest" if rests else "" if flies != held else "leave" if flies else "contact"
            reason = flying.exit[lane] = self._note_event(lane, what, surface, hit)
            if reason in (ExitReason.AFTER_IMPACT, ExitReason.CONTACT_CHANGE):
                continue  # run alone, the shot raises the error
            flying.contact[lane] = -1 if flies else len(record.contacts)
            if not flies:
                obstacle = self._outlines.obstacle(surface, shot)
                side = obstacle.on_feature(SIDE, float(found.state[0, i]), float(found.state[1, i]))
                contact = SustainedContact(found.phase[i], obstacle, side, float(found.direction[i]))
                record.contacts.append(contact)
        if found.rests.any():
            shots, (x, y) = found.shots[found.rests], found.state[:2, None, found.rests]
            near = self._outlines.in_reach(shots, x, y, found.surface[found.rests])
            record.counts[QUERIES, shots] += near.sum(axis=0)
        over = lanes[found.rests | (flying.exit[lanes] == ExitReason.UNTIL)]
        if len(over):  # the last state is included, though no arc follows
            record.add_arcs(flying.shot[over], resting_columns(flying.t[over], flying.state[:, over]))

    def _note_event(self, lane: int, what: str, surface: int, hit: bool) -> ExitReason:
        """Note what becomes of a shot on a surface, if ``what`` is an event, after an impact there if it ``hit`` it.
        Returns why it leaves the batch now."""
        shot = self._flying.shot[lane]
        until, events = self._record.setups.part("until", shot), self._record.events[shot]
        noted = len(events)
        try:
            over = hit and bool(events) and is_over(until, events)
            if what:
                ball, *surfaces = self._record.names
                at = self._flying.state[:2, lane].tolist()
                events.append(Event(float(self._flying.t[lane]), what, ball, surfaces[surface], 0.0, *at))
                over = is_over(until, events) or over
        except BaseException as error:
            raise_if_ctrl_c(error)
            del events[noted:]
            return ExitReason.AFTER_IMPACT if hit else ExitReason.CONTACT_CHANGE
        return ExitReason.UNTIL if over else ExitReason.REST if what == "rest" else ExitReason.NONE
