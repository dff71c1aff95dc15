"""Jumps of the odometry: motions that no robot makes between two messages.

An encoder fault, a restarted filter or a reset moves the odometry's frame, not the
robot.
"""

from navette.geometry import Pose2, angle_difference

# Motion between two messages beyond that at the former speed, and its growth with the
# time between them: half of an acceleration that no wheeled robot has.
_SLACK_M, _SLACK_RAD = 0.3, 0.35
_HALF_MPS2, _HALF_RADPS2 = 5.0, 10.0


class OdometryJumps:
    """Finds jumps in the poses of the odometry."""

    def __init__(self) -> None:
        self._odom_T_base: Pose2 | None = None
        self._stamp_ns = 0
        self._speed_mps = self._rate_radps = 0.0

    def step(self, odom_T_base: Pose2, stamp_ns: int) -> Pose2 | None:
        """Return the transform from the old to the new frame after a jump, or None.

        The robot's own motion between the two messages is neglected.
        """
        before, since_s = self._odom_T_base, (stamp_ns - self._stamp_ns) / 1e9
        self._odom_T_base, self._stamp_ns = odom_T_base, stamp_ns
        if before is None or since_s <= 0.0:
            return None
        moved_m = before.distance_to(odom_T_base)
        turned_rad = abs(angle_difference(before.yaw, odom_T_base.yaw))
        most_m = self._speed_mps * since_s + _SLACK_M + _HALF_MPS2 * since_s**2
        most_rad = self._rate_radps * since_s + _SLACK_RAD + _HALF_RADPS2 * since_s**2
        if moved_m > most_m or turned_rad > most_rad:
            return odom_T_base @ before.inverse()
        self._speed_mps, self._rate_radps = moved_m / since_s, turned_rad / since_s
        return None
