"""Planar motion of a robot's base, from odometry of a frame fixed to it."""

import math
from typing import TYPE_CHECKING, NamedTuple

from navette.geometry import Pose2, yaw_of
from navette.runtime.time import stamp_to_ns

if TYPE_CHECKING:  # every program imports this module, and few make the message class
    from navette.msgs.nav_msgs.msg import Odometry

HERE = Pose2(0.0, 0.0, 0.0)
"""The identity; trackers do not multiply with this object."""


class PlanarOdometry(NamedTuple):
    """Pose and velocity of the base by one message.

    Attributes:
        odom_T_base: in the odometry's frame.
        speed: forward, m/s.
        side_speed: to the left, m/s.
        turn_rate: rad/s.
    """

    stamp_ns: int
    odom_T_base: Pose2
    speed: float
    side_speed: float
    turn_rate: float


REST = PlanarOdometry(0, HERE, 0.0, 0.0, 0.0)


class SharedPlanarOdometry:
    """The newest conversion of the odometry that the nodes of a context share.

    A message arrives at its receivers one after another, and none of them may change
    it: most stages convert it, with the same frames.
    """

    def __init__(self) -> None:
        # One object, so that other threads never see a part of a change.
        self._newest: tuple[Odometry | None, Pose2, PlanarOdometry] = None, HERE, REST

    def of(self, odometry: "Odometry", child_T_base: Pose2) -> PlanarOdometry:
        """Return the motion by a message that is not changed any more."""
        message, known_T_base, motion = self._newest
        if message is not odometry or known_T_base != child_T_base:
            motion = planar_odometry(odometry, child_T_base)
            self._newest = odometry, child_T_base, motion
        return motion


def planar_odometry(odometry: "Odometry", child_T_base: Pose2) -> PlanarOdometry:
    """Convert a message; ``child_T_base`` is fixed.

    v_base = v_child + ω × p (rigid body), rotated into the base's axes.
    """
    pose, twist = odometry.pose.pose, odometry.twist.twist
    position, q = pose.position, pose.orientation
    stamp_ns = stamp_to_ns(odometry.header.stamp)
    odom_T_child = Pose2(position.x, position.y, yaw_of((q.x, q.y, q.z, q.w)))
    vx, vy, omega = twist.linear.x, twist.linear.y, twist.angular.z
    if child_T_base is HERE:
        return PlanarOdometry(stamp_ns, odom_T_child, vx, vy, omega)
    x, y, yaw = child_T_base
    along, across = vx - omega * y, vy + omega * x
    c, s = math.cos(yaw), math.sin(yaw)
    speed, side_speed = c * along + s * across, c * across - s * along
    return PlanarOdometry(
        stamp_ns, odom_T_child @ child_T_base, speed, side_speed, omega
    )
