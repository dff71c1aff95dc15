"""Joining from outside: what is seen, what ends a verb and with which exit code."""

import os
import signal
from collections.abc import Iterator

import click
import pytest

from navette.cli.session import connect, endpoints, fail, is_hidden, wait_for
from navette.errors import UnknownNameError
from navette.msgs.std_msgs.msg import String
from navette.runtime import Context, Node, SystemClock, VirtualClock


@pytest.fixture
def context() -> Iterator[Context]:
    with Context(clock=VirtualClock()) as context:
        yield context


def test_the_node_is_hidden_and_gone_afterwards(context: Context) -> None:
    with connect(context) as node:
        assert node.get_name() == f"_navette_{os.getpid()}"
        assert is_hidden(node.get_fully_qualified_name())
    assert context.graph.nodes() == []
    assert context.ok()


def test_own_endpoints_are_not_listed(context: Context) -> None:
    talker = Node("talker", context=context, start_parameter_services=False)
    talker.create_publisher(String, "chatter", 10)
    with connect(context) as node:
        node.create_subscription(String, "other", lambda _: None, 10)
        topics = {each.topic for each in endpoints(node)}
    assert topics == {"/chatter", "/rosout", "/parameter_events"}


def test_callbacks_run_while_waiting(context: Context) -> None:
    with connect(context) as node:
        received: list[String] = []
        node.create_subscription(String, "chatter", received.append, 10)
        publisher = node.create_publisher(String, "chatter", 10)
        node.create_timer(0.5, lambda: publisher.publish(String(data="hello")))
        assert wait_for(node, lambda: len(received) == 3, 5.0)
        assert not wait_for(node, lambda: len(received) == 300, 1.0)
    assert context.clock.now_ns == 2_500_000_000


def test_exceptions_of_callbacks_propagate_unchanged(context: Context) -> None:
    def refuse() -> None:
        raise UnknownNameError("no such field")

    def wait() -> None:
        with connect(context) as node:
            node.create_timer(0.1, refuse)
            wait_for(node, lambda: False, 1.0)

    with pytest.raises(UnknownNameError, match="no such field"):
        wait()
    assert context.graph.nodes() == []


@pytest.mark.parametrize(
    ("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)]
)
def test_signals_end_a_verb_with_the_usual_exit_codes(number: int, code: int) -> None:
    before = signal.getsignal(signal.SIGTERM)

    def wait() -> None:
        with Context(clock=SystemClock()) as context, connect(context) as node:
            node.context.loop.call_soon(lambda: os.kill(os.getpid(), number), "test")
            wait_for(node, lambda: False, 5.0)

    with pytest.raises(click.exceptions.Exit) as ended:
        wait()
    assert ended.value.exit_code == code
    assert signal.getsignal(signal.SIGTERM) is before


def test_failures_are_printed_on_standard_error(
    capsys: pytest.CaptureFixture[str],
) -> None:
    with pytest.raises(click.exceptions.Exit) as ended:
        fail("nothing came")
    assert ended.value.exit_code == 1
    assert "navette: nothing came" in capsys.readouterr().err
