"""Lifecycle states of the stages under the names of Nav2's nodes.

Programs wait for ``bt_navigator/get_state`` and pause navigation by the lifecycle of
``controller_server``. Here the nodes are named after their stages. Each offers the
lifecycle services of the Nav2 nodes whose work it does, and starts active.
"""

from collections.abc import Callable
from typing import Any

from navette.msgs.lifecycle_msgs.msg import Transition
from navette.runtime.lifecycle import LifecycleNodeMixin
from navette.runtime.lifecycle.state_machine import (
    STATES,
    LifecycleState,
    TransitionCallbackReturn,
)
from navette.runtime.node import Node

NAV2_NODES = {
    "map_server": "map_memory",
    "amcl": "localizer",
    "controller_server": "control",
    "smoother_server": "planner",
    "planner_server": "planner",
    "behavior_server": "behaviors",
    "bt_navigator": "missions",
    "waypoint_follower": "missions",
}
"""Nav2's nodes, and the node of the stack that does the work of each."""

OnInactive = Callable[[], object]
"""Called when the state stops being ``active``: drops the goals."""


class StageLifecycle(LifecycleNodeMixin):
    """Lifecycle of one of Nav2's nodes, offered by a node of a stage.

    After a shutdown, ``configure`` is possible again: the process still runs.

    Args:
        node: the node of the stage.
        name: a name of :data:`NAV2_NODES`.
        on_inactive: default: there are no goals to drop.
    """

    def __init__(
        self, node: Node, name: str, *, on_inactive: OnInactive = lambda: None
    ) -> None:
        assert name in NAV2_NODES, "only Nav2's names are offered"
        self._on_inactive = on_inactive
        self._lifecycle_begin(node, name)
        self._name = name
        self.trigger_configure()
        self.trigger_activate()

    @property
    def is_active(self) -> bool:
        return self._state_machine.state == STATES["active"]

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        self._stop("deactivated")
        return super().on_deactivate(state)

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        if state == STATES["active"]:
            self._stop("shut down")
        return super().on_shutdown(state)

    def _stop(self, how: str) -> None:
        self._lifecycle_node.get_logger().info(
            f"{self._name} was {how} by a program: goals are refused until "
            "lifecycle_manager_navigation/manage_nodes starts it up"
        )
        self._on_inactive()

    def _lifecycle_on_change_state(self, request: Any, response: Any) -> Any:
        wanted = request.transition
        configures = (
            wanted.label == "configure"
            if wanted.label
            else wanted.id == Transition.TRANSITION_CONFIGURE
        )
        if configures and self._state_machine.state == STATES["finalized"]:
            self._state_machine.state = STATES["unconfigured"]
        return super()._lifecycle_on_change_state(request, response)
