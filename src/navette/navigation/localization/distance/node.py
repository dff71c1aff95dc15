"""The distance node: positions or velocities in, distance travelled out.

The node publishes 0.0 before the first message, then the distance so far, ten times a
second, also without new messages.
"""

import math
from dataclasses import replace
from typing import Any, ClassVar

from navette.errors import InvalidInputError
from navette.geometry.geodesy import GeoPoint
from navette.msgs import topics
from navette.msgs.geometry_msgs.msg import TwistStamped
from navette.msgs.gnss_driver.msg import Gps
from navette.msgs.nav_msgs.msg import Odometry
from navette.msgs.sensor_msgs.msg import NavSatFix, NavSatStatus
from navette.msgs.std_msgs.msg import Float64
from navette.navigation.localization.distance.odometer import Odometer, Step
from navette.navigation.localization.distance.params import DistanceParams
from navette.runtime import Input, Output, StageNode, stamp_to_ns
from navette.runtime.input_check import FARTHEST

_PERIOD_S = 0.1


class OdomIntegratorNode(StageNode):
    """Sum the distance travelled, by position or by velocity."""

    PARAMS = DistanceParams
    FIXED_AT_START = ("topic", "topic_type", "queue_size")
    INPUTS: ClassVar = (
        Input.of(
            topics.GNSS,
            "position and velocity; parameters select topic and type",
            rate_hz=100.0,
            callback="on_message",
            checks_contents=False,  # only position or velocity is used
        ),
    )
    OUTPUTS: ClassVar = (
        Output.of(
            topics.DISTANCE,
            "distance travelled, m; 0.0 before the first message",
            rate_hz=10.0,
        ),
    )

    params: DistanceParams

    def __init__(self, node_name: str = "odom_integrator", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self._odometer = Odometer(self.params.max_gap_ns)
        self.create_timer(_PERIOD_S, self.on_timer)

    def inputs(self) -> tuple[Input, ...]:
        (usual,) = self.INPUTS
        p = self.params
        return (replace(usual, topic=p.topic, type=p.topic_type, depth=p.queue_size),)

    @property
    def distance(self) -> float:
        """Distance so far, metres."""
        return self._odometer.distance

    def on_message(self, msg: "Gps | NavSatFix | TwistStamped | Odometry") -> None:
        """Add the distance since the previous message."""
        stamp_ns = stamp_to_ns(msg.header.stamp)
        if self.params.by_velocity:
            step = self._odometer.step_velocity(_checked(_velocity(msg)), stamp_ns)
        elif isinstance(msg, NavSatFix):
            step = self._odometer.step_place(_place(msg), stamp_ns)
        else:
            step = self._odometer.step_position(_checked(_position(msg)), stamp_ns)
        self._log(step, stamp_ns)

    def on_timer(self) -> None:
        """Publish the distance so far."""
        self.publish(topics.DISTANCE.name, Float64(data=self.distance))

    def on_params_changed(self, old: DistanceParams) -> None:
        """Keep the distance; continue counting from the next message."""
        self._odometer.max_gap_ns = self.params.max_gap_ns
        self._odometer.pause()

    def _log(self, step: Step, stamp_ns: int) -> None:
        if step is Step.REFUSED:
            raise InvalidInputError(
                "out_of_range", f"message at {stamp_ns / 1e9:.3f} s: the sum overflows"
            )
        if step in (Step.GAP, Step.WENT_BACK):
            self.get_logger().info(
                f"{step.value}: counting continues from {stamp_ns / 1e9:.3f} s"
            )


def _place(fix: NavSatFix) -> GeoPoint:
    if fix.status.status == NavSatStatus.STATUS_NO_FIX:
        raise InvalidInputError("no_fix", "status.status is STATUS_NO_FIX")
    place = GeoPoint(fix.latitude, fix.longitude, fix.altitude)
    if not place.is_valid:
        raise InvalidInputError(
            "out_of_range", f"{place}: expected a latitude and a longitude in range"
        )
    return place


def _checked(vector: tuple[float, float, float]) -> tuple[float, float, float]:
    if not all(map(math.isfinite, vector)):
        raise InvalidInputError("not_finite", f"{vector}; must be finite numbers")
    if max(map(abs, vector)) > FARTHEST:
        raise InvalidInputError(
            "out_of_range", f"{vector}; must be within ±{FARTHEST:g}"
        )
    return vector


def _position(msg: Any) -> tuple[float, float, float]:
    pose = msg.localization if isinstance(msg, Gps) else msg.pose.pose
    return pose.position.x, pose.position.y, pose.position.z


def _velocity(msg: Any) -> tuple[float, float, float]:
    if isinstance(msg, Gps):
        v = msg.localization.linear_velocity
        return v.x, v.y, v.z
    linear = (msg.twist.twist if isinstance(msg, Odometry) else msg.twist).linear
    return linear.x, linear.y, linear.z
