"""Managed nodes: state machine, transition callbacks and services."""

import traceback
from collections.abc import Callable
from typing import Any, TypeVar, cast

from navette.msgs.known_fields import made
from navette.msgs.lifecycle_msgs.msg import State as StateMsg
from navette.msgs.lifecycle_msgs.msg import (
    Transition,
    TransitionDescription,
    TransitionEvent,
)
from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.exceptions import RCLError
from navette.runtime.lifecycle.managed_entity import ManagedEntity
from navette.runtime.lifecycle.publisher import LifecyclePublisher
from navette.runtime.lifecycle.state_machine import (
    STATES,
    TRANSITIONS,
    LifecycleState,
    LifecycleStateMachine,
    TransitionCallbackReturn,
    TransitionDefinition,
)
from navette.runtime.node import Node
from navette.runtime.publisher import Publisher
from navette.runtime.qos import QoSProfile
from navette.runtime.time import ns_to_stamp

MsgT = TypeVar("MsgT")

_CALLBACKS = {
    "configuring": "on_configure",
    "cleaningup": "on_cleanup",
    "shuttingdown": "on_shutdown",
    "activating": "on_activate",
    "deactivating": "on_deactivate",
    "errorprocessing": "on_error",
}


class LifecycleNodeMixin(ManagedEntity):
    """Lifecycle of a node; its ``__init__`` must be called after that of Node.

    The default callbacks call those of the managed entities in the order in which they
    were added, up to the first that does not succeed.
    """

    def __init__(
        self,
        *,
        enable_communication_interface: bool = True,
        callback_group: CallbackGroup | None = None,
    ) -> None:
        if not isinstance(self, Node):
            raise RuntimeError("LifecycleNodeMixin needs Node in the inheritance tree")
        name = "~" if enable_communication_interface else None
        self._lifecycle_begin(cast(Node, self), name, callback_group)

    def _lifecycle_begin(
        self, node: Node, name: str | None, callback_group: CallbackGroup | None = None
    ) -> None:
        """Start in the state ``unconfigured``.

        Args:
            node: the node whose lifecycle this is.
            name: prefix of the services' names; None: no services.
            callback_group: the services' group.
        """
        self._lifecycle_node = node
        self._state_machine = LifecycleStateMachine()
        self._managed_entities: list[ManagedEntity] = []
        self._lifecycle_transition_events: Publisher[TransitionEvent] | None = None
        if name is not None:
            self._lifecycle_open_interface(name, callback_group)

    def trigger_configure(self) -> TransitionCallbackReturn:
        return self._lifecycle_change_state(Transition.TRANSITION_CONFIGURE)

    def trigger_cleanup(self) -> TransitionCallbackReturn:
        return self._lifecycle_change_state(Transition.TRANSITION_CLEANUP)

    def trigger_activate(self) -> TransitionCallbackReturn:
        return self._lifecycle_change_state(Transition.TRANSITION_ACTIVATE)

    def trigger_deactivate(self) -> TransitionCallbackReturn:
        return self._lifecycle_change_state(Transition.TRANSITION_DEACTIVATE)

    def trigger_shutdown(self) -> TransitionCallbackReturn:
        """Shut down from any primary state.

        Raises:
            RCLError: the node is shut down already.
        """
        return self._lifecycle_change_state(self._state_machine.by_label("shutdown").id)

    def add_managed_entity(self, entity: ManagedEntity) -> None:
        if not isinstance(entity, ManagedEntity):
            raise TypeError(f"expected a ManagedEntity, got {entity!r}")
        self._managed_entities.append(entity)

    def create_lifecycle_publisher(
        self,
        msg_type: type[MsgT],
        topic: str,
        qos_profile: QoSProfile | int,
        *,
        publisher_class: None = None,
        **kwargs: Any,
    ) -> LifecyclePublisher[MsgT]:
        if publisher_class is not None:
            raise TypeError("lifecycle publishers do not accept a publisher_class")
        publisher = self._lifecycle_node.create_publisher(
            msg_type, topic, qos_profile, publisher_class=LifecyclePublisher, **kwargs
        )
        assert isinstance(publisher, LifecyclePublisher), "the requested class"
        self._managed_entities.append(publisher)
        return publisher

    def destroy_lifecycle_publisher(self, publisher: LifecyclePublisher[Any]) -> bool:
        if publisher not in self._managed_entities:
            return False
        self._managed_entities.remove(publisher)
        return self._lifecycle_node.destroy_publisher(publisher)

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        return self._lifecycle_call_entities("on_configure", state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        return self._lifecycle_call_entities("on_cleanup", state)

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        return self._lifecycle_call_entities("on_shutdown", state)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        return self._lifecycle_call_entities("on_activate", state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        return self._lifecycle_call_entities("on_deactivate", state)

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        return self._lifecycle_call_entities("on_error", state)

    def _lifecycle_call_entities(
        self, name: str, state: LifecycleState
    ) -> TransitionCallbackReturn:
        for entity in tuple(self._managed_entities):
            result = _checked(getattr(entity, name)(state), name, entity)
            if result is not TransitionCallbackReturn.SUCCESS:
                return result
        return TransitionCallbackReturn.SUCCESS

    def _lifecycle_change_state(self, transition_id: int) -> TransitionCallbackReturn:
        """Run a transition with its callbacks; return ERROR if it is not available."""
        before = self._state_machine.state
        try:
            transition = self._state_machine.by_id(transition_id)
        except RCLError as error:
            self._lifecycle_node.get_logger().error(str(error))
            return TransitionCallbackReturn.ERROR
        self._lifecycle_enter(transition)
        result = self._lifecycle_run_callback(before)
        self._lifecycle_enter(self._state_machine.by_label(result.to_label()))
        if result is TransitionCallbackReturn.ERROR:
            recovery = self._lifecycle_run_callback(before)
            self._lifecycle_enter(self._state_machine.by_label(recovery.to_label()))
        return result

    def _lifecycle_enter(self, transition: TransitionDefinition) -> None:
        self._state_machine.state = transition.goal
        if self._lifecycle_transition_events is not None:
            described = _description(transition)
            now_ns = self._lifecycle_node.get_clock().now().nanoseconds
            event = made(
                TransitionEvent,
                timestamp=now_ns,
                stamp=ns_to_stamp(now_ns),  # since Lyrical
                transition=described.transition,
                start_state=described.start_state,
                goal_state=described.goal_state,
            )
            self._lifecycle_transition_events.publish(event)

    def _lifecycle_run_callback(
        self, before: LifecycleState
    ) -> TransitionCallbackReturn:
        """Run the callback of the current transition state.

        An exception is an error of the lifecycle: it is logged with its traceback, and
        ``on_error`` decides the next state.
        """
        name = _CALLBACKS[self._state_machine.state.label]
        callback: Callable[[LifecycleState], Any] = getattr(self, name)
        try:
            return _checked(callback(before), name, self)
        except Exception:  # a callback may raise anything: the transition fails
            self._lifecycle_node.get_logger().error(
                f"{name} raised:\n{traceback.format_exc()}"
            )
            return TransitionCallbackReturn.ERROR

    def _lifecycle_open_interface(
        self, prefix: str, group: CallbackGroup | None
    ) -> None:
        for type_name, name, callback in (
            ("ChangeState", "change_state", self._lifecycle_on_change_state),
            ("GetState", "get_state", self._lifecycle_on_get_state),
            (
                "GetAvailableStates",
                "get_available_states",
                self._lifecycle_on_get_states,
            ),
            (
                "GetAvailableTransitions",
                "get_available_transitions",
                self._lifecycle_on_get_transitions,
            ),
            (
                "GetAvailableTransitions",
                "get_transition_graph",
                self._lifecycle_on_get_graph,
            ),
        ):
            self._lifecycle_node._node_serve(
                f"lifecycle_msgs/srv/{type_name}",
                f"{prefix}/{name}",
                callback,
                callback_group=group,
            )
        self._lifecycle_transition_events = self._lifecycle_node.create_publisher(
            TransitionEvent, f"{prefix}/transition_event", 10
        )

    def _lifecycle_on_change_state(self, request: Any, response: Any) -> Any:
        transition_id = request.transition.id
        if request.transition.label:
            try:
                found = self._state_machine.by_label(request.transition.label)
            except RCLError as error:
                self._lifecycle_node.get_logger().error(str(error))
                return response
            transition_id = found.id
        result = self._lifecycle_change_state(transition_id)
        response.success = result is TransitionCallbackReturn.SUCCESS
        return response

    def _lifecycle_on_get_state(self, request: Any, response: Any) -> Any:
        response.current_state = _state(self._state_machine.state)
        return response

    def _lifecycle_on_get_states(self, request: Any, response: Any) -> Any:
        response.available_states = [_state(each) for each in STATES.values()]
        return response

    def _lifecycle_on_get_transitions(self, request: Any, response: Any) -> Any:
        available = self._state_machine.available_transitions
        response.available_transitions = [_description(each) for each in available]
        return response

    def _lifecycle_on_get_graph(self, request: Any, response: Any) -> Any:
        response.available_transitions = [_description(each) for each in TRANSITIONS]
        return response


class LifecycleNode(LifecycleNodeMixin, Node):
    """A managed node.

    Args:
        enable_communication_interface: whether to serve the lifecycle's services.
    """

    def __init__(
        self,
        node_name: str,
        *,
        enable_communication_interface: bool = True,
        **kwargs: Any,
    ) -> None:
        Node.__init__(self, node_name, **kwargs)
        LifecycleNodeMixin.__init__(
            self, enable_communication_interface=enable_communication_interface
        )


def _checked(result: Any, name: str, entity: object) -> TransitionCallbackReturn:
    if not isinstance(result, TransitionCallbackReturn):
        raise TypeError(
            f"{name}() of {type(entity).__name__} returned {result!r}, expected a "
            "TransitionCallbackReturn"
        )
    return result


def _state(state: LifecycleState) -> StateMsg:
    return StateMsg(id=state.state_id, label=state.label)


def _description(transition: TransitionDefinition) -> TransitionDescription:
    return TransitionDescription(
        transition=Transition(id=transition.id, label=transition.label),
        start_state=_state(transition.start),
        goal_state=_state(transition.goal),
    )
