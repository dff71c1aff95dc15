"""The tracking node: scans and odometry in, moving obstacles out.

Before the first scan the node publishes nothing. It publishes what moves at each used
scan, with the scan's stamp, and once more, empty, when nothing moves any more.
"""

import uuid
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np

from navette.errors import InvalidInputError, InvalidValueError
from navette.msgs import topics
from navette.msgs.geometry_msgs.msg import Point, Vector3
from navette.msgs.nav2_dynamic_msgs.msg import Obstacle, ObstacleArray
from navette.msgs.nav_msgs.msg import Odometry
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.msgs.std_msgs.msg import ColorRGBA, Header
from navette.msgs.unique_identifier_msgs.msg import UUID
from navette.msgs.visualization_msgs.msg import Marker, MarkerArray
from navette.navigation.grids import PlanarScan
from navette.navigation.tracking.params import TrackingParams
from navette.navigation.tracking.tracker import MovingObstacles
from navette.navigation.tracking.tracks import TrackedObstacle
from navette.runtime import Input, Output, StageNode, stamp_to_ns
from navette.runtime.stage.odometry import PoseTracker

_NAMESPACE = uuid.UUID(int=0)
_HEIGHT_M = 1.0  # of the drawing: a scanner measures in one plane
_COLOUR = ColorRGBA(r=0.95, g=0.45, b=0.15, a=0.6)


class TrackingNode(StageNode):
    """Publish position and velocity of what moves around the robot."""

    PARAMS = TrackingParams
    INPUTS: ClassVar = (
        Input.of(topics.LIDAR, "laser scan", rate_hz=10.0, callback="on_scan"),
        Input.of(
            topics.ODOMETRY,
            "pose and velocity",
            rate_hz=10.0,
            callback="on_odometry",
        ),
    )
    OUTPUTS: ClassVar = (
        Output.of(
            topics.TRACKED_OBSTACLES,
            "moving obstacles around the robot, while there are any",
            rate_hz=20.0,
        ),
        Output.of(
            topics.TRACKED_MARKERS,
            "the same as discs and arrows, only while it is subscribed to",
            rate_hz=20.0,
        ),
    )

    params: TrackingParams

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("tracking", **kwargs)
        self._obstacles = MovingObstacles(self.params)
        self._obstacles.warm_up()
        self._poses = PoseTracker(self, self.params.base_frame, self.params.map_frame)
        self._odometry: Odometry | None = None  # newest, not used yet
        self._found_any = False

    def inputs(self) -> tuple[Input, ...]:
        scans, odometry = self.INPUTS
        return replace(scans, most_hz=self.params.rate_hz), odometry

    def on_odometry(self, msg: Odometry) -> None:
        """Store the newest message for the next scan."""
        self._odometry = msg

    def on_scan(self, msg: LaserScan) -> None:
        """Publish what moves at the stamp of the scan."""
        stamp_ns = stamp_to_ns(msg.header.stamp)
        if self._odometry is not None:
            jumps = self._poses.jumps
            self._poses.update(self._odometry)
            self._odometry = None
            if self._poses.jumps != jumps:
                self._obstacles.reset()  # everything seems to have moved
        map_T_base = self._poses.predicted_at(stamp_ns)
        base_T_sensor = self._poses.transform_to_base(msg.header.frame_id)
        if map_T_base is None or base_T_sensor is None:
            return
        try:
            scan = PlanarScan(
                np.asarray(msg.ranges, np.float32),
                msg.angle_min,
                msg.angle_increment,
                msg.range_min,
                msg.range_max,
            )
        except InvalidValueError as error:
            raise InvalidInputError("out_of_range", str(error)) from None
        found = self._obstacles.step(scan, map_T_base @ base_T_sensor, stamp_ns)
        if found or self._found_any:
            self._publish(found, Header(stamp=msg.header.stamp))
        self._found_any = bool(found)

    def on_params_changed(self, old: TrackingParams) -> None:
        """Forget all tracks and use the new values."""
        self._obstacles = MovingObstacles(self.params)
        self.change_rate(topics.LIDAR.name, self.params.rate_hz)
        if (self.params.base_frame, self.params.map_frame) != (
            old.base_frame,
            old.map_frame,
        ):
            self._poses = PoseTracker(
                self, self.params.base_frame, self.params.map_frame
            )

    def on_time_jump(self) -> None:
        """Forget all scans and tracks."""
        self._obstacles.reset()
        self._poses.reset()
        self._odometry = None

    def _publish(self, found: list[TrackedObstacle], header: Header) -> None:
        header.frame_id = self.params.map_frame
        message = ObstacleArray(
            header=header, obstacles=[_message(each) for each in found]
        )
        self.publish(topics.TRACKED_OBSTACLES.name, message)
        if self.has_listeners(topics.TRACKED_MARKERS.name):
            self.publish(topics.TRACKED_MARKERS.name, _markers(found, header))


def _message(obstacle: TrackedObstacle) -> Obstacle:
    diameter = 2 * obstacle.radius_m
    return Obstacle(
        uuid=UUID(uuid=_uuid(obstacle.number)),
        score=1.0,
        position=Point(x=obstacle.x, y=obstacle.y),
        velocity=Vector3(x=obstacle.vx, y=obstacle.vy),
        size=Vector3(x=diameter, y=diameter, z=_HEIGHT_M),
    )


def _uuid(number: int) -> np.ndarray[tuple[int], np.dtype[np.uint8]]:
    name = uuid.uuid5(_NAMESPACE, str(number))
    return np.frombuffer(name.bytes, np.uint8)


def _markers(found: list[TrackedObstacle], header: Header) -> MarkerArray:
    """Return a disc at each obstacle, and a line to where it is after a second."""
    markers = [Marker(header=header, action=Marker.DELETEALL)]
    for each in found:
        disc = Marker(header=header, ns="obstacle", id=each.number, color=_COLOUR)
        disc.type = Marker.CYLINDER
        disc.pose.position = Point(x=each.x, y=each.y, z=_HEIGHT_M / 2)
        disc.scale = Vector3(x=2 * each.radius_m, y=2 * each.radius_m, z=_HEIGHT_M)
        line = Marker(header=header, ns="velocity", id=each.number, color=_COLOUR)
        line.type = Marker.LINE_STRIP
        line.scale = Vector3(x=0.05)
        x, y = each.at(1.0)
        line.points = [Point(x=each.x, y=each.y, z=0.1), Point(x=x, y=y, z=0.1)]
        markers += [disc, line]
    return MarkerArray(markers=markers)
