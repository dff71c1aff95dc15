"""What the nodes of a behaviour tree use of the robot: time, pose, servers, topics.

The missions node implements these protocols; tests use fakes.
"""

from dataclasses import dataclass
from typing import Any, Protocol

from navette.geometry import Pose2
from navette.msgs.nav_msgs.msg import Path

SUCCEEDED = "succeeded"
ABORTED = "aborted"
CANCELED = "canceled"
REJECTED = "rejected"
UNAVAILABLE = "unavailable"
"""The server does not exist or stopped responding."""


@dataclass(frozen=True)
class CallResult:
    """End of a call.

    Attributes:
        how: succeeded, aborted, canceled, rejected or unavailable.
        message: result of the action or response of the service; None without one.
        reason: explanation for people; empty on success.
    """

    how: str
    message: Any = None
    reason: str = ""


class ServerCall(Protocol):
    """A goal that an action server executes, or a request to a service."""

    @property
    def result(self) -> CallResult | None:
        """The end; None until then."""

    @property
    def feedback(self) -> Any:
        """The newest feedback; None before the first."""

    def cancel(self) -> None:
        """Request the end; the result follows."""


class RobotAccess(Protocol):
    """Time, pose, servers and topics, as the tree's nodes need them."""

    @property
    def now_ns(self) -> int: ...

    @property
    def map_frame(self) -> str: ...

    @property
    def base_frame(self) -> str: ...

    def pose(self) -> Pose2 | None:
        """Return the newest map_T_base; None before the first."""

    def velocity(self) -> tuple[float, float]:
        """Return forward speed (m/s) and turn rate (rad/s) of the base."""

    def has_transform(self, target: str, source: str) -> bool: ...

    def navigate(self, goal: Any) -> ServerCall:
        """Drive to a PoseStamped by planner and control, which run on their own."""

    def driven_path(self, distance_m: float) -> Path | None:
        """Return the path back along the last driven metres; None without motion."""

    def start_action(self, action_type: str, name: str, goal: Any) -> ServerCall: ...

    def call_service(
        self, service_type: str, name: str, request: Any
    ) -> ServerCall: ...

    def cancel_all(self, action_type: str, name: str) -> ServerCall:
        """Cancel all goals of an action server."""

    def newest(self, topic: str, message_type: str, *, latched: bool = False) -> Any:
        """Return the newest message; None before the first.

        Subscribes on the first call.
        """
