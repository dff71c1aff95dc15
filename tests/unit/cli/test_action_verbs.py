"""``navette action``: texts as of ros2 action; goals that end in every way."""

import json
from collections.abc import Iterator
from typing import Any

import pytest
from verb_world import World, world

from navette.msgs.example_interfaces.action import Fibonacci
from navette.runtime import Future, Node
from navette.runtime.action import (
    ActionClient,
    ActionServer,
    CancelResponse,
    GoalResponse,
)

TYPE = "example_interfaces/action/Fibonacci"
SENT = """\
Sending goal:
     order: 2

Goal accepted with ID: {goal_id}

Feedback:
    sequence:
- 0
- 1

Feedback:
    sequence:
- 0
- 1
- 1

Result:
    sequence:
- 0
- 1
- 1

Goal finished with status: SUCCEEDED
"""


@pytest.fixture
def here() -> Iterator[World]:
    with world() as here:
        yield here


class Counter:
    """A server of /count: a number a second; it aborts orders above 90."""

    def __init__(self, here: World) -> None:
        self.node = Node("counter", context=here.context)
        here.graph.add(self.node)
        self.server = ActionServer(
            self.node,
            Fibonacci,
            "count",
            self._execute,
            goal_callback=lambda goal: (
                GoalResponse.ACCEPT if goal.order >= 0 else GoalResponse.REJECT
            ),
            cancel_callback=lambda goal: CancelResponse.ACCEPT,
        )

    async def _execute(self, goal: Any) -> Any:
        sequence = [0]
        for _ in range(goal.request.order):
            await self._a_second()
            if goal.is_cancel_requested:
                goal.canceled()
                return Fibonacci.Result(sequence=sequence)
            sequence.append(sum(sequence[-2:]) or 1)
            goal.publish_feedback(Fibonacci.Feedback(sequence=sequence))
        if goal.request.order == 1:
            goal.abort()
        else:
            goal.succeed()
        return Fibonacci.Result(sequence=sequence)

    def _a_second(self) -> Future[None]:
        passed: Future[None] = Future()

        def end() -> None:
            timer.cancel()
            passed.set_result(None)

        timer = self.node.create_timer(1.0, end)
        return passed


@pytest.fixture
def counter(here: World) -> Counter:
    return Counter(here)


def test_looking(here: World, counter: Counter) -> None:
    ActionClient(counter.node, Fibonacci, "count")
    assert here.read("action", "list") == "/count\n"
    assert here.read("action", "list", "-t") == f"/count [{TYPE}]\n"
    assert here.read("action", "list", "-c") == "1\n"
    assert here.read("action", "type", "/count") == f"{TYPE}\n"
    assert here.read("action", "find", "example_interfaces/Fibonacci") == "/count\n"
    done = here.run("action", "find", "nav2_msgs/action/Spin")
    assert done == ("", "navette: no action has type nav2_msgs/action/Spin\n", 1)
    info = (
        "Action: /count\nAction clients: 1\n    /counter\n"
        "Action servers: 1\n    /counter\n"
    )
    assert here.read("action", "info", "/count") == info
    assert here.read("action", "info", "count", "-t") == info.replace(
        "    /counter", f"    /counter [{TYPE}]"
    )
    counted = here.read("action", "info", "count", "-c")
    assert counted == "Action: /count\nAction clients: 1\nAction servers: 1\n"
    as_json = json.loads(here.read("action", "info", "count", "--json"))
    assert as_json["servers"] == [{"node": "/counter", "type": TYPE}]


@pytest.mark.parametrize("verb", ["type", "info"])
def test_a_mistyped_action(here: World, counter: Counter, verb: str) -> None:
    done = here.run("action", verb, "/cuont")
    assert (done.out, done.code) == ("", 1)
    hint = "did you mean /count?"
    assert done.err == f"navette: no server of the action /cuont; {hint}\n"


@pytest.mark.parametrize("words", [[TYPE, "{order: 2}"], ["{order: 2}"]])
def test_send_goal(here: World, counter: Counter, words: list[str]) -> None:
    printed = here.read("action", "send_goal", "/count", *words, "-f")
    goal_id = printed.split("ID: ")[1].splitlines()[0]
    assert len(bytes.fromhex(goal_id)) == 16
    assert printed == SENT.format(goal_id=goal_id)


def test_send_goal_for_programs(here: World, counter: Counter) -> None:
    printed = here.read("action", "send_goal", "/count", "{order: 2}", "--json", "-f")
    lines = [json.loads(line) for line in printed.splitlines()]
    assert lines[0] == {"feedback": {"sequence": [0, 1]}}
    assert lines[-1] == {"status": "SUCCEEDED", "result": {"sequence": [0, 1, 1]}}


@pytest.mark.parametrize(
    ("order", "end"),
    [("1", "Goal finished with status: ABORTED\n"), ("-1", "Goal was rejected.\n")],
)
def test_a_goal_that_does_not_succeed(
    here: World, counter: Counter, order: str, end: str
) -> None:
    done = here.run("action", "send_goal", "/count", f"{{order: {order}}}")
    assert done.code == 1
    assert done.out.endswith(end)


def test_a_goal_that_takes_too_long_is_cancelled(here: World, counter: Counter) -> None:
    done = here.run("action", "send_goal", "/count", "{order: 50}", "-t", "2.5")
    assert done.code == 1
    assert done.err == "no result in 2.5 s\n"
    assert "Canceling goal...\nGoal canceled.\n" in done.out
    assert done.out.endswith("Goal finished with status: CANCELED\n")
    assert here.graph.now_ns == 3_000_000_000


def test_ctrl_c_cancels_the_goal(here: World, counter: Counter) -> None:
    def interrupt() -> None:
        timer.cancel()
        raise KeyboardInterrupt

    timer = counter.node.create_timer(2.5, interrupt)
    done = here.run("action", "send_goal", "/count", "{order: 50}")
    assert done.code == 130
    assert done.out.endswith("Canceling goal...\nGoal canceled.\n")
    here.graph.run_for(2.0)  # the server has stopped counting
    assert not counter.node.context.loop.is_running


def test_a_server_that_goes_away(here: World, counter: Counter) -> None:
    counter.node.create_timer(2.5, counter.server.destroy)
    done = here.run("action", "send_goal", "/count", "{order: 50}")
    assert done.code == 1
    assert done.err == "navette: action /count: the server was closed\n"


def test_an_action_without_a_server(here: World, counter: Counter) -> None:
    done = here.run("action", "send_goal", "/cuont", TYPE, "-w", "1")
    assert (done.out, done.code) == ("", 1)
    assert done.err.endswith("no server of the action /cuont; did you mean /count?\n")


def test_a_wrong_goal_is_not_sent(here: World, counter: Counter) -> None:
    done = here.run("action", "send_goal", "/count", "{ordre: 2}")
    assert (done.out, done.code) == ("", 2)
    assert "has no field 'ordre'; its fields: order" in done.err
