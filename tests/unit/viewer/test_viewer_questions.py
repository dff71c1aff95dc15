"""Questions to other nodes: answered, refused, given up."""

from typing import Any

import pytest
from remote_fakes import World

from navette.viewer.questions import ANSWER_S

GET = "rcl_interfaces/srv/GetParameters"


@pytest.fixture
def world() -> World:
    return World()


def ask(world: World, service: str = "/a/get_parameters") -> list[tuple[Any, str]]:
    got: list[tuple[Any, str]] = []
    world.questions.ask(
        service, GET, {"names": ["x"]}, lambda *said: got.append((said[0], said[1]))
    )
    return got


def test_an_answer_is_told_and_the_client_is_gone(world: World) -> None:
    got = ask(world)
    assert (got, world.clients) == ([], ["/a/get_parameters"])
    assert world.calls[0].request.names == ["x"]
    world.calls[0].future.set_result("yes")
    assert got == [("yes", "")]
    assert (world.clients, world.questions.under_way) == ([], 0)


def test_who_does_not_answer_is_given_up(world: World) -> None:
    got = ask(world)
    world.clock.now_s += ANSWER_S + 0.1
    world.questions.give_up_old()
    assert got == [(None, "no answer in 1 s")]
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


def test_a_client_is_kept_for_who_asks_often(world: World) -> None:
    world.questions.keep("/a/get_parameters")
    first, second = ask(world), ask(world)
    assert world.clients == ["/a/get_parameters"]
    for call in world.calls:
        call.future.set_result("yes")
    assert first == second == [("yes", "")]
    assert world.clients == ["/a/get_parameters"]
    world.questions.let_go("/a/get_parameters")
    assert world.clients == []
