"""Service calls to other nodes: response, error, timeout."""

from typing import Any

import pytest
from remote_fakes import World

from navette.viewer.service_calls import TIMEOUT_S

GET = "rcl_interfaces/srv/GetParameters"


@pytest.fixture
def world() -> World:
    return World()


def ask(world: World, service: str = "/a/get_parameters") -> list[tuple[Any, str]]:
    got: list[tuple[Any, str]] = []
    world.service_calls.call(
        service,
        GET,
        {"names": ["x"]},
        lambda *reasons: got.append((reasons[0], reasons[1])),
    )
    return got


def test_a_response_is_passed_on_and_the_client_destroyed(world: World) -> None:
    got = ask(world)
    assert (got, world.clients) == ([], ["/a/get_parameters"])
    assert world.calls[0].request.names == ["x"]
    world.calls[0].future.set_result("yes")
    assert got == [("yes", "")]
    assert (world.clients, world.service_calls.pending) == ([], 0)


def test_a_call_without_response_times_out(world: World) -> None:
    got = ask(world)
    world.clock.now_s += TIMEOUT_S + 0.1
    world.service_calls.expire()
    assert got == [(None, "no response in 1 s")]
    world.calls[0].future.set_result("late")
    assert (len(got), world.clients) == (1, [])


def test_failures_have_reasons(world: World) -> None:
    got = ask(world)
    world.calls[0].future.set_exception(RuntimeError("no such thing"))
    assert got == [(None, "no such thing")]
    assert ask(world, "/bad/get_parameters") == [
        (None, "service /bad/get_parameters: is of another type")
    ]
    got = ask(world)
    world.calls[-1].future.cancel()
    assert got == [(None, "the call was cancelled")]
    assert world.clients == []


def test_a_retained_client_serves_several_calls(world: World) -> None:
    world.service_calls.retain("/a/get_parameters")
    first, second = ask(world), ask(world)
    assert world.clients == ["/a/get_parameters"]
    for call in world.calls:
        call.future.set_result("yes")
    assert first == second == [("yes", "")]
    assert world.clients == ["/a/get_parameters"]
    world.service_calls.release("/a/get_parameters")
    assert world.clients == []
