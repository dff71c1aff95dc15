"""Strict mode refuses what ROS 2 refuses."""

from typing import Any

import pytest

from navette.errors import CallbackError, NavetteError, ParameterError
from navette.msgs.std_msgs.msg import String
from navette.msgs.std_srvs.srv import Trigger
from navette.runtime import Future, Node
from navette.runtime.exceptions import InvalidTopicNameException
from navette.runtime.strict_mode import VARIABLE, DeadlockError, check_wait
from navette.runtime.testing import GraphHarness


@pytest.fixture(params=["0", "1"])
def strict(request: Any, monkeypatch: pytest.MonkeyPatch) -> bool:
    monkeypatch.setenv(VARIABLE, request.param)
    return bool(int(request.param))


def test_an_integer_is_not_a_double(strict: bool) -> None:
    with GraphHarness(args=["--ros-args", "-p", "speed:=2"]) as graph:
        node = graph.add(Node("robot", context=graph.context))
        if strict:
            with pytest.raises(ParameterError, match="2 is INTEGER, expected DOUBLE"):
                node.declare_parameter("speed", 1.0)
        else:
            assert node.declare_parameter("speed", 1.0).value == 2.0


def test_a_list_has_one_type(strict: bool) -> None:
    def start() -> Any:
        with GraphHarness(args=["--ros-args", "-p", "gains:=[1, 2.5]"]) as graph:
            node = graph.add(Node("robot", context=graph.context))
            return node.declare_parameter("gains", [0.0]).value

    if strict:
        with pytest.raises(NavetteError, match=r"\[1, 2.5\] is not a parameter"):
            start()
    else:
        assert list(start()) == [1.0, 2.5]


def test_long_names(strict: bool) -> None:
    with GraphHarness() as graph:
        node = graph.add(Node("robot", context=graph.context))
        node.create_publisher(String, "/" + "a" * 246, 1)
        if strict:
            with pytest.raises(InvalidTopicNameException, match="247 characters"):
                node.create_publisher(String, "/" + "a" * 247, 1)
        else:
            node.create_publisher(String, "/" + "a" * 247, 1)


def test_a_call_in_a_callback_of_one_thread(strict: bool) -> None:
    answers: list[Any] = []
    with GraphHarness() as graph:
        node = graph.add(Node("robot", context=graph.context))
        node.create_service(Trigger, "light", lambda request, response: response)
        client = node.create_client(Trigger, "light")
        timer = node.create_timer(
            0.1, lambda: answers.append(client.call(Trigger.Request()))
        )
        if strict:
            with pytest.raises(CallbackError) as caught:
                graph.run_for(0.15)
            assert isinstance(caught.value.__cause__, DeadlockError)
        else:
            graph.run_for(0.15)
            assert len(answers) == 1
        timer.cancel()


def test_a_spin_in_a_callback(strict: bool) -> None:
    with GraphHarness() as graph:
        node = graph.add(Node("robot", context=graph.context))
        node.create_timer(0.1, lambda: graph.executor.spin_once(timeout_sec=0.0))
        if strict:
            with pytest.raises(CallbackError) as caught:
                graph.executor.spin_until_future_complete(Future(), timeout_sec=0.15)
            assert isinstance(caught.value.__cause__, DeadlockError)
        else:
            graph.executor.spin_until_future_complete(Future(), timeout_sec=0.15)


def test_a_callback_shares_the_group_of_its_client(strict: bool) -> None:
    rules = {"in_driver_thread": False, "same_group": True, "exclusive": True}
    if strict:
        with pytest.raises(DeadlockError, match="share a mutually exclusive"):
            check_wait("call()", **rules)
    else:
        check_wait("call()", **rules)
    check_wait("call()", **{**rules, "exclusive": False})
