"""Interface to the program's nodes and graph, for the parts of the live view."""

from collections.abc import Iterable, Sequence
from typing import Any, Protocol


class LocalNode(Protocol):
    """The part of a node of this process that is used here."""

    def get_fully_qualified_name(self) -> str: ...
    def has_parameter(self, name: str) -> bool: ...
    def get_parameter(self, name: str) -> Any: ...
    def get_parameters_by_prefix(self, prefix: str) -> dict[str, Any]: ...
    def describe_parameters(self, names: list[str]) -> list[Any]: ...
    def set_parameters(self, parameters: list[Any]) -> Sequence[Any]: ...


class ServiceClient(Protocol):
    """The part of a service client that is used here."""

    @property
    def srv_type(self) -> Any: ...
    def call_async(self, request: Any) -> Any: ...
    def remove_pending_request(self, future: Any) -> None: ...
    def destroy(self) -> None: ...


class GraphAccess(Protocol):
    """The node of the live view, as its parts use it; on the executor's thread.

    The methods ``create_client``, ``create_publisher`` and ``destroy_publisher`` are
    those of every node.
    """

    def create_client(self, srv_type: Any, srv_name: str) -> ServiceClient: ...
    def create_publisher(self, msg_type: Any, topic: str, qos_profile: int) -> Any: ...
    def destroy_publisher(self, publisher: Any) -> object: ...

    def local_nodes(self) -> Iterable[LocalNode]:
        """Return the nodes of this process."""

    def node_names(self) -> set[str]:
        """Return the full names of all nodes of the graph."""

    def make_parameter(self, name: str, value: Any) -> Any:
        """Return a parameter with this value.

        Raises:
            ParameterError: no ROS 2 parameter can have this value.
        """
