"""Goal handle of an action server."""

from collections.abc import Callable
from typing import Any, Protocol

from navette.msgs import copy_message
from navette.msgs.action_msgs.msg import GoalInfo, GoalStatus
from navette.msgs.unique_identifier_msgs.msg import UUID
from navette.runtime.action.goal_states import GoalEvent, is_active, next_status
from navette.runtime.future import Future
from navette.runtime.type_support import check_type


class GoalOwner(Protocol):
    """The part of an action server that its goal handles use."""

    @property
    def action_type(self) -> Any: ...
    @property
    def action_name(self) -> str: ...
    def notify_execute(
        self,
        goal_handle: "ServerGoalHandle",
        execute_callback: Callable[..., Any] | None,
    ) -> None: ...
    def notify_goal_done(self, goal_handle: "ServerGoalHandle") -> None: ...
    def publish_feedback(self, goal_id: UUID, feedback: Any) -> None: ...
    def publish_status(self) -> None: ...
    def set_result(self, goal_handle: "ServerGoalHandle", result: Any) -> None: ...


class ServerGoalHandle:
    """An accepted goal: its request, state and feedback."""

    def __init__(
        self, action_server: GoalOwner, goal_info: GoalInfo, goal_request: Any
    ) -> None:
        self._action_server = action_server
        self._goal_info = goal_info
        self._goal_request = goal_request
        self._status = GoalStatus.STATUS_ACCEPTED
        self._destroyed = False
        self._status_message = self._new_status_message()
        #: The response to get_result requests.
        self.result: Future[Any] = Future()

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, ServerGoalHandle):
            return NotImplemented
        return bool(self.goal_id == other.goal_id)

    def __hash__(self) -> int:
        return hash(bytes(self.goal_id.uuid))

    @property
    def request(self) -> Any:
        """The goal message."""
        return self._goal_request

    @property
    def goal_id(self) -> UUID:
        return self._goal_info.goal_id

    @property
    def goal_info(self) -> GoalInfo:
        """Id and time of acceptance."""
        return self._goal_info

    @property
    def is_active(self) -> bool:
        """Whether the goal has not reached a terminal state."""
        return not self._destroyed and is_active(self._status)

    @property
    def is_cancel_requested(self) -> bool:
        return self.status == GoalStatus.STATUS_CANCELING

    @property
    def status(self) -> int:
        return GoalStatus.STATUS_UNKNOWN if self._destroyed else self._status

    @property
    def status_message(self) -> GoalStatus:
        """The present state; another object after each change, and never changed."""
        return self._status_message

    def execute(self, execute_callback: Callable[..., Any] | None = None) -> None:
        """Run the execute callback (default: the server's) as a task."""
        # Cancelling may be requested before the start; the callback handles that.
        if not self.is_cancel_requested:
            self.update_state(GoalEvent.EXECUTE)
        self._action_server.notify_execute(self, execute_callback)

    def publish_feedback(self, feedback: Any) -> None:
        """Send feedback to the client.

        Raises:
            MessageError: ``feedback`` is of another type (also a TypeError).
        """
        expected = self._action_server.action_type.Feedback
        check_type(feedback, expected, f"action {self._action_server.action_name}")
        if not self._destroyed:
            self._action_server.publish_feedback(self.goal_id, feedback)

    def succeed(self, response: Any = None) -> None:
        """Mark the goal as reached; default result: that of the execute callback."""
        self.update_state(GoalEvent.SUCCEED)
        self._respond(response)

    def abort(self, response: Any = None) -> None:
        """Mark the goal as aborted; default result: that of the execute callback."""
        self.update_state(GoalEvent.ABORT)
        self._respond(response)

    def canceled(self, response: Any = None) -> None:
        """Mark the goal as cancelled on the client's request."""
        self.update_state(GoalEvent.CANCELED)
        self._respond(response)

    def update_state(self, event: GoalEvent) -> None:
        """Apply an event and publish the new state.

        Raises:
            RCLError: the event is invalid in the goal's state.
        """
        if self._destroyed:
            return
        self._status = next_status(self._status, event)
        self._status_message = self._new_status_message()
        self._action_server.publish_status()
        if not self.is_active:
            self._action_server.notify_goal_done(self)

    def destroy(self) -> None:
        """Invalidate the handle; later calls have no effect."""
        self._destroyed = True

    def _new_status_message(self) -> GoalStatus:
        # A copy: programs can change the goal's id and stamp.
        info = copy_message(self._goal_info)
        return GoalStatus(goal_info=info, status=self._status)

    def _respond(self, response: Any) -> None:
        if response is not None:
            self._action_server.set_result(self, response)
