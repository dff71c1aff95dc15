"""Action servers: three services, two topics, and the state of the goals."""

import traceback
from collections.abc import Callable
from typing import Any

from navette.errors import MessageError
from navette.msgs import type_name
from navette.msgs.action_msgs.msg import GoalInfo, GoalStatus, GoalStatusArray
from navette.msgs.unique_identifier_msgs.msg import UUID
from navette.runtime.action.cancelling import goals_to_cancel
from navette.runtime.action.goal_states import CancelResponse, GoalEvent, GoalResponse
from navette.runtime.action.server_goal_handle import ServerGoalHandle
from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.events import Call
from navette.runtime.exceptions import RCLError
from navette.runtime.executor import await_or_execute
from navette.runtime.future import Future
from navette.runtime.node import Node
from navette.runtime.qos import (
    QoSProfile,
    qos_profile_action_status_default,
    qos_profile_services_default,
)
from navette.runtime.time import seconds_to_ns
from navette.runtime.type_support import interface_name
from navette.runtime.waitable import Waitable
from navette.transports import RequestId

__all__ = [
    "ActionServer",
    "CancelResponse",
    "GoalEvent",
    "GoalResponse",
    "RCLError",
    "ServerGoalHandle",
    "default_cancel_callback",
    "default_goal_callback",
    "default_handle_accepted_callback",
]


def default_handle_accepted_callback(goal_handle: ServerGoalHandle) -> None:
    """Execute the goal immediately."""
    goal_handle.execute()


def default_goal_callback(goal_request: Any) -> GoalResponse:
    """Accept the goal."""
    return GoalResponse.ACCEPT


def default_cancel_callback(cancel_request: Any) -> CancelResponse:
    """Reject the cancel request."""
    return CancelResponse.REJECT


