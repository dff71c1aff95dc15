"""Decide when following a path, as a goal with a result, has failed."""

import math
from typing import NamedTuple

from navette.geometry import Pose2, angle_difference
from navette.navigation.control.params import ControlParams
from navette.navigation.control.states import ControlState

# Nav2's error code for a state that persists longer than the tolerance.
_PERSISTENT = {
    ControlState.BLOCKED: "PATIENCE_EXCEEDED",
    ControlState.STALLED: "FAILED_TO_MAKE_PROGRESS",
    ControlState.OFF_PATH: "PATIENCE_EXCEEDED",
    ControlState.STALE_ODOMETRY: "TF_ERROR",
    ControlState.STALE_COSTMAP: "CONTROLLER_TIMED_OUT",
    ControlState.COMMAND_NOT_FINITE: "NO_VALID_CONTROL",
    ControlState.COMMAND_OVER_LIMIT: "NO_VALID_CONTROL",
}


class FollowFailure(NamedTuple):
    """Name of Nav2's error code, and the reason."""

    code: str
    reason: str


class FollowMonitor:
    """Time since the last progress, and since the robot could last follow the path."""

    def __init__(self, params: ControlParams, now_ns: int) -> None:
        self._params = params
        self._able_ns = self._progress_ns = now_ns
        self._mark: Pose2 | None = None

    def check(
        self, state: ControlState, pose: Pose2 | None, now_ns: int
    ) -> FollowFailure | None:
        """Return why the goal has failed, or None.

        Args:
            state: state of the follower at this step.
            pose: pose of the robot in the map; None if unknown.
            now_ns: time of the node's clock.
        """
        params = self._params
        if state is ControlState.METHOD_FAILED:
            return FollowFailure("NO_VALID_CONTROL", f"{state}: see the log")
        code = _PERSISTENT.get(state)
        if code is None:
            self._able_ns = now_ns
        elif now_ns - self._able_ns >= params.failure_tolerance_s * 1e9:
            seconds = (now_ns - self._able_ns) / 1e9
            return FollowFailure(code, f"{state} for {seconds:.1f} s")
        if pose is not None and self._has_moved(pose):
            self._mark, self._progress_ns = pose, now_ns
        timeout_s = params.progress_timeout_s
        if 0.0 < timeout_s * 1e9 <= now_ns - self._progress_ns:
            return FollowFailure(
                "FAILED_TO_MAKE_PROGRESS",
                f"less than {params.progress_distance_m:g} m and "
                f"{params.progress_angle_rad:g} rad in {timeout_s:g} s ({state})",
            )
        return None

    def pause(self, elapsed_ns: int) -> None:
        """Leave out a span of time: the robot was commanded by someone else."""
        self._able_ns += elapsed_ns
        self._progress_ns += elapsed_ns

    def _has_moved(self, pose: Pose2) -> bool:
        mark, params = self._mark, self._params
        return (
            mark is None
            or math.dist(mark[:2], pose[:2]) >= params.progress_distance_m
            or abs(angle_difference(pose.yaw, mark.yaw)) >= params.progress_angle_rad
        )
