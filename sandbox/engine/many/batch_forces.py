"""Forces on many shots, computed with arrays, and a check that this gives what they return for floats."""

from __future__ import annotations

from typing import Any

import numpy as np

from sandbox.engine.many.in_flight import InFlight
from sandbox.engine.many.stacking import Stack
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.tolerances import ROUNDING
from sandbox.engine.motion.forces_on_ball import acceleration_function, by_cause, cause
from sandbox.physics.integrators import AccelerationFunction


class NotVectorizable(Exception):
    """Forces that cannot take arrays, or that return other values for arrays than for floats."""


def raise_if_ctrl_c(error: BaseException) -> None:
    """Raise Ctrl-C again. Whatever else a scene's own function raises is a failure of its shot, which runs alone."""
    if isinstance(error, KeyboardInterrupt):
        raise error


def accelerations(acceleration_at: AccelerationFunction, t: np.ndarray, state: np.ndarray) -> Any:
    """The rows ax, ay (m/s^2) and alpha (rad/s^2) of all shots. Raises NotVectorizable for what is not a real number of
    each shot, or of all."""
    for array in (t := t.view(), state := state.view()):
        array.flags.writeable = False  # ``vx -= wind`` in a force leaves a float as it was, but not an array
    found = np.empty((3, len(t)))
    try:
        for row, part in zip(found, acceleration_at(t, tuple(state)), strict=True):
            np.copyto(row, part)
    except BaseException as error:  # such as complex numbers, or arrays of the wrong shape
        raise_if_ctrl_c(error)
        raise NotVectorizable from error
    return found


def why_alone(setup: Setup) -> str:
    """Return why shots of this kind run one by one, as a line that names the force or torque that does not take arrays;
    "" if all take them, or there is another reason."""
    if not setup.is_single_ball:
        return ""
    ball = setup.balls[0]
    t, state = np.array([0.0, 0.5 * setup.duration]), np.array([[part, part] for part in setup.start_of(ball)], float)
    arguments = (state[0], state[1]), (state[2], state[3]), state[4]
    for term in (*ball.forces, *ball.torques):
        try:
            each = [term(float(at), *(_of(part, i) for part in arguments)) for i, at in enumerate(t)]
        except Exception:
            return ""  # each run reports it
        try:
            together = np.array([np.broadcast_to(part, 2) for part in _several(term(t, *arguments))]).T
            if np.allclose(together, np.array([_several(one) for one in each]), ROUNDING, 0.0):
                continue
            said = "returns other values for them"
        except Exception as error:
            said = " ".join(f"{error}".split())
        return f"{cause(term)} does not take arrays ({said:.80}), so its shots ran one by one"
    return ""


def _of(part: Any, place: int) -> Any:
    """Return the float, or the pair of floats, of one shot."""
    return tuple(float(each[place]) for each in part) if isinstance(part, tuple) else float(part[place])


def _several(found: Any) -> tuple[Any, ...]:
    """Return a force's components, or a torque."""
    return tuple(found) if isinstance(found, tuple | list) else (found,)


def check_forces(setups: Stack, flying: InFlight, lanes: np.ndarray, together: np.ndarray) -> None:
    """Raise NotVectorizable if the accelerations of these lanes, computed ``together`` with arrays, differ from those
    computed with floats, as if a force mixes up shots. If they are not numbers, the shot run alone reports why."""
    for lane in lanes.tolist():
        ball, state = setups[flying.shot[lane]].balls[0], tuple(flying.state[:, lane].tolist())
        try:
            alone = acceleration_function(ball)(t := float(flying.t[lane]), state)
            error = max(abs(one - other) for one, other in zip(together[:, lane].tolist(), alone, strict=True))
            if error > ROUNDING * sum(map(abs, alone)):  # they may cancel
                size = sum(abs(fx) + abs(fy) for _, (fx, fy) in by_cause(ball.forces, t, state)) / ball.mass
                if error > ROUNDING * (size + abs(alone[2])):
                    raise NotVectorizable
        except BaseException as error:
            raise_if_ctrl_c(error)
            raise NotVectorizable from error
