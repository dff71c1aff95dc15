"""Fakes of the services of other nodes; the test decides when they respond."""

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

from viewer_fakes import FakeBridge, FakeClock

from navette.errors import InvalidValueError
from navette.msgs.rcl_interfaces.msg import Parameter as ParameterMsg
from navette.runtime import Future, Parameter
from navette.viewer.service_calls import ServiceCalls

ServiceResponse = Callable[[Any], Any]


class Call:
    """A pending request."""

    def __init__(self, service: str, request: Any) -> None:
        self.service = service
        self.request = request
        self.future: Future[Any] = Future()


class World:
    """Services by name; one without an answer never responds."""

    def __init__(self) -> None:
        self.clock = FakeClock()
        self.bridge = FakeBridge()
        self.nodes_here = ["/viewer"]
        self.nodes_elsewhere = ["/far"]
        self.service_calls = ServiceCalls(graph=self, clock=self.clock)
        self.answers: dict[str, ServiceResponse] = {}
        self.calls: list[Call] = []
        self.clients: list[str] = []

    def create_client(self, srv_type: Any, service: str) -> "_Client":
        if service.startswith("/bad/"):
            raise InvalidValueError(f"service {service}: is of another type")
        self.clients.append(service)
        return _Client(self, service, srv_type)

    def create_publisher(self, msg_type: Any, topic: str, _depth: int) -> Any:
        raise InvalidValueError(f"topic {topic}: this fake publishes nothing")

    def destroy_publisher(self, publisher: Any) -> bool:
        return False

    def local_nodes(self) -> list[Any]:
        return [
            SimpleNamespace(get_fully_qualified_name=lambda name=name: name)
            for name in self.nodes_here
        ]

    def node_names(self) -> set[str]:
        return {*self.nodes_here, *self.nodes_elsewhere}

    def make_parameter(self, name: str, value: Any) -> Parameter[Any]:
        return Parameter(name, value=value)

    def asked(self) -> list[str]:
        """Return the services called since the last call."""
        calls, self.calls = self.calls, []
        return [call.service for call in calls]


class _Client:
    def __init__(self, world: World, service: str, srv_type: Any) -> None:
        self.srv_type = srv_type
        self._world = world
        self._service = service

    def call_async(self, request: Any) -> Future[Any]:
        call = Call(self._service, request)
        self._world.calls.append(call)
        answer = self._world.answers.get(self._service)
        if answer is not None:
            call.future.set_result(answer(request))
        return call.future

    def remove_pending_request(self, future: Future[Any]) -> None:
        """The fake keeps no pending requests."""

    def destroy(self) -> None:
        self._world.clients.remove(self._service)


def encoded(name: str, value: Any) -> ParameterMsg:
    return Parameter(name, value=value).to_parameter_msg()
