"""Fakes of the services of other nodes; the test decides when they respond."""

from collections.abc import Callable
from typing import Any

from navette.errors import InvalidValueError
from navette.msgs import get_interface
from navette.msgs.rcl_interfaces.msg import Parameter as ParameterMsg
from navette.runtime import Future, Parameter
from navette.viewer.service_calls import ServiceCalls

ServiceResponse = Callable[[Any], Any]


class Clock:
    """Wall time, set by the test."""

    def __init__(self) -> None:
        self.now_s = 100.0

    def __call__(self) -> float:
        return self.now_s


class Call:
    """A pending request."""

    def __init__(self, service: str, request: Any) -> None:
        self.service = service
        self.request = request
        self.future: Future[Any] = Future()


class World:
    """Services by name; one without an answer never responds."""

    def __init__(self) -> None:
        self.clock = Clock()
        self.service_calls = ServiceCalls(self.connect, self.clock)
        self.answers: dict[str, ServiceResponse] = {}
        self.calls: list[Call] = []
        self.clients: list[str] = []

    def connect(self, service: str, type_name: str) -> "_Client":
        if service.startswith("/bad/"):
            raise InvalidValueError(f"service {service}: is of another type")
        self.clients.append(service)
        return _Client(self, service, get_interface(type_name))

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
