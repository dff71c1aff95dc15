"""Coroutine callbacks that await a service or an action of their own group."""

from collections.abc import Callable
from typing import Any

import pytest

from navette.msgs.example_interfaces.action import Fibonacci
from navette.msgs.example_interfaces.srv import AddTwoInts
from navette.msgs.std_msgs.msg import Int64
from navette.runtime import (
    CallbackGroup,
    Client,
    Future,
    MutuallyExclusiveCallbackGroup,
    Node,
    ReentrantCallbackGroup,
)
from navette.runtime.action import ActionClient, ActionServer
from navette.runtime.testing import GraphHarness


def add(request: Any, response: Any) -> Any:
    response.sum = request.a + request.b
    return response


def make(graph: GraphHarness, name: str = "n") -> Node:
    return graph.add(Node(name, context=graph.context))


def once(node: Node, callback: Callable[[], Any]) -> None:
    """Run the callback in one timer event."""

    def fire() -> Any:
        timer.cancel()
        return callback()

    timer = node.create_timer(1.0, fire)


def serving(graph: GraphHarness) -> tuple[Node, Client]:
    node = make(graph)
    node.create_service(AddTwoInts, "add", add)
    return node, node.create_client(AddTwoInts, "add")


def test_awaiting_a_service_of_the_same_group(graph: GraphHarness) -> None:
    node, client = serving(graph)
    order: list[str] = []

    async def ask() -> None:
        order.append("asked")
        answer = await client.call_async(AddTwoInts.Request(a=4))
        order.append(f"sum {answer.sum}")

    once(node, ask)
    once(node, lambda: order.append("other"))  # no server: it waits
    graph.run_for(1.5)
    assert order == ["asked", "sum 4", "other"]
    assert node.default_callback_group.calling == 0


def test_the_order_is_the_same_in_every_run() -> None:
    def run() -> list[str]:
        with GraphHarness() as graph:
            node, client = serving(graph)
            order: list[str] = []

            async def ask(name: str) -> None:
                for number in range(3):
                    answer = await client.call_async(AddTwoInts.Request(a=number))
                    order.append(f"{name} {answer.sum} at {graph.now_ns}")

            node.create_timer(0.5, lambda: ask("a"))
            node.create_timer(0.5, lambda: ask("b"))
            graph.run_for(1.2)
            return order

    first = run()
    assert [line.split(" at ")[0] for line in first[:6]] == [
        *("a 0", "a 1", "a 2"),
        *("b 0", "b 1", "b 2"),  # of one group: one after the other
    ]
    assert len(first) == 12
    assert run() == first


def test_awaiting_through_coroutines_and_tasks(graph: GraphHarness) -> None:
    node, client = serving(graph)
    sums: list[int] = []

    async def summed(a: int) -> int:
        return int((await client.call_async(AddTwoInts.Request(a=a))).sum)

    async def ask() -> None:
        sums.append(await summed(3))
        assert node.executor is not None
        sums.append(await node.executor.create_task(summed(5)))

    once(node, ask)
    graph.run_for(1.0)
    assert sums == [3, 5]


def test_servers_that_await_each_other_in_one_group(graph: GraphHarness) -> None:
    node, remote = make(graph), make(graph, "remote")
    back = remote.create_client(AddTwoInts, "add")
    there = node.create_client(AddTwoInts, "twice")

    async def twice(request: Any, response: Any) -> Any:
        response.sum = 2 * (await back.call_async(request)).sum
        return response

    async def ask() -> None:
        sums.append((await there.call_async(AddTwoInts.Request(a=1, b=2))).sum)

    node.create_service(AddTwoInts, "add", add)
    remote.create_service(AddTwoInts, "twice", twice)
    sums: list[int] = []
    once(node, ask)
    graph.run_for(1.0)
    assert sums == [6]


def test_an_earlier_queued_request_does_not_block_a_call(
    graph: GraphHarness,
) -> None:
    node, client = serving(graph)
    other = graph.node.create_client(AddTwoInts, "/add")
    gate: Future[None] = Future()
    sums: list[int] = []

    async def ask() -> None:
        await gate
        sums.append((await client.call_async(AddTwoInts.Request(a=4))).sum)

    once(node, ask)
    graph.run_for(1.0)
    waiting = other.call_async(AddTwoInts.Request(a=1))
    graph.run_for(1.0)
    assert not waiting.done()  # what is awaited is no answer: the group is held
    gate.set_result(None)
    graph.run_for(1.0)
    assert (sums, waiting.result().sum) == ([4], 1)