class ActionServer(Waitable[Any]):
    """Accepts goals and executes them; callbacks may be coroutine functions.

    Args:
        execute_callback: ``callback(goal_handle) -> Result``, for each goal.
        goal_callback: ``callback(goal) -> GoalResponse``; default: accept.
        handle_accepted_callback: ``callback(goal_handle)``; default: execute the goal.
        cancel_callback: ``callback(goal_handle) -> CancelResponse``; default: reject.
        result_timeout: seconds for which a result is stored; negative: no limit.
    """

    def __init__(
        self,
        node: Node,
        action_type: Any,
        action_name: str,
        execute_callback: Callable[[ServerGoalHandle], Any],
        *,
        callback_group: CallbackGroup | None = None,
        goal_callback: Callable[[Any], Any] | None = default_goal_callback,
        handle_accepted_callback: Callable[[ServerGoalHandle], Any]
        | None = default_handle_accepted_callback,
        cancel_callback: Callable[[Any], Any] | None = default_cancel_callback,
        goal_service_qos_profile: QoSProfile = qos_profile_services_default,
        result_service_qos_profile: QoSProfile = qos_profile_services_default,
        cancel_service_qos_profile: QoSProfile = qos_profile_services_default,
        feedback_pub_qos_profile: QoSProfile | None = None,
        status_pub_qos_profile: QoSProfile = qos_profile_action_status_default,
        result_timeout: float = 10,
    ) -> None:
        interface_name(action_type, "action")
        super().__init__(callback_group or node.default_callback_group)
        self.register_handle_accepted_callback(handle_accepted_callback)
        self.register_goal_callback(goal_callback)
        self.register_cancel_callback(cancel_callback)
        self.register_execute_callback(execute_callback)
        self._node = node
        self._action_type = action_type
        self._loop = node.context.loop
        self._logger = node.get_logger().get_child("action_server")
        self._result_timeout_ns = seconds_to_ns(float(result_timeout))
        self._goals: dict[bytes, ServerGoalHandle] = {}
        self._expiries: dict[bytes, Call] = {}
        impl = action_type.Impl

        def serve(service: Any, name: str, callback: Any, qos: QoSProfile) -> Any:
            return node._node_serve(
                type_name(service),
                f"{action_name}/_action/{name}",
                callback,
                qos_profile=qos,
                callback_group=callback_group,
                deferred=True,
            )

        self._goal_service = serve(
            impl.SendGoalService, "send_goal", self._on_goal, goal_service_qos_profile
        )
        self._cancel_service = serve(
            impl.CancelGoalService,
            "cancel_goal",
            self._on_cancel,
            cancel_service_qos_profile,
        )
        self._result_service = serve(
            impl.GetResultService,
            "get_result",
            self._on_get_result,
            result_service_qos_profile,
        )
        self._feedback = node.create_publisher(
            impl.FeedbackMessage,
            f"{action_name}/_action/feedback",
            feedback_pub_qos_profile or QoSProfile(depth=10),
        )
        self._status = node.create_publisher(
            GoalStatusArray, f"{action_name}/_action/status", status_pub_qos_profile
        )
        node.add_waitable(self)

    @property
    def action_type(self) -> Any:
        return self._action_type

    @property
    def action_name(self) -> str:
        """Full name."""
        return self._feedback.topic_name.removesuffix("/_action/feedback")

    def register_handle_accepted_callback(
        self, handle_accepted_callback: Callable[[ServerGoalHandle], Any] | None
    ) -> None:
        """Set the callback for accepted goals; None: execute them immediately."""
        self._handle_accepted_callback = (
            handle_accepted_callback or default_handle_accepted_callback
        )

    def register_goal_callback(
        self, goal_callback: Callable[[Any], Any] | None
    ) -> None:
        """Set the callback that accepts or rejects goals; None: accept all."""
        self._goal_callback = goal_callback or default_goal_callback

    def register_cancel_callback(
        self, cancel_callback: Callable[[Any], Any] | None
    ) -> None:
        """Set the callback that decides on cancel requests; None: reject all."""
        self._cancel_callback = cancel_callback or default_cancel_callback

    def register_execute_callback(
        self, execute_callback: Callable[[ServerGoalHandle], Any]
    ) -> None:
        """Set the callback that executes a goal and returns its result."""
        if not callable(execute_callback):
            raise TypeError(
                "failed to register goal execution callback: "
                f"{execute_callback!r} is not callable"
            )
        self._execute_callback = execute_callback

    def notify_execute(
        self,
        goal_handle: ServerGoalHandle,
        execute_callback: Callable[..., Any] | None,
    ) -> None:
        """Run the execute callback as a task of the loop."""
        self._loop.create_task(
            self._execute_goal,
            execute_callback or self._execute_callback,
            goal_handle,
            source=f"action {self.action_name}",
            node=self._node.get_fully_qualified_name(),
            step_group=self._step_group(),
        )

    def _step_group(self) -> CallbackGroup | None:
        """Return the group whose threads execute goals, beside those of the group."""
        threads = self.callback_group.threads
        return None if threads is None else threads.free_group

    def notify_goal_done(self, goal_handle: ServerGoalHandle) -> None:
        """Schedule the removal of the goal and its result."""
        if self._result_timeout_ns < 0:
            return
        key = bytes(goal_handle.goal_id.uuid)
        self._expiries[key] = self._loop.call_at(
            self._loop.clock.now_ns + self._result_timeout_ns,
            lambda: self._expire(key),
            f"action {self.action_name}",
            self._node.get_fully_qualified_name(),
        )

    @property
    def feedback_subscription_count(self) -> int:
        """Number of matched subscriptions to the feedback."""
        return self._feedback.get_subscription_count()

    def publish_feedback(self, goal_id: UUID, feedback: Any) -> None:
        message = self._action_type.Impl.FeedbackMessage
        self._feedback.publish(message(goal_id=goal_id, feedback=feedback))

    def publish_status(self) -> None:
        """Publish the states of all stored goals.

        A message has all goals of the last ``result_timeout``, hundreds if goals are
        short: their states are not copied.
        """
        states = [goal.status_message for goal in self._goals.values()]
        self._status.hand_over(GoalStatusArray(status_list=states))

    def set_result(self, goal_handle: ServerGoalHandle, result: Any) -> None:
        """Respond to the requests for the goal's result; only the first result counts.

        Raises:
            MessageError: ``result`` is of another type (also a TypeError).
        """
        expected = self._action_type.Result
        if not isinstance(result, expected):
            raise MessageError(
                f"action {self.action_name}: the execute callback must return its "
                f"{type_name(expected)}, got {result!r}"
            )
        if not goal_handle.result.done():
            response = self._action_type.Impl.GetResultService.Response
            goal_handle.result.set_result(
                response(status=goal_handle.status, result=result)
            )

    def destroy(self) -> None:
        """Leave the graph and destroy all goals."""
        for call in self._expiries.values():
            call.cancel()
        for goal in self._goals.values():
            goal.destroy()
        for service in (self._goal_service, self._cancel_service, self._result_service):
            self._node.destroy_service(service)
        self._node.destroy_publisher(self._feedback)
        self._node.destroy_publisher(self._status)
        self._node.remove_waitable(self)

    async def _on_goal(self, request: Any, request_id: RequestId) -> None:
        key = bytes(request.goal_id.uuid)
        response = self._action_type.Impl.SendGoalService.Response()
        if key not in self._goals:
            decision = await await_or_execute(self._goal_callback, request.goal)
            # While the callback awaits, a request of the same id may arrive.
            is_new = key not in self._goals
            response.accepted = is_new and decision is GoalResponse.ACCEPT
            if not isinstance(decision, GoalResponse):
                self._logger.warning(
                    f"goal rejected: the goal callback returned {decision!r}, not a "
                    "GoalResponse"
                )
        if not response.accepted:
            self._goal_service.send_response(response, request_id)
            return
        response.stamp = self._node.get_clock().now().to_msg()
        goal_info = GoalInfo(goal_id=request.goal_id, stamp=response.stamp)
        goal = ServerGoalHandle(self, goal_info, request.goal)
        self._goals[key] = goal
        self._goal_service.send_response(response, request_id)
        self.publish_status()
        await await_or_execute(self._handle_accepted_callback, goal)

    async def _execute_goal(
        self, callback: Callable[..., Any], goal: ServerGoalHandle
    ) -> None:
        try:
            result = await await_or_execute(callback, goal)
        except Exception as error:
            # As in rclpy: the goal ends, and the server serves the next one.
            shown = "".join(traceback.format_exception(error))
            self._logger.error(f"error in the execute callback: {error!r}\n{shown}")
            self._end_without_result(goal)
            return
        try:
            if result is not None or not goal.result.done():
                self._finish(goal, result)
        except MessageError:
            # Re-raised after the client got a result: it must not wait indefinitely.
            self._end_without_result(goal)
            raise

    def _end_without_result(self, goal: ServerGoalHandle) -> None:
        if goal.is_active:
            goal.abort()
        self.set_result(goal, self._action_type.Result())

    def _finish(self, goal: ServerGoalHandle, result: Any) -> None:
        if goal.is_active:
            self._logger.warning(
                "Goal state not set, assuming aborted. "
                f"Goal ID: {bytes(goal.goal_id.uuid).hex()}"
            )
            goal.abort()
        self.set_result(goal, result)

    async def _on_cancel(self, request: Any, request_id: RequestId) -> None:
        response = self._action_type.Impl.CancelGoalService.Response()
        response.return_code, candidates = goals_to_cancel(
            request.goal_info, self._goals
        )
        canceling = []
        for goal in candidates:
            decision = await await_or_execute(self._cancel_callback, goal)
            # The goal may have ended while the callback awaited.
            if decision is CancelResponse.ACCEPT and goal.is_active:
                goal.update_state(GoalEvent.CANCEL_GOAL)
                canceling.append(goal.goal_info)
        if candidates and not canceling:
            response.return_code = response.ERROR_REJECTED
        response.goals_canceling = canceling
        self._cancel_service.send_response(response, request_id)

    def _on_get_result(self, request: Any, request_id: RequestId) -> None:
        goal = self._goals.get(bytes(request.goal_id.uuid))
        if goal is None:
            self._logger.warning(
                "Sending result response for unknown or expired goal ID: "
                f"{bytes(request.goal_id.uuid).hex()}"
            )
            response = self._action_type.Impl.GetResultService.Response
            unknown = response(status=GoalStatus.STATUS_UNKNOWN)
            self._result_service.send_response(unknown, request_id)
            return

        def respond(future: Future[Any]) -> None:
            self._result_service.send_response(future.result(), request_id)

        goal.result.add_done_callback(respond)

    def _expire(self, key: bytes) -> None:
        self._goals.pop(key).destroy()
        del self._expiries[key]
