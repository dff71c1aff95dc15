# SPDX-License-Identifier: Apache-2.0
"""Parameters of planning and control that follow from the kind of a drive."""

import math

from navette.geometry import ACKERMANN, OMNI
from navette.sim.params import SimParams
from navette.sim.scene import AckermannDrive, DiffDrive, MecanumDrive

_Values = dict[str, dict[str, object]]

# The racecar's reserves: at full lock a car could not correct an error of its path, so
# that the planner's bends are wider; control uses nearly all of the steering.
_PLANNED_RADIUS = 1.12
_DRIVEN_RADIUS = 1.01
_STEERING_LAG = 1.15  # of the servo, over the time that its rate gives
_SIDE_SHARE = 0.6  # of the speed forward, as for the platform in the package


def full_lock_radius(drive: AckermannDrive) -> float:
    """Return the radius (m) of the base's path at the steering limit."""
    return 1.0 / drive.curvature_of(drive.steering_limit)


def drive_parameters(drive: DiffDrive, speed: float, cruise: float) -> _Values:
    """Return parameters by node name; none for wheels that turn the robot in place.

    Args:
        drive: drive of the robot.
        speed: highest speed (m/s).
        cruise: speed on a straight, free path (m/s).
    """
    if isinstance(drive, AckermannDrive):
        return _of_steering(drive, cruise)
    return _of_rollers(speed) if isinstance(drive, MecanumDrive) else {}


def _of_steering(drive: AckermannDrive, cruise: float) -> _Values:
    radius = full_lock_radius(drive)
    driven = _rounded_up(_DRIVEN_RADIUS * radius)
    rate = SimParams().max_steering_rate_radps
    steering_s = round(_STEERING_LAG * drive.steering_limit / rate, 3)
    return {
        "planner": {
            "drive": ACKERMANN,
            "min_turning_radius_m": _rounded_up(_PLANNED_RADIUS * radius),
            "reverse_factor": 2.0,
        },
        "control": {
            "drive": ACKERMANN,
            "min_turning_radius_m": driven,
            "steering_time_s": steering_s,
            # The turn rate changes with the steering angle, as fast as that turns.
            "turn_acceleration_radps2": cruise / driven / steering_s,
        },
        "behaviors": {"drive": ACKERMANN},
    }


def _rounded_up(radius: float) -> float:
    """Return whole millimetres; rounded down, a bend could not be driven."""
    return math.ceil(radius * 1000) / 1000


def _of_rollers(speed: float) -> _Values:
    return {
        "sim": {"max_side_speed_mps": speed},
        "planner": {"drive": OMNI},
        "control": {
            "drive": OMNI,
            "method": "omni_tracking",  # the default would never move sideways
            "max_side_speed_mps": _SIDE_SHARE * speed,
        },
        "behaviors": {"drive": OMNI},
    }
