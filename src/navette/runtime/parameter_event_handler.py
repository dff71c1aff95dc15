"""Callbacks for changes of parameters of any node."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import chain
from typing import Any

from navette.msgs.rcl_interfaces.msg import Parameter as ParameterMsg
from navette.msgs.rcl_interfaces.msg import ParameterEvent
from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.names import full_node_name
from navette.runtime.node import Node
from navette.runtime.qos import QoSProfile, qos_profile_parameter_events


@dataclass(eq=False)
class ParameterCallbackHandle:
    """Handle of a parameter's callback, for its removal."""

    parameter_name: str
    node_name: str
    callback: Callable[[ParameterMsg], object]


@dataclass(eq=False)
class ParameterEventCallbackHandle:
    """Handle of an event callback, for its removal."""

    callback: Callable[[ParameterEvent], object]


class ParameterEventHandler:
    """Subscriber of ``/parameter_events``; the newest callback is called first."""

    def __init__(
        self,
        node: Node,
        qos_profile: QoSProfile = qos_profile_parameter_events,
        callback_group: CallbackGroup | None = None,
        **options: Any,
    ) -> None:
        self.node = node
        self.qos_profile = qos_profile
        self._parameter_handles: list[ParameterCallbackHandle] = []
        self._event_handles: list[ParameterEventCallbackHandle] = []
        self.parameter_event_subscription = node.create_subscription(
            ParameterEvent,
            "/parameter_events",
            self._on_event,
            qos_profile,
            callback_group=callback_group,
            **options,
        )

    def destroy(self) -> None:
        self.node.destroy_subscription(self.parameter_event_subscription)

    @staticmethod
    def get_parameter_from_event(
        event: ParameterEvent, parameter_name: str, node_name: str
    ) -> ParameterMsg | None:
        """Return the new value of a node's parameter; None if it did not change."""
        if event.node != node_name:
            return None
        found = ParameterEventHandler.get_parameters_from_event(event)
        return next((each for each in found if each.name == parameter_name), None)

    @staticmethod
    def get_parameters_from_event(event: ParameterEvent) -> Iterator[ParameterMsg]:
        """Return the new and the changed parameters."""
        return chain(event.new_parameters, event.changed_parameters)

    def add_parameter_callback(
        self,
        parameter_name: str,
        node_name: str,
        callback: Callable[[ParameterMsg], object],
    ) -> ParameterCallbackHandle:
        """Call ``callback(parameter message)`` on changes; "" stands for this node."""
        full_name = self._full_name(node_name)
        handle = ParameterCallbackHandle(parameter_name, full_name, callback)
        self._parameter_handles.insert(0, handle)
        return handle

    def remove_parameter_callback(self, handle: ParameterCallbackHandle) -> None:
        if handle not in self._parameter_handles:
            raise RuntimeError(f"no such parameter callback: {handle}")
        self._parameter_handles.remove(handle)

    def add_parameter_event_callback(
        self, callback: Callable[[ParameterEvent], object]
    ) -> ParameterEventCallbackHandle:
        """Call ``callback(event)`` on every event of any node."""
        handle = ParameterEventCallbackHandle(callback)
        self._event_handles.insert(0, handle)
        return handle

    def remove_parameter_event_callback(
        self, handle: ParameterEventCallbackHandle
    ) -> None:
        if handle not in self._event_handles:
            raise RuntimeError(f"no such parameter event callback: {handle}")
        self._event_handles.remove(handle)

    def _on_event(self, event: ParameterEvent) -> None:
        for handle in tuple(self._parameter_handles):
            found = self.get_parameter_from_event(
                event, handle.parameter_name, handle.node_name
            )
            if found is not None:
                handle.callback(found)
        for each in tuple(self._event_handles):
            each.callback(event)

    def _full_name(self, node_name: str) -> str:
        if not node_name:
            return self.node.get_fully_qualified_name()
        if node_name.startswith("/"):
            return node_name
        return full_node_name(node_name, self.node.get_namespace())
