"""Compiled motion models of rollouts: commands to velocities, within the limits.

Every model advances many samples by one step: ``state`` (4, n) has their velocities,
and the other arrays (n,) their commands, which are limited in place; all float32.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel

Array32 = NDArray[np.float32]

DIFFERENTIAL, ACKERMANN, OMNI = 0, 1, 2
"""Codes of the drives, in the order of :data:`navette.geometry.DRIVES`."""

FORWARD, SIDE, TURN_RATE, CURVATURE = 0, 1, 2, 3
"""Rows of velocities (4, n): forward and to the left (m/s), turn rate (rad/s), and the
curvature (1/m) to which an Ackermann drive steers."""


class DriveLimits(NamedTuple):
    """Limits of a drive in float32; m, s, rad.

    ``max_curvature`` and ``curvature_rate`` are those of Ackermann steering,
    ``max_side_speed`` that of an omnidirectional drive.
    """

    max_speed: float
    max_reverse: float
    max_turn_rate: float
    acceleration: float
    deceleration: float
    turn_acceleration: float
    lateral_acceleration: float
    max_curvature: float
    curvature_rate: float
    max_side_speed: float


@kernel(fastmath=True)
def advance_differential(
    limits: DriveLimits,
    step_s: float,
    speeds: Array32,
    turns: Array32,
    state: Array32,
) -> None:
    """Accelerate towards the commanded speeds and turn rates."""
    forward, turn_rate = state[FORWARD], state[TURN_RATE]
    _ramp(speeds, forward, -limits.max_reverse, limits.max_speed,
          limits.acceleration * step_s, limits.deceleration * step_s)  # fmt: skip
    _approach(turns, turn_rate, limits.max_turn_rate,
              limits.turn_acceleration * step_s)  # fmt: skip
    most = limits.lateral_acceleration
    for i in range(forward.size):
        rate = abs(turn_rate[i])
        if abs(forward[i]) * rate > most:
            forward[i] = math.copysign(most / rate, forward[i])
        speeds[i] = forward[i]


@kernel(fastmath=True)
def advance_ackermann(
    limits: DriveLimits,
    step_s: float,
    speeds: Array32,
    bends: Array32,
    state: Array32,
) -> None:
    """Accelerate towards the speeds and steer towards the curvatures ``bends``."""
    forward, curvature = state[FORWARD], state[CURVATURE]
    turn_rate = state[TURN_RATE]
    _ramp(speeds, forward, -limits.max_reverse, limits.max_speed,
          limits.acceleration * step_s, limits.deceleration * step_s)  # fmt: skip
    _approach(bends, curvature, limits.max_curvature,
              limits.curvature_rate * step_s)  # fmt: skip
    most = limits.lateral_acceleration
    for i in range(forward.size):
        bend = abs(curvature[i])
        if forward[i] * forward[i] * bend > most:
            forward[i] = math.copysign(math.sqrt(most / bend), forward[i])
        speeds[i] = forward[i]
        turn_rate[i] = forward[i] * curvature[i]


@kernel(fastmath=True)
def advance_omni(
    limits: DriveLimits,
    step_s: float,
    speeds: Array32,
    sides: Array32,
    turns: Array32,
    state: Array32,
) -> None:
    """Accelerate towards the speeds forward and to the left and the turn rates.

    The speed in any direction is at most the one forward.
    """
    up, down = limits.acceleration * step_s, limits.deceleration * step_s
    _ramp(speeds, state[FORWARD], -limits.max_reverse, limits.max_speed, up, down)
    _ramp(sides, state[SIDE], -limits.max_side_speed, limits.max_side_speed, up, down)
    forward, side = state[FORWARD], state[SIDE]
    most = limits.max_speed
    for i in range(forward.size):
        squared = forward[i] * forward[i] + side[i] * side[i]
        share = most / math.sqrt(squared) if squared > most * most else np.float32(1.0)
        forward[i] *= share
        side[i] *= share
        speeds[i], sides[i] = forward[i], side[i]
    _approach(turns, state[TURN_RATE], limits.max_turn_rate,
              limits.turn_acceleration * step_s)  # fmt: skip


@kernel(fastmath=True)
def _ramp(
    wanted: Array32,
    state: Array32,
    low: float,
    high: float,
    up: float,
    down: float,
) -> None:
    """Change a speed by at most ``up`` when it grows and ``down`` when it falls."""
    for i in range(state.size):
        before = state[i]
        to = min(high, max(low, wanted[i]))
        slower = to * before < np.float32(0.0) or abs(to) < abs(before)
        change = down if slower else up
        state[i] = before + min(change, max(-change, to - before))
        wanted[i] = state[i]


@kernel(fastmath=True)
def _approach(wanted: Array32, state: Array32, most: float, change: float) -> None:
    """Change a value within ± ``most`` by at most ``change``."""
    for i in range(state.size):
        before = state[i]
        to = min(most, max(-most, wanted[i]))
        state[i] = before + min(change, max(-change, to - before))
        wanted[i] = state[i]
