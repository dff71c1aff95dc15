"""Action that starts a lifecycle node."""

from typing import Any

from navette.msgs.lifecycle_msgs.msg import Transition, TransitionEvent
from navette.msgs.lifecycle_msgs.srv import ChangeState as ChangeStateService
from navette.ros2.packages.launch import Event, LaunchContext, LaunchDescriptionEntity
from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.event_handler import CallbackHandler
from navette.ros2.packages.launch.logging import get_logger
from navette.ros2.packages.launch.typed import perform_bool
from navette.ros2.packages.launch_ros.actions.node import Node
from navette.ros2.packages.launch_ros.events.lifecycle import (
    TRANSITIONS,
    ChangeState,
    StateTransition,
)
from navette.ros2.packages.launch_ros.ros_adapters import get_ros_adapter

_log = get_logger("launch")


class LifecycleNode(Node):
    """Starts a lifecycle node; its name is required.

    :class:`ChangeState` events request its transitions; each transition causes a
    :class:`StateTransition` event.

    Args:
        autostart: configure and activate the node.
    """

    def __init__(
        self, *, name: Any, namespace: Any, autostart: Any = False, **kwargs: Any
    ) -> None:
        if name is None:
            raise InvalidLaunchValueError("LifecycleNode: name is required")
        super().__init__(name=name, namespace=namespace, **kwargs)
        self._autostart = autostart
        self._launch: LaunchContext | None = None

    @property
    def launch(self) -> LaunchContext:
        """The launch that started the node."""
        assert self._launch is not None, "started"
        return self._launch

    @property
    def is_autostart(self) -> bool:
        return bool(self._autostart)

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        if context.is_shutdown:
            return None
        self._launch = context
        super().execute(context)
        get_ros_adapter(context).subscribe(
            TransitionEvent,
            f"{self.node_name}/transition_event",
            lambda msg: context.emit_event_sync(StateTransition(action=self, msg=msg)),
        )
        context.register_event_handler(
            CallbackHandler(matcher=self._is_transition_request, callback=self._change)
        )
        if not perform_bool(context, self._autostart):
            return None
        from navette.ros2.packages.launch_ros.actions.lifecycle_transition import (
            LifecycleTransition,
        )

        return [
            LifecycleTransition(
                lifecycle_node_names=[self.node_name],
                transition_ids=[
                    Transition.TRANSITION_CONFIGURE,
                    Transition.TRANSITION_ACTIVATE,
                ],
            )
        ]

    def _is_transition_request(self, event: Event) -> bool:
        return isinstance(event, ChangeState) and event.lifecycle_node_matcher(self)

    def _change(self, event: Any, context: LaunchContext) -> None:
        request = ChangeStateService.Request()
        request.transition.id = event.transition_id

        def on_response(response: Any) -> None:
            if not response.success:
                _log.error(
                    "failed to make transition '%s' for LifecycleNode '%s'",
                    TRANSITIONS[event.transition_id],
                    self.node_name,
                )

        get_ros_adapter(context).call(
            ChangeStateService, f"{self.node_name}/change_state", request, on_response
        )
