"""Explanations of the states in which the controller stops: what, how much, what to do.

A stage in front of the controller may be a user's own. Its author reads here why the
robot does not move.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2
from navette.msgs import topics
from navette.navigation.control.command_gate import InputAges
from navette.navigation.control.params import ControlParams
from navette.navigation.control.states import ControlState

EXPLAINED = frozenset(
    {
        ControlState.OFF_PATH,
        ControlState.STALLED,
        ControlState.STALE_ODOMETRY,
        ControlState.STALE_COSTMAP,
        ControlState.STALE_PATH,
    }
)
# Below this, another frame's origin does not explain a deviation.
_FAR_M = 0.2


@dataclass(frozen=True)
class Situation:
    """Inputs and pose of the controller when it stops.

    Attributes:
        pose: of the base in the map; None before odometry.
        path: (N, 3) x, y, yaw.
        odometry_frame: child frame of the odometry; empty before it.
        base_T_odometry: its origin in the base frame; None if unknown.
        ages: of the inputs.
        odometry_arrived: whether any odometry has arrived, also an unusable one.
    """

    pose: Pose2 | None
    path: NDArray[np.float64]
    odometry_frame: str
    base_T_odometry: Pose2 | None
    ages: InputAges
    odometry_arrived: bool


def explain(state: ControlState, now: Situation, params: ControlParams) -> str:
    """Return what is wrong and what to do; empty if the state explains itself."""
    match state:
        case ControlState.OFF_PATH:
            return _off_path(now, params)
        case ControlState.STALLED:
            return (
                f"the robot did not move for {params.stall_time_s:g} s though "
                "commanded: an obstacle that its sensors do not detect blocks it, or "
                "the wheels are blocked or stopped by hardware"
            )
        case ControlState.STALE_ODOMETRY:
            return _stale_odometry(now, params)
        case ControlState.STALE_COSTMAP:
            return (
                f"no costmap {_for(now.ages.costmap_s)} on {topics.COSTMAP.name} "
                f"(limit {now.ages.costmap_timeout_s:g} s): is the costmap node "
                "running, and the lidar publishing? Without a costmap set "
                "collision_check to false"
            )
        case ControlState.STALE_PATH:
            return (
                f"nothing from the planner {_for(now.ages.planner_s)} on "
                f"{topics.PATH.name} and {topics.PLANNER_STATUS.name} (limit "
                f"{params.planner_timeout_s:g} s): a planner of your own publishes its "
                "path or a status again in this time, or set planner_timeout_s to 0"
            )
    return ""


def _off_path(now: Situation, params: ControlParams) -> str:
    if now.pose is None or not len(now.path):
        return ""
    x, y = now.pose.x, now.pose.y
    distances = np.hypot(now.path[:, 0] - x, now.path[:, 1] - y)
    nearest = int(distances.argmin())
    start, off = float(distances[0]), float(distances[nearest])
    steps = np.diff(now.path[: nearest + 1, :2], axis=0)
    passed = float(np.hypot(steps[:, 0], steps[:, 1]).sum())
    what = (
        f"the path starts {start:.2f} m from the robot"
        if passed <= params.max_deviation_m
        else f"the robot is {off:.2f} m from the path"
    )
    text = (
        f"{what}, whose frame {params.base_frame!r} is at ({x:.2f}, {y:.2f}) in "
        f"{params.map_frame!r}; at most max_deviation_m, {params.max_deviation_m:g} m"
    )
    sensor = now.base_T_odometry
    if sensor is not None and math.hypot(sensor.x, sensor.y) > _FAR_M:
        ahead = math.hypot(sensor.x, sensor.y)
        text += (
            f". The odometry is the pose of {now.odometry_frame!r}, {ahead:.2f} m from "
            f"{params.base_frame!r}: plan from {params.base_frame!r} (transform the "
            "odometry's pose with /tf_static)"
        )
    else:
        text += f": plan from the newest pose of {params.base_frame!r}"
    return text


def _stale_odometry(now: Situation, params: ControlParams) -> str:
    topic = topics.ODOMETRY.name
    if not now.odometry_arrived:
        return (
            f"no odometry has arrived on {topic}: is the robot, the simulator or the "
            f"localization running? navette topic info -v {topic}"
        )
    if now.pose is None:
        return (
            f"odometry arrives on {topic}, but cannot be used: its frames must be "
            f"connected with {params.map_frame!r} and {params.base_frame!r} on /tf"
        )
    return (
        f"no odometry {_for(now.ages.odometry_s)} on {topic} (limit "
        f"{now.ages.odometry_timeout_s:g} s): navette topic hz {topic}"
    )


def _for(age_s: float) -> str:
    return f"for {age_s:.2f} s" if math.isfinite(age_s) else "so far"
