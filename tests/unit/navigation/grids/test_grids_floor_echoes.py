"""Echoes of the floor that a tilted scanner sees."""

import math

import numpy as np
import pytest

from navette.geometry import Pose2, Transform3, quaternion_from_rpy
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.navigation.grids import LEVEL, is_floor, upward_of
from navette.navigation.slam.messages import planar_scan

HEIGHT_M = 0.3


def floor_at(roll: float, pitch: float, angle: float) -> float:
    """Return the distance at which a horizontal beam of the base meets the floor."""
    up = upward_of(quaternion_from_rpy(roll, pitch, 0.7))
    slope = up.x * math.cos(angle) + up.y * math.sin(angle)
    return -up.z * HEIGHT_M / slope if slope < 0 else math.inf


def test_the_upward_vector_is_that_of_gravity() -> None:
    assert upward_of((0.0, 0.0, 0.6, 0.8)) == pytest.approx(LEVEL)
    # Nose down by 0.1 rad: up is behind the base's z axis.
    x, y, z = upward_of(quaternion_from_rpy(0.0, 0.1, 2.0))
    assert (x, y, z) == pytest.approx((-math.sin(0.1), 0.0, math.cos(0.1)))


@pytest.mark.parametrize(("roll", "pitch"), [(0.04, 0.0), (-0.03, 0.05), (0.0, -0.08)])
def test_the_floor_is_left_out_and_walls_before_it_are_kept(
    roll: float, pitch: float
) -> None:
    upward = upward_of(quaternion_from_rpy(roll, pitch, 0.7))
    for angle in np.linspace(-math.pi, math.pi, 37):
        reach = floor_at(roll, pitch, angle)
        ray = np.array([math.cos(angle), math.sin(angle)])
        if reach < 30.0:
            found = is_floor(np.array([reach * ray, 0.5 * reach * ray]), 0.3, upward)
            assert found.tolist() == [True, False]
        else:
            assert not is_floor(np.array([8.0 * ray]), HEIGHT_M, upward).any()


def test_level_ground_hides_nothing() -> None:
    points = np.array([[20.0, 0.0], [0.0, -20.0]])
    assert not is_floor(points, HEIGHT_M, LEVEL).any()


def test_a_scan_of_a_tilted_robot_loses_its_floor_only() -> None:
    tilt, angles = (0.0, 0.06, 0.0), np.linspace(-1.0, 1.0, 201)
    ranges = [min(4.0, floor_at(0.0, 0.06, angle)) for angle in angles]
    ranges[100], far = 2.0, floor_at(0.0, 0.06, 0.3)
    ranges[130] = far
    msg = LaserScan(
        angle_min=-1.0, angle_increment=0.01, range_min=0.1, range_max=30.0,
        ranges=np.array(ranges, np.float32),
    )  # fmt: skip
    mount = Transform3((0.0, 0.0, HEIGHT_M), (0.0, 0.0, 0.0, 1.0))
    scan, base_T_sensor = planar_scan(msg, mount, upward_of(quaternion_from_rpy(*tilt)))
    assert base_T_sensor == Pose2(0.0, 0.0, 0.0)
    assert np.isnan(scan.ranges[130])
    assert scan.ranges[100] == 2.0
    level, _ = planar_scan(msg, mount)
    assert np.array_equal(level.ranges, msg.ranges)
