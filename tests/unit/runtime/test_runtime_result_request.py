"""A request for a result is repeated after a timeout."""

from typing import Any, cast

import pytest

from navette.runtime import Future, VirtualClock
from navette.runtime.action.result_request import ResultRequest
from navette.runtime.client import Client
from navette.runtime.clock import Wakeup
from navette.runtime.exceptions import ServiceFailedError, ServiceTimeoutError

SECOND = 1_000_000_000


class FakeClient:
    """Records requests; a test sets whether a server exists."""

    def __init__(self) -> None:
        self.futures: list[Future[Any]] = []
        self.is_served = True

    def call_async(self, request: Any) -> Future[Any]:
        self.futures.append(Future())
        return self.futures[-1]

    def service_is_ready(self) -> bool:
        return self.is_served


class Bench:
    def __init__(self) -> None:
        self.asked = FakeClient()
        self.clock = VirtualClock()
        client = cast("Client", self.asked)
        self.future = ResultRequest(client, "result?", self.clock).future

    def time_out(self, after_ns: int) -> None:
        self.clock.go_to(self.clock.now_ns + after_ns, Wakeup())
        self.asked.futures[-1].set_exception(ServiceTimeoutError("no answer"))


def test_the_request_is_repeated_until_a_response_arrives() -> None:
    bench = Bench()
    for _ in range(3):
        bench.time_out(600 * SECOND)
        assert not bench.future.done()
    assert len(bench.asked.futures) == 4
    bench.asked.futures[-1].set_result("result")
    assert bench.future.result() == "result"


def test_the_request_is_not_repeated_without_a_server() -> None:
    bench = Bench()
    bench.asked.is_served = False
    bench.time_out(600 * SECOND)
    with pytest.raises(ServiceTimeoutError, match="no answer"):
        bench.future.result()


def test_an_early_timeout_is_not_retried() -> None:
    bench = Bench()
    bench.time_out(1)
    with pytest.raises(ServiceTimeoutError):
        bench.future.result()
    assert len(bench.asked.futures) == 1


def test_a_failure_is_passed_on() -> None:
    bench = Bench()
    bench.asked.futures[0].set_exception(ServiceFailedError("the server closed"))
    with pytest.raises(ServiceFailedError, match="closed"):
        bench.future.result()


def test_cancelling_either_future_cancels_the_other() -> None:
    given_up, destroyed = Bench(), Bench()
    given_up.time_out(600 * SECOND)
    given_up.future.cancel()
    assert given_up.asked.futures[-1].cancelled()
    destroyed.asked.futures[0].cancel()
    assert destroyed.future.cancelled()
