"""Action clients: send goals, receive feedback and results."""

import uuid
from collections.abc import Callable
from typing import Any
from weakref import WeakValueDictionary

from navette.msgs.action_msgs.msg import GoalInfo, GoalStatus, GoalStatusArray
from navette.msgs.action_msgs.srv import CancelGoal
from navette.msgs.builtin_interfaces.msg import Time as TimeMsg
from navette.msgs.unique_identifier_msgs.msg import UUID
from navette.runtime.action.goal_states import STATUS_NAMES, is_active
from navette.runtime.action.result_request import ResultRequest
from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.callback_threads import group_of_this_thread
from navette.runtime.exceptions import ROSInterruptException
from navette.runtime.future import Future, ResponseFuture
from navette.runtime.node import Node
from navette.runtime.qos import (
    QoSProfile,
    qos_profile_action_status_default,
    qos_profile_services_default,
)
from navette.runtime.strict_mode import check_wait
from navette.runtime.time import seconds_to_ns
from navette.runtime.type_support import check_type, interface_name
from navette.runtime.waitable import Waitable


class ClientGoalHandle:
    """Goal handle of an action client."""

    def __init__(
        self, action_client: "ActionClient", goal_id: UUID, goal_response: Any
    ) -> None:
        self._action_client = action_client
        self._goal_id = goal_id
        self._goal_response = goal_response
        #: The last status received on the status topic.
        self.status: int = GoalStatus.STATUS_UNKNOWN

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, ClientGoalHandle):
            return NotImplemented
        return bool(self._goal_id == other.goal_id)

    def __hash__(self) -> int:
        return hash(bytes(self._goal_id.uuid))

    def __repr__(self) -> str:
        return (
            f"ClientGoalHandle <id={bytes(self._goal_id.uuid).hex()}, "
            f"accepted={self.accepted}, status={STATUS_NAMES[self.status]}>"
        )

    @property
    def goal_id(self) -> UUID:
        return self._goal_id

    @property
    def stamp(self) -> TimeMsg:
        """Time at which the server accepted the goal."""
        stamp: TimeMsg = self._goal_response.stamp
        return stamp

    @property
    def accepted(self) -> bool:
        return bool(self._goal_response.accepted)

    def cancel_goal_async(self) -> Future[Any]:
        """Request cancelling; the future gets the CancelGoal response."""
        return self._action_client.request_cancel(self)

    def get_result_async(self) -> Future[Any]:
        """Request the result; the future gets a response with status and result."""
        return self._action_client.request_result(self)

    def cancel_goal(self) -> Any:
        """Request cancelling and run events until the response arrives."""
        return self._action_client.wait_for(self.cancel_goal_async())

    def get_result(self) -> Any:
        """Request the result and run events until it arrives."""
        return self._action_client.wait_for(self.get_result_async())


