"""Planar motion of the base, from odometry of a frame fixed to it."""

import math

import numpy as np
import pytest

from navette.geometry import Pose2, quaternion_from_yaw
from navette.msgs.geometry_msgs.msg import Quaternion
from navette.msgs.nav_msgs.msg import Odometry
from navette.runtime.planar_odometry import HERE, SharedPlanarOdometry, planar_odometry
from navette.runtime.time import ns_to_stamp


def odometry(rng: np.random.Generator) -> Odometry:
    x, y, yaw, vx, vy, omega = rng.uniform(-3, 3, 6).tolist()
    message = Odometry()
    message.header.stamp = ns_to_stamp(int(rng.integers(1, 10**12)))
    message.pose.pose.position.x, message.pose.pose.position.y = x, y
    qx, qy, qz, qw = quaternion_from_yaw(yaw)
    message.pose.pose.orientation = Quaternion(x=qx, y=qy, z=qz, w=qw)
    message.twist.twist.linear.x, message.twist.twist.linear.y = vx, vy
    message.twist.twist.angular.z = omega
    return message


def test_the_motion_of_the_base_is_that_of_a_rigid_body() -> None:
    message = Odometry()
    message.twist.twist.angular.z = 0.5
    ahead = planar_odometry(
        message, Pose2(0.4, 0.0, math.pi)
    )  # of a lidar that looks back
    assert ahead.odom_T_base == pytest.approx((0.4, 0.0, math.pi))
    assert (ahead.speed, ahead.side_speed) == pytest.approx((0.0, -0.2))
    assert ahead.turn_rate == 0.5


def test_a_shared_conversion_equals_an_own_one() -> None:
    rng = np.random.default_rng(1)
    shared = SharedPlanarOdometry()
    mounts = HERE, Pose2(0.2, -0.1, 0.3)
    for _ in range(20):
        message = odometry(rng)
        for child_T_base in (*mounts, mounts[1], mounts[0]):
            own = planar_odometry(message, child_T_base)
            assert shared.of(message, child_T_base) == own


def test_a_message_is_converted_once_for_its_receivers() -> None:
    shared = SharedPlanarOdometry()
    message = odometry(np.random.default_rng(2))
    mount = Pose2(0.2, -0.1, 0.3)
    first = shared.of(message, mount)
    assert shared.of(message, Pose2(*mount)) is first