def test_other_callbacks_of_the_group_are_held_meanwhile(graph: GraphHarness) -> None:
    node, remote = make(graph), make(graph, "remote")
    gate: Future[None] = Future()
    seen: list[str] = []

    async def slow(request: Any, response: Any) -> Any:
        await gate
        return response

    async def ask() -> None:
        await client.call_async(AddTwoInts.Request())
        seen.append("answered")

    remote.create_service(AddTwoInts, "slow", slow)
    client = node.create_client(AddTwoInts, "slow")
    node.create_subscription(Int64, "t", lambda _: seen.append("topic"), 10)
    publisher = graph.node.create_publisher(Int64, "/t", 10)
    once(node, ask)
    graph.run_for(1.0)
    publisher.publish(Int64())
    graph.run_for(1.0)
    assert seen == []
    gate.set_result(None)
    graph.run_for(1.0)
    assert seen == ["answered", "topic"]


def test_the_group_is_held_again_after_the_response(graph: GraphHarness) -> None:
    node, client = serving(graph)
    remote = graph.node.create_client(AddTwoInts, "/add")
    gate: Future[None] = Future()

    async def ask() -> None:
        await client.call_async(AddTwoInts.Request())
        await gate

    once(node, ask)
    graph.run_for(1.0)
    waiting = remote.call_async(AddTwoInts.Request())
    graph.run_for(1.0)
    assert not waiting.done()


def test_a_cancelled_task_ends_the_call_of_its_group(graph: GraphHarness) -> None:
    node = make(graph)
    client = node.create_client(AddTwoInts, "no_server")

    async def ask() -> None:
        await client.call_async(AddTwoInts.Request())

    task = graph.executor.create_task(ask)
    task.group = group = node.default_callback_group
    graph.run_for(1.0)
    assert group.calling == 1
    task.cancel()
    assert group.calling == 0


def test_a_cancelled_call_resumes_its_coroutine(
    graph: GraphHarness,
) -> None:
    node = make(graph)
    client = node.create_client(AddTwoInts, "no_server")
    answers: list[Any] = []

    async def ask() -> None:
        answers.append(await client.call_async(AddTwoInts.Request()))

    once(node, ask)
    graph.run_for(1.0)
    assert node.default_callback_group.calling == 1
    client.destroy()
    graph.run_for(1.0)
    assert answers == [None]
    assert node.default_callback_group.calling == 0
    assert node.default_callback_group.held == 0


@pytest.mark.parametrize(
    "group", [MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup]
)
def test_awaiting_an_action_of_the_same_group(
    graph: GraphHarness, group: type[CallbackGroup]
) -> None:
    node = make(graph)
    shared = group()
    seen: list[Any] = []

    def count(goal: Any) -> Any:
        for number in range(2):
            goal.publish_feedback(Fibonacci.Feedback(sequence=[number]))
        goal.succeed()
        return Fibonacci.Result(sequence=[0, 1])

    def receive(message: Any) -> None:
        seen.append(list(message.feedback.sequence))

    async def ask() -> None:
        goal = await client.send_goal_async(Fibonacci.Goal(order=2), receive)
        assert goal is not None
        answer = await goal.get_result_async()
        seen.append(list(answer.result.sequence))

    ActionServer(node, Fibonacci, "fib", count, callback_group=shared)
    client = ActionClient(node, Fibonacci, "fib", callback_group=shared)
    node.create_timer(1.0, ask, callback_group=shared)
    graph.run_for(1.0)
    assert seen == [[0], [1], [0, 1]]


def test_feedback_arrives_during_a_blocking_call(graph: GraphHarness) -> None:
    node = make(graph)
    seen: list[Any] = []

    def count(goal: Any) -> Any:
        goal.publish_feedback(Fibonacci.Feedback(sequence=[7]))
        goal.succeed()
        return Fibonacci.Result()

    def ask() -> None:
        client.send_goal(
            Fibonacci.Goal(),
            feedback_callback=lambda m: seen.append(list(m.feedback.sequence)),
        )
        seen.append("result")

    ActionServer(node, Fibonacci, "fib", count)
    client = ActionClient(node, Fibonacci, "fib")
    once(node, ask)
    graph.run_for(1.0)
    assert seen == [[7], "result"]
