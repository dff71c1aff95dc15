"""The obstacle layer of a node: its parameters, subscriptions and frames.

Poses come from the odometry, the sensors' poses on the robot from the transforms. A
message whose pose is unknown is dropped with its reason; nothing is marked meanwhile.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields
from functools import partial
from typing import Any, TypeVar

from navette.errors import InvalidInputError, ParameterError
from navette.geometry import Footprint, Pose2, Transform3
from navette.msgs import topics
from navette.msgs.irobot_create_msgs.msg import HazardDetection, HazardDetectionVector
from navette.msgs.nav_msgs.msg import Odometry
from navette.msgs.rcl_interfaces.msg import ParameterDescriptor
from navette.msgs.sensor_msgs.msg import LaserScan, PointCloud2, Range
from navette.navigation.costmap.layers.observation import (
    Points,
    of_cloud,
    of_range,
    of_scan,
)
from navette.navigation.costmap.layers.obstacle_layer import ObstacleLayer
from navette.navigation.costmap.layers.params import (
    ObstacleLayerParams,
    RangeLayerParams,
    SourceParams,
)
from navette.navigation.costmap.params import CostmapParams
from navette.params import Params
from navette.runtime import Input, Node, StageNode, TransformListener, stamp_to_ns
from navette.runtime.stage.odometry import PoseTracker
from navette.runtime.tf import TransformException

_LAYER = "obstacle_layer"
_RANGES = "range_layer"
_TYPES = {
    "LaserScan": "sensor_msgs/msg/LaserScan",
    "PointCloud2": "sensor_msgs/msg/PointCloud2",
    "Range": "sensor_msgs/msg/Range",
    "HazardDetectionVector": "irobot_create_msgs/msg/HazardDetectionVector",
}
_AHEAD_NS = 500_000_000  # of a stamp, beyond the newest odometry
_FARTHEST_M = 1000.0  # of a sensor from the base

P = TypeVar("P", bound=Params)


@dataclass(frozen=True)
class LayerSettings:
    """The parameters of the layer; without sources there is none."""

    layer: ObstacleLayerParams
    ranges: RangeLayerParams
    sources: dict[str, SourceParams]


def declare_layer(node: Node) -> LayerSettings:
    """Declare the parameters of the layer and of its sources.

    Raises:
        ParameterError: a value is not allowed, or a source has no topic.
    """
    layer = _declare(node, _LAYER, ObstacleLayerParams)
    ranges = _declare(node, _RANGES, RangeLayerParams)
    sources = {}
    for name in layer.observation_sources.split():
        source = _declare(node, f"{_LAYER}.{name}", SourceParams)
        if not source.topic:
            raise ParameterError(
                f"node {node.get_fully_qualified_name()}: {_LAYER}.{name}.topic is "
                f"empty; {_LAYER}.observation_sources names it, so it needs a topic"
            )
        sources[name] = source
    return LayerSettings(layer, ranges, sources)


def _declare(node: Node, prefix: str, kind: type[P]) -> P:
    """Declare ``PREFIX.FIELD``; fixed at the start."""
    fixed = ParameterDescriptor(read_only=True, dynamic_typing=True)
    values = {
        field.name: node.declare_parameter(
            f"{prefix}.{field.name}", field.default, fixed
        ).value
        for field in fields(kind)
    }
    try:
        return kind(**values)
    except ParameterError as error:
        where = f"node {node.get_fully_qualified_name()}: {prefix}"
        raise ParameterError(f"{where}: {error}") from None


class ObstacleSources:
    """Observes with the sources of a node's layer."""

    def __init__(
        self, node: StageNode, settings: LayerSettings, params: CostmapParams
    ) -> None:
        self._node = node
        self._settings = settings
        self._tracker = PoseTracker(node, params.base_frame, params.map_frame)
        self._listener: TransformListener | None = None
        self._arrivals_ns: dict[str, int] = {}
        self._began_ns: int | None = None
        self.configure(params)

    def configure(self, params: CostmapParams) -> None:
        """Start with an empty layer of the parameters' size."""
        outline = params.footprint_m
        self._layer = ObstacleLayer(
            self._settings.layer,
            self._settings.ranges,
            params.size_m,
            Footprint.from_flat(outline) if outline else None,
        )

    @staticmethod
    def inputs(
        settings: LayerSettings, owner: Callable[[], "ObstacleSources"]
    ) -> Iterator[Input]:
        """Return the subscriptions: odometry and one for each source."""
        yield Input.of(
            topics.ODOMETRY,
            "pose of the robot, for the sources of the obstacle layer",
            callback=lambda msg: owner().on_odometry(msg),
        )
        for name, source in settings.sources.items():
            yield Input(
                topic=source.topic,
                type=_TYPES[source.data_type],
                role=f"source {name} of the obstacle layer",
                callback=partial(_receive, owner, name),
                # Checked where it is read: echoes that are not finite are usual.
                checks_contents=False,
            )

    def on_odometry(self, msg: Odometry) -> None:
        """Store the pose of the robot."""
        self._tracker.update(msg)

    def clear(self) -> None:
        """Clear all marks; obstacles that are seen are marked again."""
        self._layer.reset()

    def reset(self) -> None:
        """Forget everything: a new run."""
        self._tracker.reset()
        self._layer.reset()
        self._arrivals_ns.clear()
        self._began_ns = None

    def receive(self, name: str, msg: Any) -> None:
        """Observe with a message of a source.

        Raises:
            InvalidInputError: its contents or its frame cannot be used, or its stamp is
                outside the odometry's history.
        """
        source = self._settings.sources[name]
        stamp_ns = stamp_to_ns(msg.header.stamp)
        if isinstance(msg, HazardDetectionVector):
            self._bump(msg, stamp_ns)
        else:
            self._observe(source, msg, stamp_ns)
        self._arrivals_ns[name] = self._node.get_clock().now().nanoseconds

    def stale(self) -> str:
        """Return which source is stale and since when; "" if none is."""
        now_ns = self._node.get_clock().now().nanoseconds
        if self._began_ns is None or now_ns < self._began_ns:
            self._began_ns = now_ns
        for name, source in self._settings.sources.items():
            limit_s = source.expected_update_rate
            if source.data_type == "Range":
                limit_s = limit_s or self._settings.ranges.no_readings_timeout
            age_s = (now_ns - self._arrivals_ns.get(name, self._began_ns)) / 1e9
            if limit_s and age_s > limit_s:
                return (
                    f"source {name!r}: no usable message on {source.topic} for "
                    f"{age_s:.1f} s; at most {limit_s:g} s"
                )
        return ""

    def obstacles_in(self, frame_id: str, stamp_ns: int) -> Points | None:
        """Return the places (N, 2) of the obstacles in a frame of the robot, m.

        None: the pose at the stamp is not known.
        """
        odom_T_base = self._pose_at(stamp_ns)
        base_T_frame = self._tracker.transform_to_base(frame_id)
        if odom_T_base is None or base_T_frame is None:
            return None
        found = self._layer.obstacles(odom_T_base, stamp_ns)
        places: Points = (odom_T_base @ base_T_frame).inverse().apply(found)
        return places

    def _observe(
        self, source: SourceParams, msg: LaserScan | PointCloud2 | Range, stamp_ns: int
    ) -> None:
        odom_T_base = self._needed_pose(stamp_ns)
        frame = source.sensor_frame or msg.header.frame_id
        base_T_sensor = self._pose_on_base(frame, stamp_ns)
        placed = Transform3.from_pose2(odom_T_base) @ base_T_sensor
        if isinstance(msg, Range):
            cone = of_range(msg)
            if cone is not None:
                self._layer.measure(cone, placed.to_pose2(), odom_T_base)
            return
        if isinstance(msg, LaserScan):
            seen = of_scan(msg, inf_is_valid=source.inf_is_valid)
        else:
            seen = of_cloud(msg)
        self._layer.observe(seen.placed(placed), source, odom_T_base)

    def _bump(self, msg: HazardDetectionVector, stamp_ns: int) -> None:
        for each in msg.detections:
            if each.type != HazardDetection.BUMP:
                continue
            odom_T_base = self._needed_pose(stamp_ns)
            bumper = self._pose_on_base(each.header.frame_id, stamp_ns).to_pose2()
            self._layer.bump(odom_T_base @ bumper, stamp_ns)

    def _needed_pose(self, stamp_ns: int) -> Pose2:
        pose = self._pose_at(stamp_ns)
        if pose is None:
            raise InvalidInputError(
                "unknown_pose",
                f"no odometry for its stamp, {stamp_ns / 1e9:.3f} s; newest: "
                f"{(self._tracker.stamp_ns or 0) / 1e9:.3f} s",
            )
        return pose

    def _pose_at(self, stamp_ns: int) -> Pose2 | None:
        """Return odom_T_base: continuous, also while map → odom is corrected.

        None: the stamp is outside the odometry's history, or well after it.
        """
        newest_ns = self._tracker.stamp_ns
        if newest_ns is None or stamp_ns > newest_ns + _AHEAD_NS:
            return None
        pose = self._tracker.predicted_at(stamp_ns)
        return None if pose is None else self._tracker.in_odom(pose)

    def _pose_on_base(self, frame: str, stamp_ns: int) -> Transform3:
        """Return ``base_T_frame``, also of a frame that moves on the robot."""
        base, buffer = self._tracker.base_frame, self._tracker.buffer
        if frame == base:
            return Transform3.identity()
        try:
            found = buffer.lookup(
                base, frame, 0 if self._listener is None else stamp_ns
            )
        except TransformException as error:
            if self._listener is None:  # not fixed: subscribe to /tf from now on
                self._listener = TransformListener(buffer, self._node)
            raise InvalidInputError("unknown_frame", str(error)) from None
        if not all(abs(each) <= _FARTHEST_M for each in found.translation):
            raise InvalidInputError(
                "out_of_range", f"{frame!r} at {found.translation} m from {base!r}"
            )
        return found


def _receive(owner: Callable[[], ObstacleSources], name: str, msg: Any) -> None:
    owner().receive(name, msg)
