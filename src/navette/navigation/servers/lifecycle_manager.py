"""The node ``lifecycle_manager_navigation``: starts, pauses and stops navigation.

Its services are those of Nav2's lifecycle manager. It brings the managed nodes to the
state of a command, whatever state each is in: up in their order, down in reverse.
"""

from dataclasses import dataclass
from typing import Any

from navette.errors import InvalidValueError
from navette.msgs.lifecycle_msgs.msg import Transition
from navette.msgs.lifecycle_msgs.srv import ChangeState, GetState
from navette.msgs.nav2_msgs.srv import ManageLifecycleNodes
from navette.msgs.std_srvs.srv import Trigger
from navette.navigation.servers.lifecycle_plan import next_transition, state_of_command
from navette.params import Params, param
from navette.runtime.stage.stage_node import StageNode

_NAMES = (
    "map_server",
    "controller_server",
    "smoother_server",
    "planner_server",
    "behavior_server",
    "bt_navigator",
)
_ACTIVE = "active"


@dataclass(frozen=True, kw_only=True)
class LifecycleManagerParams(Params):
    """The nodes that the lifecycle manager starts and stops."""

    node_names: tuple[str, ...] = param(
        _NAMES, "managed nodes, in the order of starting"
    )


class LifecycleManagerNode(StageNode):
    """Start, pause, reset and shut down navigation."""

    PARAMS = LifecycleManagerParams
    FIXED_AT_START = frozenset({"node_names"})

    params: LifecycleManagerParams

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("lifecycle_manager_navigation", **kwargs)
        self._get = {
            name: self.create_client(GetState, f"{name}/get_state")
            for name in self.params.node_names
        }
        self._change = {
            name: self.create_client(ChangeState, f"{name}/change_state")
            for name in self.params.node_names
        }
        self.create_service(
            ManageLifecycleNodes, "~/manage_nodes", self.on_manage_nodes
        )
        self.create_service(Trigger, "~/is_active", self.on_is_active)

    async def on_manage_nodes(self, request: Any, response: Any) -> Any:
        """Bring all nodes to the state of the command."""
        try:
            goal = state_of_command(request.command)
        except InvalidValueError as error:
            self.get_logger().error(str(error))
            return response
        names = list(self.params.node_names)
        if goal != _ACTIVE:
            names.reverse()
        failed = [name for name in names if not await self._bring(name, goal)]
        response.success = not failed
        if failed:
            self.get_logger().error(f"state {goal!r} not reached: {', '.join(failed)}")
        else:
            self.get_logger().info(f"all managed nodes are {goal}")
        return response

    async def on_is_active(self, request: Any, response: Any) -> Any:
        """Return whether all managed nodes are active."""
        states = {name: await self._state(name) for name in self.params.node_names}
        others = [f"{name}: {s}" for name, s in states.items() if s != _ACTIVE]
        response.success = not others
        response.message = ", ".join(others) or "all managed nodes are active"
        return response

    async def _bring(self, name: str, goal: str) -> bool:
        """Change the state of a node until it is ``goal``; return whether it is."""
        while True:
            state = await self._state(name)
            try:
                transition = next_transition(state, goal)
            except InvalidValueError as error:
                self.get_logger().error(f"{name}: {error}")
                return False
            if transition is None:
                return True
            request = ChangeState.Request(transition=Transition(id=transition))
            response = await self._change[name].call_async(request)
            if response is None or not response.success:
                return False

    async def _state(self, name: str) -> str:
        """Return the label of a node's state; ``unavailable`` if it does not exist."""
        client = self._get[name]
        if not client.service_is_ready():
            return "unavailable"
        response = await client.call_async(GetState.Request())
        return "unavailable" if response is None else response.current_state.label
