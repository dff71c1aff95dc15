"""Attitude of the base at the stamps of scans."""

import pytest

from navette.geometry import quaternion_from_rpy
from navette.msgs.nav_msgs.msg import Odometry
from navette.runtime.stage.attitude import AttitudeTracker
from navette.runtime.time import ns_to_stamp


def odometry(stamp_ns: int, roll: float) -> Odometry:
    msg = Odometry()
    msg.header.stamp = ns_to_stamp(stamp_ns)
    q = msg.pose.pose.orientation
    q.x, q.y, q.z, q.w = quaternion_from_rpy(roll, 0.0, 0.0)
    return msg


def test_the_newest_attitude_up_to_the_stamp_is_used() -> None:
    tracker = AttitudeTracker()
    assert tracker.at(5) == (0.0, 0.0, 0.0, 1.0)
    for stamp_ns, roll in ((10, 0.1), (20, 0.2), (30, 0.3)):
        tracker.update(odometry(stamp_ns, roll))
    for stamp_ns, roll in ((5, 0.1), (10, 0.1), (29, 0.2), (30, 0.3), (99, 0.3)):
        expected = quaternion_from_rpy(roll, 0.0, 0.0)
        assert tracker.at(stamp_ns) == pytest.approx(expected)


def test_a_jump_backward_in_time_starts_again() -> None:
    tracker = AttitudeTracker()
    tracker.update(odometry(100, 0.1))
    tracker.update(odometry(50, 0.2))
    assert tracker.at(200) == pytest.approx(quaternion_from_rpy(0.2, 0.0, 0.0))
