"""A goal sent by a test: acceptance, feedback, status and result."""

from typing import Any

from navette.msgs.action_msgs.msg import GoalStatus
from navette.runtime import ActionClient, Future, Node
from navette.runtime.action.client import ClientGoalHandle


class GoalProbe:
    """Collects what an action server returns for one goal.

    Args:
        node: the client's node.
        action: the action's type.
        name: the action's name.
        goal: the goal to send.
    """

    def __init__(self, node: Node, action: Any, name: str, goal: Any) -> None:
        self.feedback: list[Any] = []
        self.accepted: bool | None = None
        self.status: int = GoalStatus.STATUS_UNKNOWN
        self.result: Any = None
        #: Time (ns) at which the result arrived.
        self.done_ns: int | None = None
        self._node = node
        self._handle: ClientGoalHandle | None = None
        self._client = ActionClient(node, action, name)
        sent = self._client.send_goal_async(
            goal, feedback_callback=lambda msg: self.feedback.append(msg.feedback)
        )
        sent.add_done_callback(self._on_response)

    @property
    def done(self) -> bool:
        """Whether the goal was rejected or has a result."""
        return self.accepted is False or self.result is not None

    def cancel(self) -> None:
        """Request that the goal is cancelled; it must have been accepted."""
        assert self._handle is not None, "the goal has not been accepted"
        self._handle.cancel_goal_async()

    def _on_response(self, future: Future[Any]) -> None:
        handle: Any = future.result()
        self.accepted = handle.accepted
        if handle.accepted:
            self._handle = handle
            handle.get_result_async().add_done_callback(self._on_result)

    def _on_result(self, future: Future[Any]) -> None:
        response: Any = future.result()
        if response is None:  # the client was destroyed
            return
        self.status, self.result = response.status, response.result
        self.done_ns = self._node.get_clock().now().nanoseconds
