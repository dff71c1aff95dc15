"""Service timeouts, and action results that take longer."""

from collections.abc import Iterator
from typing import Any

import pytest
from transport_pairs import ZenohPair, until

from free_ports import free_endpoint
from navette import ActionClient, ActionServer, Context, Future, Node
from navette.errors import InvalidValueError
from navette.msgs.example_interfaces.action import Fibonacci
from navette.msgs.example_interfaces.srv import AddTwoInts
from navette.runtime import Executor
from navette.runtime.exceptions import ServiceTimeoutError
from navette.transports import Endpoint, EndpointKind, EndpointQos, Reply, Request
from navette.transports.zenoh import Settings

TIMEOUT_S = 0.2


@pytest.fixture
def pair() -> Iterator[ZenohPair]:
    pair = ZenohPair(service_timeout_s=TIMEOUT_S)
    yield pair
    pair.close()


def test_a_request_without_a_reply_times_out(
    pair: ZenohPair,
) -> None:
    requests: list[Request] = []
    replies: list[Reply] = []

    def end(kind: EndpointKind) -> Endpoint:
        name = "example_interfaces/srv/AddTwoInts"
        return Endpoint(kind, "/s", name, EndpointQos(), "n", "/", b"")

    server = pair.near.serve(end(EndpointKind.SERVICE), requests.append)
    client = pair.far.connect(end(EndpointKind.CLIENT), replies.append)
    pair.settle()
    client.request(AddTwoInts.Request(), 0, 1)
    until(lambda: bool(replies), "the timeout")
    reason = "no reply within 0.2 s (NAVETTE_SERVICE_TIMEOUT)"
    assert replies == [Reply(None, 1, reason, timed_out=True)]
    server.reply(requests[0].id, AddTwoInts.Response(sum=1))  # too late

    def replies_in_time() -> bool:
        """Call again; on a busy machine the next call may time out, too."""
        sent = len(replies) + 1
        client.request(AddTwoInts.Request(), 0, sent)
        until(lambda: len(requests) == sent, "the next request")
        server.reply(requests[-1].id, AddTwoInts.Response(sum=sent))
        until(lambda: len(replies) == sent, "the next reply")
        assert replies[-1].timed_out or replies[-1].message.sum == sent
        return not replies[-1].timed_out

    until(replies_in_time, "an answer in time")


class Two:
    """Two nodes with a network between them."""

    def __init__(self, here: Context, there: Context) -> None:
        self.here, self.there = Node("here", context=here), Node("there", context=there)
        self._executors = [Executor(context=here), Executor(context=there)]
        for executor, node in zip(
            self._executors, (self.here, self.there), strict=True
        ):
            executor.add_node(node)

    def until(self, condition: Any, what: str) -> None:
        def look() -> bool:
            for executor in self._executors:
                executor.spin_once(timeout_sec=0.0)
            return bool(condition())

        until(look, what)


@pytest.fixture
def two(monkeypatch: pytest.MonkeyPatch) -> Iterator[Two]:
    monkeypatch.setenv("NAVETTE_ROUTER", free_endpoint())
    monkeypatch.setenv("NAVETTE_SERVICE_TIMEOUT", str(TIMEOUT_S))
    with Context(transport="zenoh") as here, Context(transport="zenoh") as there:
        yield Two(here, there)


def test_an_action_result_may_take_longer_than_the_timeout(two: Two) -> None:
    is_over: Future[None] = Future()

    async def execute(goal: Any) -> Any:
        await is_over
        goal.succeed()
        return Fibonacci.Result(sequence=[7])

    server = ActionServer(two.there, Fibonacci, "count", execute)
    client = ActionClient(two.here, Fibonacci, "count")
    two.until(client.server_is_ready, "the server")
    handles: list[Any] = []

    def accepts_in_time() -> bool:
        """Send a goal; on a busy machine the call may time out."""
        sent = client.send_goal_async(Fibonacci.Goal(order=1))
        two.until(sent.done, "the goal's acceptance")
        if not isinstance(sent.exception(), ServiceTimeoutError):
            handles.append(sent.result())
        return bool(handles)

    until(accepts_in_time, "a goal's acceptance")
    (handle,) = handles
    result = handle.get_result_async()
    waiting = server._result_service.ports[1].waiting
    two.until(lambda: len(waiting) >= 3, "the third request")
    is_over.set_result(None)
    two.until(result.done, "the result")
    assert list(result.result().result.sequence) == [7]
    assert len(waiting) == 0


def test_the_caller_gets_a_timeout_error(two: Two) -> None:
    gate: Future[None] = Future()
    ended: list[int] = []

    async def late(request: Any, response: Any) -> Any:
        await gate
        ended.append(request.a)
        return response

    two.there.create_service(AddTwoInts, "add", late)
    client = two.here.create_client(AddTwoInts, "add")
    two.until(client.service_is_ready, "the server")
    future = client.call_async(AddTwoInts.Request())
    two.until(future.done, "the timeout")
    with pytest.raises(ServiceTimeoutError, match=r"no reply within 0\.2 s"):
        future.result()
    gate.set_result(None)
    two.until(lambda: ended, "the late reply")


@pytest.mark.parametrize("text", ["x", "0", "-1", "nan", "inf", "0.01", "1e9"])
def test_the_timeout_is_checked(text: str) -> None:
    with pytest.raises(InvalidValueError, match=r"TIMEOUT '.*' *: expected .*0\.1 to"):
        Settings.from_environment({"NAVETTE_SERVICE_TIMEOUT": text})


def test_the_default_timeout_is_ten_minutes() -> None:
    assert Settings.from_environment({}).service_timeout_s == 600.0
    environment = {"NAVETTE_SERVICE_TIMEOUT": "2.5"}
    assert Settings.from_environment(environment).service_timeout_s == 2.5