class ActionClient(Waitable[Any]):
    """Sends goals to an action server."""

    def __init__(
        self,
        node: Node,
        action_type: Any,
        action_name: str,
        *,
        callback_group: CallbackGroup | None = None,
        goal_service_qos_profile: QoSProfile = qos_profile_services_default,
        result_service_qos_profile: QoSProfile = qos_profile_services_default,
        cancel_service_qos_profile: QoSProfile = qos_profile_services_default,
        feedback_sub_qos_profile: QoSProfile | None = None,
        status_sub_qos_profile: QoSProfile = qos_profile_action_status_default,
    ) -> None:
        interface_name(action_type, "action")
        super().__init__(callback_group or node.default_callback_group)
        self._node = node
        self._action_type = action_type
        self._loop = node.context.loop
        self._goals: WeakValueDictionary[bytes, ClientGoalHandle] = (
            WeakValueDictionary()
        )
        self._feedback_callbacks: dict[bytes, Callable[[Any], Any]] = {}
        self._sent = 0
        impl = action_type.Impl

        def connect(service: Any, name: str, qos: QoSProfile) -> Any:
            return node.create_client(
                service,
                f"{action_name}/_action/{name}",
                qos_profile=qos,
                callback_group=callback_group,
            )

        self._goal_client = connect(
            impl.SendGoalService, "send_goal", goal_service_qos_profile
        )
        self._cancel_client = connect(
            impl.CancelGoalService, "cancel_goal", cancel_service_qos_profile
        )
        self._result_client = connect(
            impl.GetResultService, "get_result", result_service_qos_profile
        )
        self._feedback = node.create_subscription(
            impl.FeedbackMessage,
            f"{action_name}/_action/feedback",
            self._on_feedback,
            feedback_sub_qos_profile or QoSProfile(depth=10),
            callback_group=callback_group,
        )
        self._status = node.create_subscription(
            GoalStatusArray,
            f"{action_name}/_action/status",
            self._on_status,
            status_sub_qos_profile,
            callback_group=callback_group,
            shared=True,
        )
        # Processed also while a callback of the same group waits for the result.
        self._feedback.runs_during_calls = self._status.runs_during_calls = True
        node.add_waitable(self)

    @property
    def action_name(self) -> str:
        """Full name."""
        return self._feedback.topic_name.removesuffix("/_action/feedback")

    def send_goal_async(
        self,
        goal: Any,
        feedback_callback: Callable[[Any], Any] | None = None,
        goal_uuid: UUID | None = None,
    ) -> Future[ClientGoalHandle]:
        """Send a goal; the future gets a handle when the server has responded.

        Args:
            feedback_callback: called with the action's feedback messages.
            goal_uuid: id of the goal; generated if None.

        Raises:
            MessageError: ``goal`` is of another type (also a TypeError).
        """
        check_type(goal, self._action_type.Goal, f"action {self.action_name}")
        goal_id = self._new_id() if goal_uuid is None else goal_uuid
        key = bytes(goal_id.uuid)
        if feedback_callback is not None:
            self._feedback_callbacks[key] = feedback_callback
        request = self._action_type.Impl.SendGoalService.Request
        response = self._goal_client.call_async(request(goal_id=goal_id, goal=goal))
        future: Future[ClientGoalHandle] = ResponseFuture()

        def complete(_: object) -> None:
            if response.cancelled():
                future.cancel()
            elif response.exception() is not None:
                future.set_exception(response.exception())
            else:
                future.set_result(self._handle(goal_id, response.result()))

        response.add_done_callback(complete)
        return future

    def send_goal(self, goal: Any, **kwargs: Any) -> Any:
        """Send a goal, run events until its result arrives, and return the result."""
        handle = self.wait_for(self.send_goal_async(goal, **kwargs))
        return handle.get_result()

    def request_cancel(self, goal_handle: ClientGoalHandle) -> Future[Any]:
        """See :meth:`ClientGoalHandle.cancel_goal_async`."""
        info = GoalInfo(goal_id=goal_handle.goal_id)
        future: Future[Any] = self._cancel_client.call_async(
            CancelGoal.Request(goal_info=info)
        )
        return future

    def request_result(self, goal_handle: ClientGoalHandle) -> Future[Any]:
        """See :meth:`ClientGoalHandle.get_result_async`."""
        key = bytes(goal_handle.goal_id.uuid)
        request = self._action_type.Impl.GetResultService.Request
        future = ResultRequest(
            self._result_client,
            request(goal_id=goal_handle.goal_id),
            self._loop.clock,
        ).future
        future.add_done_callback(lambda _: self._feedback_callbacks.pop(key, None))
        return future

    def wait_for(self, future: Future[Any]) -> Any:
        """Run events until the future is done; return its result.

        Raises:
            ROSInterruptException: the context was shut down or the client destroyed.
            TimeoutError: no event is left that could complete it (virtual clock).
        """
        waiting = group_of_this_thread()
        check_wait(
            f"a wait for action {self.action_name}",
            in_driver_thread=self._loop.in_driver_thread,
            same_group=waiting is self._cancel_client.group,
            exclusive=self._cancel_client.group.exclusive,
        )
        self._loop.run(done=future.done, calling=True)
        if future.cancelled():
            raise ROSInterruptException
        if not future.done():
            servers = "" if self.server_is_ready() else " (the action has no server)"
            raise TimeoutError(f"action {self.action_name}: no response{servers}")
        return future.result()

    def server_is_ready(self) -> bool:
        """Return whether all services and topics of a server exist."""
        clients = (self._goal_client, self._cancel_client, self._result_client)
        topics = (self._feedback, self._status)
        return all(client.service_is_ready() for client in clients) and all(
            topic.get_publisher_count() for topic in topics
        )

    def wait_for_server(self, timeout_sec: float | None = None) -> bool:
        """Run events until a server is ready; False after the timeout."""
        until_ns = None
        if timeout_sec is not None:
            until_ns = self._loop.clock.now_ns + seconds_to_ns(float(timeout_sec))
        self._loop.run(until_ns=until_ns, done=self.server_is_ready)
        return self.server_is_ready()

    def destroy(self) -> None:
        """Leave the graph and cancel pending requests."""
        for each in (self._goal_client, self._cancel_client, self._result_client):
            self._node.destroy_client(each)
        self._node.destroy_subscription(self._feedback)
        self._node.destroy_subscription(self._status)
        self._node.remove_waitable(self)

    def _handle(self, goal_id: UUID, response: Any) -> ClientGoalHandle:
        handle = ClientGoalHandle(self, goal_id, response)
        key = bytes(goal_id.uuid)
        if handle.accepted:
            self._goals[key] = handle
        else:
            self._feedback_callbacks.pop(key, None)
        return handle

    def _on_feedback(self, message: Any) -> Any:
        callback = self._feedback_callbacks.get(bytes(message.goal_id.uuid))
        return None if callback is None else callback(message)

    def _on_status(self, message: GoalStatusArray) -> None:
        missing = len(self._goals)
        for each in reversed(message.status_list):  # the newest goals are at the end
            if not missing:
                return
            key = bytes(each.goal_info.goal_id.uuid)
            handle = self._goals.get(key)
            if handle is not None:
                missing -= 1
                handle.status = each.status
                if not is_active(each.status):
                    del self._goals[key]

    def _new_id(self) -> UUID:
        """Return a random id; under a virtual clock, the same ids in every run."""
        self._sent += 1
        if not self._loop.clock.is_virtual:
            return UUID(uuid=list(uuid.uuid4().bytes))
        base = uuid.UUID(bytes=self._goal_client.endpoint.gid)
        return UUID(uuid=list(uuid.uuid5(base, str(self._sent)).bytes))
