"""Client of another node's parameter services."""

from collections.abc import Callable, Sequence
from typing import Any

from navette.msgs import get_interface
from navette.msgs.rcl_interfaces.msg import Parameter as ParameterMsg
from navette.msgs.rcl_interfaces.msg import ParameterEvent
from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.client import Client
from navette.runtime.future import Future
from navette.runtime.node import Node
from navette.runtime.parameter import (
    Parameter,
    ParameterType,
    parameter_dict_from_yaml_file,
)
from navette.runtime.qos import (
    QoSProfile,
    qos_profile_parameter_events,
    qos_profile_services_default,
)
from navette.runtime.subscription import Subscription

DoneCallback = Callable[[Future[Any]], object]

_SERVICES = {
    "describe_parameters": "DescribeParameters",
    "get_parameters": "GetParameters",
    "get_parameter_types": "GetParameterTypes",
    "list_parameters": "ListParameters",
    "set_parameters": "SetParameters",
    "set_parameters_atomically": "SetParametersAtomically",
}


class AsyncParameterClient:
    """Client that reads and sets the parameters of ``remote_node_name``.

    Every request returns a future of the service's response; ``callback`` is called
    with that future when it is done.
    """

    def __init__(
        self,
        node: Node,
        remote_node_name: str,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> None:
        self.node = node
        self.remote_node_name = remote_node_name
        self._clients: dict[str, Client] = {
            name: node.create_client(
                get_interface(f"rcl_interfaces/srv/{type_name}"),
                f"{remote_node_name}/{name}",
                qos_profile=qos_profile,
                callback_group=callback_group,
            )
            for name, type_name in _SERVICES.items()
        }

    def services_are_ready(self) -> bool:
        return all(client.service_is_ready() for client in self._clients.values())

    def wait_for_services(self, timeout_sec: float | None = None) -> bool:
        """Run events until all services are available; False after the timeout."""
        loop = self.node.context.loop
        timeout = None if timeout_sec is None else round(timeout_sec * 1e9)
        loop.run(
            until_ns=None if timeout is None else loop.clock.now_ns + timeout,
            done=self.services_are_ready,
        )
        return self.services_are_ready()

    def list_parameters(
        self,
        prefixes: list[str] | None = None,
        depth: int | None = None,
        callback: DoneCallback | None = None,
    ) -> Future[Any]:
        """Request the names below the prefixes; ``depth`` None means all levels."""
        return self._request(
            "list_parameters", callback, prefixes=prefixes or [], depth=depth or 0
        )

    def get_parameters(
        self, names: list[str], callback: DoneCallback | None = None
    ) -> Future[Any]:
        return self._request("get_parameters", callback, names=names)

    def describe_parameters(
        self, names: list[str], callback: DoneCallback | None = None
    ) -> Future[Any]:
        return self._request("describe_parameters", callback, names=names)

    def get_parameter_types(
        self, names: list[str], callback: DoneCallback | None = None
    ) -> Future[Any]:
        return self._request("get_parameter_types", callback, names=names)

    def set_parameters(
        self,
        parameters: Sequence[Parameter[Any] | ParameterMsg],
        callback: DoneCallback | None = None,
    ) -> Future[Any]:
        """Set the parameters one by one; the response has a result for each."""
        return self._request(
            "set_parameters", callback, parameters=_messages(parameters)
        )

    def set_parameters_atomically(
        self,
        parameters: Sequence[Parameter[Any] | ParameterMsg],
        callback: DoneCallback | None = None,
    ) -> Future[Any]:
        messages = _messages(parameters)
        return self._request("set_parameters_atomically", callback, parameters=messages)

    def delete_parameters(
        self, names: list[str], callback: DoneCallback | None = None
    ) -> Future[Any]:
        """Delete the values; only dynamically typed parameters allow it."""
        unset: list[Parameter[Any]] = [
            Parameter(name, ParameterType.NOT_SET) for name in names
        ]
        return self.set_parameters(unset, callback)

    def load_parameter_file(
        self,
        parameter_file: str,
        use_wildcard: bool = False,
        callback: DoneCallback | None = None,
    ) -> Future[Any]:
        """Set the parameters of a file for all its nodes.

        Args:
            use_wildcard: include the values for ``/**``.
        """
        found = parameter_dict_from_yaml_file(parameter_file, use_wildcard)
        return self.set_parameters(list(found.values()), callback)

    def load_parameter_file_atomically(
        self,
        parameter_file: str,
        use_wildcard: bool = False,
        callback: DoneCallback | None = None,
    ) -> Future[Any]:
        found = parameter_dict_from_yaml_file(parameter_file, use_wildcard)
        return self.set_parameters_atomically(list(found.values()), callback)

    def on_parameter_event(
        self,
        callback: Callable[..., Any],
        qos_profile: QoSProfile = qos_profile_parameter_events,
        **options: Any,
    ) -> Subscription[ParameterEvent]:
        """Subscribe to the parameter changes of all nodes."""
        return self.node.create_subscription(
            ParameterEvent, "/parameter_events", callback, qos_profile, **options
        )

    def _request(
        self, name: str, callback: DoneCallback | None, **fields: Any
    ) -> Future[Any]:
        client = self._clients[name]
        future = client.call_async(client.srv_type.Request(**fields))
        if callback is not None:
            future.add_done_callback(callback)
        return future


def _messages(
    parameters: Sequence[Parameter[Any] | ParameterMsg],
) -> list[ParameterMsg]:
    return [
        each.to_parameter_msg() if isinstance(each, Parameter) else each
        for each in parameters
    ]
