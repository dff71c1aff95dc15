"""Handler of state transitions of lifecycle nodes."""

from collections.abc import Callable
from typing import Any

from navette.ros2.packages.launch import Event
from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.event_handler import CallbackHandler
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.launch_description_entity import caller_location
from navette.ros2.packages.launch.substitution import Parts
from navette.ros2.packages.launch_ros.actions.lifecycle_node import LifecycleNode
from navette.ros2.packages.launch_ros.events.lifecycle import (
    StateTransition,
)

__all__ = ["OnStateTransition"]


class OnStateTransition(CallbackHandler):
    """Handler of a state transition.

    Args:
        entities: entities to visit, or ``function(event, context)`` that returns them.
        target_lifecycle_node: only transitions of this node.
        transition: only this transition (``configure``, …).
        start_state: only from this state (``configuring``, …).
        goal_state: only to this state (``inactive``, …).
        matcher: replaces all these filters.
    """

    def __init__(
        self,
        *,
        entities: Any,
        target_lifecycle_node: LifecycleNode | None = None,
        transition: Any = None,
        start_state: Any = None,
        goal_state: Any = None,
        matcher: Callable[[Event], bool] | None = None,
        handle_once: bool = False,
    ) -> None:
        self.origin = caller_location()
        target = target_lifecycle_node
        if target is not None and not isinstance(target, LifecycleNode):
            raise InvalidLaunchValueError(
                f"OnStateTransition: target_lifecycle_node {target!r}: expected a "
                "LifecycleNode"
            )
        self._target = target
        self._labels = {
            "transition": transition,
            "start_state": start_state,
            "goal_state": goal_state,
        }
        super().__init__(
            matcher=matcher or self._matches_filters,
            callback=entities,
            handle_once=handle_once,
        )

    def _matches_filters(self, event: Event) -> bool:
        if not isinstance(event, StateTransition):
            return False
        if self._target is not None and event.action is not self._target:
            return False
        return all(
            wanted is None or _text(event.action.launch, wanted) == getattr(event, name)
            for name, wanted in self._labels.items()
        )


def _text(context: LaunchContext, value: Any) -> str:
    return Parts.of(value).perform(context)
