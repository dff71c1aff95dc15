"""Attitude of the robot's base by odometry, at the stamps of scans."""

from bisect import bisect_right
from collections import deque

from navette.msgs.nav_msgs.msg import Odometry
from navette.runtime.time import stamp_to_ns

Rotation = tuple[float, float, float, float]
"""Quaternion x, y, z, w."""

_STEADY: Rotation = (0.0, 0.0, 0.0, 1.0)
_KEPT = 64


class AttitudeTracker:
    """Orientations of the newest odometry."""

    def __init__(self) -> None:
        self._kept: deque[tuple[int, Rotation]] = deque(maxlen=_KEPT)

    def update(self, msg: Odometry) -> None:
        """Store the orientation; a stamp of the past begins a new history."""
        q, stamp_ns = msg.pose.pose.orientation, stamp_to_ns(msg.header.stamp)
        if self._kept and stamp_ns < self._kept[-1][0]:
            self._kept.clear()
        self._kept.append((stamp_ns, (q.x, q.y, q.z, q.w)))

    def at(self, stamp_ns: int) -> Rotation:
        """Return the newest orientation up to a stamp, else the oldest; first level."""
        if not self._kept:
            return _STEADY
        index = bisect_right(self._kept, stamp_ns, key=lambda each: each[0])
        return self._kept[max(0, index - 1)][1]
