"""Scans of a recording with the odometry at their stamps."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

from navette.bags.bag import BagReader, BagTopic, OnDamage
from navette.bags.message_types import Decoder
from navette.errors import (
    InvalidInputError,
    InvalidValueError,
    NavetteError,
    UnknownNameError,
)
from navette.geometry import Pose2, Transform3, yaw_of
from navette.msgs.topics import LIDAR, ODOMETRY
from navette.navigation.grids import PlanarScan
from navette.navigation.slam.messages import planar_scan
from navette.runtime import stamp_to_ns
from navette.runtime.tf.buffer_core import BufferCore
from navette.runtime.tf.conversions import transform_from_msg
from navette.runtime.tf.exceptions import TransformException

_SCAN = "sensor_msgs/msg/LaserScan"
_ODOMETRY = "nav_msgs/msg/Odometry"
_TRANSFORMS = ("/tf", "/tf_static")
# Preferred where a recording has several topics of the type.
_USUAL_SCANS = ("/scan", LIDAR.name)
_USUAL_ODOMETRY = ("/odom", "/odometry", "/wheel/odometry", ODOMETRY.name)
NO_ODOMETRY = "none"
_FOREVER_NS = 1 << 62


class RecordedScan(NamedTuple):
    """A scan, and where it was taken."""

    stamp_ns: int
    scan: PlanarScan
    base_T_sensor: Pose2
    odom_T_base: Pose2 | None
    """None: no odometry at this stamp"""


@dataclass(frozen=True, kw_only=True)
class ScanSource:
    """Topics and frames of a recording; "" chooses the usual ones."""

    scan_topic: str = ""
    odometry: str = ""
    """a topic of nav_msgs/Odometry; "": /tf, else such a topic; none: without"""
    odom_frame: str = "odom"
    base_frame: str = "base_link"


class RecordedScans:
    """Scans of one topic, by stamp.

    Transforms and odometry are read first, so that each scan has the pose at its own
    stamp, whatever the order of the messages.

    Args:
        reader: an open recording.
        source: topics and frames.
        on_damage: receives each part that cannot be read.

    Raises:
        UnknownNameError: the recording has no such topic, or no scans.
    """

    def __init__(
        self,
        reader: BagReader,
        source: ScanSource,
        *,
        on_damage: OnDamage | None = None,
    ) -> None:
        self._reader = reader
        self._on_damage = on_damage
        self._decoders: dict[BagTopic, Decoder] = {}
        self.topic = _chosen(reader, _SCAN, source.scan_topic, _USUAL_SCANS)
        self.source = source
        self.count = sum(
            count for each, count in reader.counts().items() if each.name == self.topic
        )
        self.skipped = 0
        self.problems: list[str] = []
        self._buffer = BufferCore(_FOREVER_NS)
        self._read_transforms()
        self.odometry = self._choose_odometry()

    def __iter__(self) -> Iterator[RecordedScan]:
        """Iterate over the scans; unusable ones are counted and noted."""
        last_ns = -1
        for msg in self._messages([self.topic], _SCAN):
            stamp_ns = stamp_to_ns(msg.header.stamp)
            if stamp_ns <= last_ns:
                self._skip("a stamp that is not later than the one before")
                continue
            try:
                base_T_sensor = self._sensor_pose(msg.header.frame_id, stamp_ns)
                scan, pose = planar_scan(msg, base_T_sensor)
            except (InvalidInputError, InvalidValueError) as error:
                self._skip(str(error))
                continue
            last_ns = stamp_ns
            yield RecordedScan(stamp_ns, scan, pose, self._odometry_at(stamp_ns))

    def _read_transforms(self) -> None:
        for topic in _TRANSFORMS:
            for msg in self._messages([topic], "tf2_msgs/msg/TFMessage"):
                for each in msg.transforms:
                    self._set(
                        each.header,
                        each.child_frame_id,
                        transform_from_msg(each.transform),
                        is_static=topic == "/tf_static",
                    )

    def _choose_odometry(self) -> str:
        """Return where odometry comes from: a topic, /tf, or none."""
        source = self.source
        if source.odometry == NO_ODOMETRY:
            return NO_ODOMETRY
        if not source.odometry and self._is_known(source.odom_frame, source.base_frame):
            return _TRANSFORMS[0]
        try:
            topic = _chosen(self._reader, _ODOMETRY, source.odometry, _USUAL_ODOMETRY)
        except UnknownNameError:
            if source.odometry:
                raise
            return NO_ODOMETRY
        self._odometry_frames = ("", "")
        self._buffer_of_odometry(topic)
        return topic

    def _buffer_of_odometry(self, topic: str) -> None:
        """Put a topic's poses into a tree of their own, with the static transforms."""
        for msg in self._messages([topic], _ODOMETRY):
            p, q = msg.pose.pose.position, msg.pose.pose.orientation
            pose = Transform3((p.x, p.y, p.z), (q.x, q.y, q.z, q.w))
            child = msg.child_frame_id or self.source.base_frame
            self._odometry_frames = (_OF_TOPIC, f"{_OF_TOPIC}{child}")
            self._set(msg.header, f"{_OF_TOPIC}{child}", pose, parent=_OF_TOPIC)

    def _odometry_at(self, stamp_ns: int) -> Pose2 | None:
        if self.odometry == NO_ODOMETRY:
            return None
        base = self.source.base_frame
        try:
            if self.odometry == _TRANSFORMS[0]:
                return _planar(
                    self._buffer.lookup(self.source.odom_frame, base, stamp_ns)[0]
                )
            odom, child = self._odometry_frames
            pose = self._buffer.lookup(odom, child, stamp_ns)[0]
            frame = child.removeprefix(_OF_TOPIC)
            if frame != base and self._is_known(frame, base):
                pose = pose @ self._buffer.lookup(frame, base, stamp_ns)[0]
            return _planar(pose)
        except TransformException:
            return None

    def _sensor_pose(self, frame_id: str, stamp_ns: int) -> Transform3:
        base = self.source.base_frame
        if not self._is_known(base, frame_id):
            problem = (
                f"no transform from {base!r} to {frame_id!r}: the scanner is taken to "
                "be at the base"
            )
            if problem not in self.problems:
                self.problems.append(problem)
            return Transform3.identity()
        for stamp in (stamp_ns, 0):  # 0: the newest, before the first one
            try:
                return self._buffer.lookup(base, frame_id, stamp)[0]
            except TransformException:
                continue
        raise InvalidInputError(
            "no_transform", f"from {base!r} to {frame_id!r} at {stamp_ns / 1e9:.3f} s"
        )

    def _is_known(self, target: str, source: str) -> bool:
        try:
            self._buffer.newest_common_ns(target, source)
        except TransformException:
            return False
        return True

    def _set(
        self,
        header: Any,
        child: str,
        pose: Transform3,
        *,
        parent: str = "",
        is_static: bool = False,
    ) -> None:
        try:
            self._buffer.set(
                parent or header.frame_id,
                child,
                stamp_to_ns(header.stamp),
                pose,
                is_static=is_static,
            )
        except (TransformException, NavetteError) as error:
            self._skip(f"transform: {error}")

    def _messages(self, names: list[str], type_name: str) -> Iterator[Any]:
        for message in self._reader.messages(names, on_damage=self._on_damage):
            if message.topic.type_name != type_name:
                continue
            decoder = self._decoders.get(message.topic)
            if decoder is None:
                decoder = self._decoders[message.topic] = Decoder(message.topic)
            yield decoder(message.data)

    def _skip(self, problem: str) -> None:
        self.skipped += 1
        if problem not in self.problems and len(self.problems) < _MOST_PROBLEMS:
            self.problems.append(problem)


_OF_TOPIC = "odometry of a topic/"
_MOST_PROBLEMS = 10


def _planar(transform: Transform3) -> Pose2:
    (x, y, _), rotation = transform
    return Pose2(x, y, yaw_of(rotation))


def _chosen(
    reader: BagReader, type_name: str, wanted: str, usual: tuple[str, ...]
) -> str:
    """Return a topic of a type: the wanted, a usual, or the most frequent one.

    Raises:
        UnknownNameError: there is none.
    """
    counts = {
        topic.name: count
        for topic, count in reader.counts().items()
        if topic.type_name == type_name and count
    }
    if wanted:
        name = wanted if wanted.startswith("/") else f"/{wanted}"
        if name not in counts:
            raise UnknownNameError.of(f"topic of {type_name}", name, sorted(counts))
        return name
    for name in usual:
        if name in counts:
            return name
    if not counts:
        names = sorted({topic.name for topic in reader.topics})
        raise UnknownNameError(
            f"{reader.path}: no messages of {type_name}; topics: "
            f"{', '.join(names) or 'none'}"
        )
    return min(counts, key=lambda name: (-counts[name], name))
