"""Server of interactive markers: publishes changes, dispatches what users do."""

from collections.abc import Callable
from copy import deepcopy
from dataclasses import dataclass, field
from threading import RLock
from typing import Any

from navette.msgs.builtin_interfaces.msg import Time
from navette.msgs.geometry_msgs.msg import Pose
from navette.msgs.std_msgs.msg import Header
from navette.msgs.visualization_msgs.msg import (
    InteractiveMarker,
    InteractiveMarkerFeedback,
    InteractiveMarkerPose,
    InteractiveMarkerUpdate,
)
from navette.msgs.visualization_msgs.srv import GetInteractiveMarkers
from navette.runtime import Duration, Node, QoSProfile

FeedbackCallback = Callable[[InteractiveMarkerFeedback], Any]
#: How long one client keeps a marker to itself.
_CLAIM = Duration(seconds=1.0)


@dataclass
class _User:
    """Client that changed a marker last."""

    client_id: str
    at: Any


@dataclass
class _Changes:
    """What :meth:`InteractiveMarkerServer.applyChanges` will publish."""

    markers: dict[str, InteractiveMarker] = field(default_factory=dict)
    poses: dict[str, tuple[Pose, Header]] = field(default_factory=dict)
    erased: set[str] = field(default_factory=set)

    def forget(self, name: str) -> None:
        self.markers.pop(name, None)
        self.poses.pop(name, None)
        self.erased.discard(name)

    def is_empty(self) -> bool:
        return not (self.markers or self.poses or self.erased)


