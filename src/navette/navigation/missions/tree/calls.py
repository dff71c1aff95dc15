"""Leaves that call an action or service server and wait for its end."""

from abc import abstractmethod
from typing import Any, ClassVar

from py_trees.common import Status

from navette.msgs.known_fields import made, several_poses
from navette.navigation.missions.tree.behaviour import (
    FAILURE,
    RUNNING,
    SUCCESS,
    LeafNode,
    Ports,
)
from navette.navigation.missions.tree.interfaces import action_interface, interface
from navette.navigation.missions.tree.ports import (
    Port,
    output_port,
    parse_milliseconds,
)
from navette.navigation.missions.tree.robot_access import (
    ABORTED,
    CANCELED,
    SUCCEEDED,
    CallResult,
    ServerCall,
)

SERVER_PORTS: Ports = {
    "server_name": Port(),
    "server_timeout": Port(parse_milliseconds),
    "error_code_id": output_port(),
    "error_msg": output_port(),
}


class MissingInputError(ValueError):
    """An input has no value yet, such as a path before the first plan."""


class CallLeaf(LeafNode):
    """A leaf that starts a call and succeeds or fails with it."""

    IS_RECOVERY: ClassVar[bool] = False

    @abstractmethod
    def start(self) -> ServerCall:
        """Start the call.

        Raises:
            MissingInputError: an input has no value.
        """

    def needs_restart(self) -> bool:
        """Override: whether new inputs replace the running call."""
        return False

    def succeeded(self, message: Any) -> None:
        """Override to write outputs."""

    def failed(self, result: CallResult) -> None:
        """Override to write outputs."""

    def needed(self, name: str) -> Any:
        """Return an input that must have a value by now."""
        value = self.input(name)
        if value is None:
            raise MissingInputError(f"{self._attributes.get(name, name)} has no value")
        return value

    def initialise(self) -> None:
        super().initialise()
        self._call: ServerCall | None = None
        self._missing = ""
        self.feedback_message = ""
        try:
            self._call = self.start()
        except MissingInputError as error:
            self._missing = str(error)
            return
        if self.IS_RECOVERY and self.counts():
            count = self.blackboard.get("@number_recoveries", 0)
            self.blackboard.set("@number_recoveries", count + 1)

    def counts(self) -> bool:
        """Override: whether this call counts as a recovery."""
        return True

    def update(self) -> Status:
        if self._call is None:
            self.feedback_message = self._missing
            return FAILURE
        if self.status is RUNNING and self.needs_restart():
            self._call = self.start()
        result = self._call.result
        if result is None:
            return RUNNING
        if result.how in (SUCCEEDED, CANCELED):
            self.succeeded(result.message)
            return SUCCESS
        self.feedback_message = result.reason
        self.failed(result)
        return FAILURE

    def halt(self) -> None:
        if self._call is not None and self._call.result is None:
            self._call.cancel()


class ActionLeaf(CallLeaf):
    """Sends a goal to an action server of nav2_msgs."""

    ACTION: ClassVar[str]
    SERVER: ClassVar[str]
    PORTS: ClassVar[Ports] = SERVER_PORTS

    @abstractmethod
    def goal(self) -> Any:
        """Return the action's goal message.

        Raises:
            MissingInputError: an input has no value.
        """

    def new_goal(self, **fields: Any) -> Any:
        """Return the goal message, without fields that the distribution lacks."""
        kind = action_interface(self.ACTION).Goal
        for name in fields.keys() & {"goals", "poses"}:
            fields[name] = several_poses(kind, name, fields[name])
        return made(kind, **fields)

    def start(self) -> ServerCall:
        name = self.input("server_name") or self.SERVER
        kind = f"nav2_msgs/action/{self.ACTION}"
        return self.robot.start_action(kind, name, self.goal())

    def succeeded(self, message: Any) -> None:
        self._set_error(0, "")

    def failed(self, result: CallResult) -> None:
        code = getattr(result.message, "error_code", 0)
        if result.how != ABORTED or not code:
            kind = action_interface(self.ACTION).Result
            code = getattr(kind, "UNKNOWN", 0)
        self._set_error(code, result.reason)

    def _set_error(self, code: int, text: str) -> None:
        self.output("error_code_id", code)
        self.output("error_msg", text)


class ServiceLeaf(CallLeaf):
    """Sends a request to a service."""

    TYPE: ClassVar[str]
    PORTS: ClassVar[Ports] = {
        "service_name": Port(required=True),
        "server_timeout": Port(parse_milliseconds),
    }

    def request(self) -> Any:
        return interface(self.TYPE).Request()

    def start(self) -> ServerCall:
        name = self.input("service_name")
        return self.robot.call_service(self.TYPE, name, self.request())