class InteractiveMarkerServer:
    """Interactive markers below ``namespace``, with RViz and other clients.

    Changes are published by :meth:`applyChanges`; callbacks change at once.

    Args:
        node: publishes ``NAMESPACE/update``, receives ``NAMESPACE/feedback``.
        namespace: of the topics and of the service.
        update_pub_qos, feedback_sub_qos: of the two topics.
    """

    DEFAULT_FEEDBACK_CALLBACK = 255

    def __init__(
        self,
        node: Node,
        namespace: str,
        *,
        update_pub_qos: Any = None,
        feedback_sub_qos: Any = None,
    ) -> None:
        self.node = node
        self.namespace = namespace
        self.seq_num = 0
        self._lock = RLock()
        self._markers: dict[str, InteractiveMarker] = {}
        self._callbacks: dict[str, dict[int, FeedbackCallback]] = {}
        self._users: dict[str, _User] = {}
        self._changes = _Changes()
        self._service: Any = node.create_service(
            GetInteractiveMarkers,
            f"{namespace}/get_interactive_markers",
            self.getInteractiveMarkersCallback,
        )
        self._publisher: Any = node.create_publisher(
            InteractiveMarkerUpdate,
            f"{namespace}/update",
            update_pub_qos or QoSProfile(depth=100),
        )
        self._subscription: Any = node.create_subscription(
            InteractiveMarkerFeedback,
            f"{namespace}/feedback",
            self.processFeedback,
            feedback_sub_qos or QoSProfile(depth=1),
        )

    def shutdown(self) -> None:
        """Erase all markers and leave the topics; before the node is destroyed."""
        if self._publisher is None:
            return
        if self.node.context.ok():
            self.clear()
            self.applyChanges()
        self.node.destroy_service(self._service)
        self.node.destroy_publisher(self._publisher)
        self.node.destroy_subscription(self._subscription)
        self._service = self._publisher = self._subscription = None

    def insert(
        self,
        marker: InteractiveMarker,
        *,
        feedback_callback: FeedbackCallback | None = None,
        feedback_type: int = DEFAULT_FEEDBACK_CALLBACK,
    ) -> None:
        """Add a marker, or replace the one of the same name."""
        with self._lock:
            self._changes.forget(marker.name)
            self._changes.markers[marker.name] = deepcopy(marker)
        if feedback_callback is not None:
            self.setCallback(marker.name, feedback_callback, feedback_type)

    def setPose(  # noqa: N802 - ROS 2's name
        self, name: str, pose: Pose, header: Header | None = None
    ) -> bool:
        """Move a marker; return whether it exists and is not about to be replaced."""
        with self._lock:
            known = self._markers.get(name)
            if known is None or name in self._changes.markers:
                return False
            given = header if header is not None and header.frame_id else known.header
            self._changes.poses[name] = (deepcopy(pose), deepcopy(given))
            return True

    def erase(self, name: str) -> bool:
        """Remove a marker; return whether it exists."""
        with self._lock:
            exists = name in self._markers or name in self._changes.markers
            self._changes.forget(name)
            if exists:
                self._changes.erased.add(name)
            return exists

    def clear(self) -> None:
        """Remove all markers."""
        with self._lock:
            self._changes = _Changes()
            for name in self._markers:
                self.erase(name)

    def setCallback(  # noqa: N802 - ROS 2's name
        self,
        name: str,
        feedback_callback: FeedbackCallback | None,
        feedback_type: int = DEFAULT_FEEDBACK_CALLBACK,
    ) -> bool:
        """Set what is called for one type of feedback, or for all others (default).

        None removes the callback. Return whether the marker exists.
        """
        with self._lock:
            if name not in self._markers and name not in self._changes.markers:
                return False
            callbacks = self._callbacks.setdefault(name, {})
            if feedback_callback is None:
                callbacks.pop(feedback_type, None)
            else:
                callbacks[feedback_type] = feedback_callback
            return True

    def applyChanges(self) -> None:  # noqa: N802 - ROS 2's name
        """Publish all changes since the last call."""
        with self._lock:
            changes, self._changes = self._changes, _Changes()
            if changes.is_empty():
                return
            update = InteractiveMarkerUpdate(type=InteractiveMarkerUpdate.UPDATE)
            self._markers |= changes.markers
            update.markers = list(changes.markers.values())
            for name, (pose, header) in changes.poses.items():
                marker = self._markers[name]
                marker.pose, marker.header = pose, header
                moved = InteractiveMarkerPose(header=header, pose=pose, name=name)
                update.poses.append(moved)
            for name in changes.erased:
                if self._markers.pop(name, None) is not None:
                    update.erases.append(name)
                self._callbacks.pop(name, None)
                self._users.pop(name, None)
            self.seq_num += 1
        self.publish(update)

    def get(self, name: str) -> InteractiveMarker | None:
        """Return a copy of a marker with its changes, or None."""
        with self._lock:
            if name in self._changes.erased:
                return None
            marker = self._changes.markers.get(name, self._markers.get(name))
            marker = deepcopy(marker)
            if marker is not None and name in self._changes.poses:
                marker.pose, marker.header = deepcopy(self._changes.poses[name])
            return marker

    def processFeedback(  # noqa: N802 - ROS 2's name
        self, feedback: InteractiveMarkerFeedback
    ) -> None:
        """Apply what a user did and call the marker's callback."""
        name = feedback.marker_name
        with self._lock:
            marker = self._markers.get(name)
            if marker is None or not self._claim(name, feedback.client_id):
                return
            if feedback.event_type == InteractiveMarkerFeedback.POSE_UPDATE:
                # A marker without a stamp stays fixed to its frame.
                is_fixed = marker.header.stamp == Time()
                header = marker.header if is_fixed else feedback.header
                self.setPose(name, feedback.pose, header)
            callbacks = self._callbacks.get(name, {})
            default = callbacks.get(self.DEFAULT_FEEDBACK_CALLBACK)
            callback = callbacks.get(feedback.event_type, default)
        if callback is not None:
            callback(feedback)
        self.applyChanges()

    def _claim(self, name: str, client_id: str) -> bool:
        """Return whether a client may change a marker now."""
        now = self.node.get_clock().now()
        user = self._users.get(name)
        is_other = user is not None and user.client_id != client_id
        if is_other and user is not None and now - user.at < _CLAIM:
            self.node.get_logger().debug(
                f"feedback for {name!r} of client {client_id!r} ignored: "
                f"{user.client_id!r} moves it"
            )
            return False
        self._users[name] = _User(client_id, now)
        return True

    def publish(self, update: InteractiveMarkerUpdate) -> None:
        """Publish an update with the present sequence number."""
        update.seq_num = self.seq_num
        self._publisher.publish(update)

    def getInteractiveMarkersCallback(  # noqa: N802 - ROS 2's name
        self, request: Any, response: Any
    ) -> Any:
        """Answer a new client with all markers."""
        with self._lock:
            response.sequence_number = self.seq_num
            response.markers = list(self._markers.values())
        return response
