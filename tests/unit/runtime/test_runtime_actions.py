"""Actions: goals, feedback, cancelling, results, failures."""

from collections.abc import Callable
from typing import Any

import pytest

from navette.errors import CallbackError, MessageError
from navette.msgs.action_msgs.msg import GoalInfo, GoalStatus, GoalStatusArray
from navette.msgs.action_msgs.srv import CancelGoal
from navette.msgs.builtin_interfaces.msg import Time as TimeMsg
from navette.msgs.example_interfaces.action import Fibonacci
from navette.msgs.example_interfaces.srv import AddTwoInts
from navette.msgs.unique_identifier_msgs.msg import UUID
from navette.runtime import (
    Context,
    Executor,
    Future,
    Node,
    QoSProfile,
    ReentrantCallbackGroup,
    VirtualClock,
)
from navette.runtime.action import (
    ActionClient,
    ActionServer,
    CancelResponse,
    GoalEvent,
    GoalResponse,
    get_action_client_names_and_types_by_node,
    get_action_names_and_types,
    get_action_server_names_and_types_by_node,
)
from navette.runtime.action.goal_states import next_status
from navette.runtime.action.server import ServerGoalHandle
from navette.runtime.exceptions import RCLError, ROSInterruptException
from navette.runtime.testing import GraphHarness
from navette.runtime.type_support import NoTypeSupportImportedException

S = GoalStatus


def count_up(goal: Any) -> Any:
    """Publish feedback up to the goal's order and succeed immediately."""
    for number in range(goal.request.order):
        goal.publish_feedback(Fibonacci.Feedback(sequence=[number]))
    goal.succeed()
    return Fibonacci.Result(sequence=list(range(goal.request.order)))


class Pair:
    """A server and a client on separate nodes."""

    def __init__(self, graph: GraphHarness, execute: Any, **options: Any) -> None:
        self.graph = graph
        self.server_node = graph.add(Node("server", context=graph.context))
        self.client_node = graph.add(Node("caller", context=graph.context))
        self.server = ActionServer(
            self.server_node, Fibonacci, "fib", execute, **options
        )
        self.client = ActionClient(self.client_node, Fibonacci, "fib")

    def send(self, order: int = 3, **options: Any) -> Any:
        """Return the handle of a new goal."""
        goal = Fibonacci.Goal(order=order)
        return self.wait(self.client.send_goal_async(goal, **options))

    def wait(self, future: Any) -> Any:
        self.graph.executor.spin_until_future_complete(future, 5.0)
        return future.result()

    async def sleep(self, seconds: float) -> None:
        """Sleep inside a coroutine."""
        over: Future[None] = Future()
        loop = self.graph.context.loop
        loop.call_at(
            self.graph.now_ns + round(seconds * 1e9), lambda: over.set_result(None)
        )
        await over


@pytest.fixture
def make(graph: GraphHarness) -> Callable[..., Pair]:
    return lambda execute=count_up, **options: Pair(graph, execute, **options)


Make = Callable[..., Pair]


def test_feedback_then_result(make: Make) -> None:
    pair = make()
    feedback: list[Any] = []
    handle = pair.send(feedback_callback=feedback.append)
    assert handle.accepted
    response = pair.wait(handle.get_result_async())
    assert response.status == S.STATUS_SUCCEEDED
    assert list(response.result.sequence) == [0, 1, 2]
    assert [list(message.feedback.sequence) for message in feedback] == [[0], [1], [2]]
    assert all(message.goal_id == handle.goal_id for message in feedback)
    assert handle.status == S.STATUS_SUCCEEDED
    assert handle == handle
    assert "accepted=True, status=SUCCEEDED" in repr(handle)


def test_coroutine_callbacks(make: Make) -> None:
    async def execute(goal: Any) -> Any:
        return count_up(goal)

    async def decide(goal: Any) -> GoalResponse:
        return GoalResponse.ACCEPT if goal.order < 5 else GoalResponse.REJECT

    async def accepted(goal: ServerGoalHandle) -> None:
        goal.execute()

    pair = make(execute, goal_callback=decide, handle_accepted_callback=accepted)
    assert not pair.send(9).accepted
    assert pair.wait(pair.send(2).get_result_async()).status == S.STATUS_SUCCEEDED


def test_a_rejected_goal_has_no_result(make: Make) -> None:
    pair = make(goal_callback=lambda goal: GoalResponse.REJECT)
    handle = pair.send()
    assert not handle.accepted
    assert pair.wait(handle.get_result_async()).status == S.STATUS_UNKNOWN


def test_a_goal_callback_that_returns_none_rejects(make: Make) -> None:
    assert not make(goal_callback=lambda goal: True).send().accepted


def test_blocking_calls_from_a_callback(make: Make) -> None:
    pair = make()
    sequences: list[list[int]] = []

    def timer() -> None:
        response = pair.client.send_goal(Fibonacci.Goal(order=2))
        sequences.append(list(response.result.sequence))

    pair.client_node.create_timer(1.0, timer)
    pair.graph.run_for(1.5)
    assert sequences == [[0, 1]]


def test_blocking_calls_to_an_action_of_the_same_group(graph: GraphHarness) -> None:
    node = graph.add(Node("n", context=graph.context))
    ActionServer(node, Fibonacci, "fib", count_up)
    client = ActionClient(node, Fibonacci, "fib")
    states: list[int] = []
    node.create_timer(
        1.0, lambda: states.append(client.send_goal(Fibonacci.Goal(order=1)).status)
    )
    graph.run_for(1.5)
    assert states == [S.STATUS_SUCCEEDED]


def cancel_on_request(pair: Pair) -> Callable[[Any], Any]:
    async def execute(goal: Any) -> Any:
        for _ in range(10):
            if goal.is_cancel_requested:
                goal.canceled()
                return Fibonacci.Result(sequence=[7])
            await pair.sleep(0.5)
        goal.succeed()
        return Fibonacci.Result()

    return execute


def test_cancel(make: Make) -> None:
    pair = make(cancel_callback=lambda goal: CancelResponse.ACCEPT)
    pair.server.register_execute_callback(cancel_on_request(pair))
    handle = pair.send()
    pair.graph.run_for(1.2)
    assert handle.status == S.STATUS_EXECUTING
    canceled = pair.wait(handle.cancel_goal_async())
    assert canceled.return_code == CancelGoal.Response.ERROR_NONE
    assert [info.goal_id for info in canceled.goals_canceling] == [handle.goal_id]
    response = pair.wait(handle.get_result_async())
    assert response.status == S.STATUS_CANCELED
    assert list(response.result.sequence) == [7]
    assert pair.graph.now_ns < 3_000_000_000


def test_cancelling_is_rejected_by_default(make: Make) -> None:
    pair = make()
    pair.server.register_execute_callback(cancel_on_request(pair))
    handle = pair.send()
    canceled = pair.wait(handle.cancel_goal_async())
    assert canceled.return_code == CancelGoal.Response.ERROR_REJECTED
    assert canceled.goals_canceling == []
    assert pair.wait(handle.get_result_async()).status == S.STATUS_SUCCEEDED
    late = handle.cancel_goal()
    assert late.return_code == CancelGoal.Response.ERROR_GOAL_TERMINATED


def test_cancel_by_id_and_time(make: Make) -> None:
    pair = make(
        handle_accepted_callback=lambda goal: None,
        cancel_callback=lambda goal: CancelResponse.ACCEPT,
    )
    pair.graph.run_for(1.0)
    handles = []
    for _ in range(4):
        handles.append(pair.send())
        pair.graph.run_for(1.0)
    service = pair.client_node.create_client(CancelGoal, "fib/_action/cancel_goal")

    def cancel(**info: Any) -> list[int]:
        answer = service.call(CancelGoal.Request(goal_info=GoalInfo(**info)))
        found = [info.goal_id for info in answer.goals_canceling]
        return [i for i, handle in enumerate(handles) if handle.goal_id in found]

    assert cancel(goal_id=handles[3].goal_id, stamp=handles[0].stamp) == [0, 3]
    assert cancel(stamp=TimeMsg(sec=2)) == [1]
    assert cancel() == [2]
    unknown = service.call(
        CancelGoal.Request(goal_info=GoalInfo(goal_id=UUID(uuid=[9] * 16)))
    )
    assert unknown.return_code == CancelGoal.Response.ERROR_UNKNOWN_GOAL_ID


def test_a_goal_ends_during_the_cancel_callback(make: Make) -> None:
    goals: list[Any] = []

    def decide(goal: Any) -> CancelResponse:
        goal.succeed(Fibonacci.Result(sequence=[1]))
        return CancelResponse.ACCEPT

    def keep(goal: Any) -> None:
        goals.append(goal)
        goal.update_state(GoalEvent.EXECUTE)

    pair = make(handle_accepted_callback=keep, cancel_callback=decide)
    handle = pair.send()
    assert handle.cancel_goal().return_code == CancelGoal.Response.ERROR_REJECTED
    assert handle.get_result().status == S.STATUS_SUCCEEDED


def test_cancelling_between_blocking_waits(make: Make) -> None:
    def execute(goal: Any) -> Any:
        while not goal.is_cancel_requested:
            pair.graph.executor.spin_for(500_000_000)
        goal.canceled()
        return Fibonacci.Result()

    pair = make(execute, cancel_callback=lambda goal: CancelResponse.ACCEPT)
    sent = pair.client.send_goal_async(Fibonacci.Goal())

    async def cancel() -> None:
        await (await sent).cancel_goal_async()

    pair.client_node.create_timer(1.2, cancel)
    pair.graph.run_for(1.0)
    handle: Any = sent.result()
    assert handle.get_result().status == S.STATUS_CANCELED
    assert pair.graph.now_ns == 1_500_000_000


def test_deferred_execution(make: Make) -> None:
    waiting: list[Any] = []
    pair = make(handle_accepted_callback=waiting.append)
    handle = pair.send()
    pair.graph.run_for(1.0)
    assert handle.status == S.STATUS_ACCEPTED
    waiting[0].execute(lambda goal: goal.abort(Fibonacci.Result(sequence=[5])))
    response = handle.get_result()
    assert (response.status, list(response.result.sequence)) == (S.STATUS_ABORTED, [5])


def test_a_goal_without_a_terminal_state_is_aborted(make: Make) -> None:
    pair = make(lambda goal: Fibonacci.Result(sequence=[1]))
    response = pair.send().get_result()
    assert response.status == S.STATUS_ABORTED
    assert list(response.result.sequence) == [1]


def test_an_exception_aborts_the_goal_and_the_server_continues(
    make: Make, capsys: pytest.CaptureFixture[str]
) -> None:
    def execute(goal: Any) -> Any:
        if goal.request.order == 0:
            raise ValueError("motor gone")
        goal.succeed()
        return Fibonacci.Result()

    pair = make(execute)
    assert pair.send(order=0).get_result().status == S.STATUS_ABORTED
    shown = capsys.readouterr().err
    assert "[server.action_server]: error in the execute callback" in shown
    assert "motor gone" in shown
    assert pair.send(order=3).get_result().status == S.STATUS_SUCCEEDED


def test_a_result_of_the_wrong_type_raises(make: Make) -> None:
    def execute(goal: Any) -> None:
        goal.succeed()

    pair = make(execute)
    with pytest.raises(CallbackError, match=r"must return its .*_Result, got None"):
        pair.send().get_result()


def test_a_failing_goal_callback_fails_the_request(make: Make) -> None:
    def decide(goal: Any) -> Any:
        raise ValueError("no")

    pair = make(goal_callback=decide)
    future = pair.client.send_goal_async(Fibonacci.Goal())
    with pytest.raises(CallbackError, match="send_goal"):
        pair.graph.run_for(1.0)
    pair.graph.run_for(1.0)
    with pytest.raises(RuntimeError, match="ValueError: no"):
        future.result()


def test_results_expire_after_their_timeout(make: Make) -> None:
    pair = make(result_timeout=2.0)
    handle = pair.send()
    pair.graph.run_for(1.9)
    assert handle.get_result().status == S.STATUS_SUCCEEDED
    pair.graph.run_for(0.2)
    assert handle.get_result().status == S.STATUS_UNKNOWN
    pair.server.destroy()
    for_ever = Pair(pair.graph, count_up, result_timeout=-1)
    handle = for_ever.send()
    pair.graph.run_for(1e6)
    assert handle.get_result().status == S.STATUS_SUCCEEDED


def test_the_same_id_twice_is_rejected(make: Make) -> None:
    pair = make()
    goal_id = UUID(uuid=[4] * 16)
    assert pair.send(goal_uuid=goal_id).accepted
    assert not pair.send(goal_uuid=goal_id).accepted


def test_a_received_status_stays_as_it_was(graph: GraphHarness) -> None:
    """The server does not copy the states of its goals for each message."""
    seen: list[tuple[list[int], list[int]]] = []

    def change(message: GoalStatusArray) -> None:
        ids = [int(each.goal_info.goal_id.uuid[0]) for each in message.status_list]
        seen.append(([each.status for each in message.status_list], ids))
        for each in message.status_list:
            each.status = 0
            each.goal_info.goal_id.uuid = [0] * 16

    pair = Pair(graph, count_up)
    pair.client_node.create_subscription(
        GoalStatusArray, "fib/_action/status", change, 10
    )
    first, second = (pair.send(goal_uuid=UUID(uuid=[n] * 16)) for n in (1, 2))
    pair.wait(second.get_result_async())
    assert [status for status, _ in seen] == [[1], [2], [4], [4, 1], [4, 2], [4, 4]]
    assert [ids for _, ids in seen][-1] == [1, 2]
    assert (first.status, second.status) == (S.STATUS_SUCCEEDED,) * 2


def test_status_topic(make: Make, graph: GraphHarness) -> None:
    statuses = graph.collect("/fib/_action/status", GoalStatusArray, latched=True)
    make().send()
    graph.run_for(0.1)
    seen = [message.status_list[0].status for message in statuses.messages]
    assert seen == [S.STATUS_ACCEPTED, S.STATUS_EXECUTING, S.STATUS_SUCCEEDED]


def test_names_types_and_graph(make: Make) -> None:
    pair = make()
    found = ("/fib", ["example_interfaces/action/Fibonacci"])
    node = pair.server_node
    assert get_action_names_and_types(node) == [found]
    assert get_action_server_names_and_types_by_node(node, "server", "/") == [found]
    assert get_action_client_names_and_types_by_node(node, "server", "/") == []
    assert get_action_client_names_and_types_by_node(node, "caller", "/") == [found]
    types = dict(node.get_service_names_and_types())
    base = "example_interfaces/action/Fibonacci"
    assert types["/fib/_action/send_goal"] == [f"{base}_SendGoal"]
    assert types["/fib/_action/get_result"] == [f"{base}_GetResult"]
    assert types["/fib/_action/cancel_goal"] == ["action_msgs/srv/CancelGoal"]
    topics = dict(node.get_topic_names_and_types())
    assert topics["/fib/_action/feedback"] == [f"{base}_FeedbackMessage"]
    assert topics["/fib/_action/status"] == ["action_msgs/msg/GoalStatusArray"]
    assert list(node.waitables) == [pair.server]


def test_waiting_for_the_server(graph: GraphHarness) -> None:
    client = ActionClient(graph.node, Fibonacci, "fib")
    assert not client.wait_for_server(timeout_sec=0.5)
    with pytest.raises(TimeoutError, match="no response"):
        client.send_goal(Fibonacci.Goal())
    late = graph.add(Node("late", context=graph.context))
    late.create_timer(1.0, lambda: ActionServer(late, Fibonacci, "fib", count_up))
    assert client.wait_for_server()


def test_invalid_arguments_raise(make: Make, graph: GraphHarness) -> None:
    pair = make()
    node: Any = graph.node
    with pytest.raises(
        NoTypeSupportImportedException, match="expected an action class"
    ):
        ActionClient(node, AddTwoInts, "x")
    with pytest.raises(TypeError, match="None is not callable"):
        ActionServer(node, Fibonacci, "x", None)  # type: ignore[arg-type]
    with pytest.raises(MessageError, match=r"/fib: expected .*_Goal, got Fibonacci_R"):
        pair.client.send_goal_async(Fibonacci.Result())
    goal = ServerGoalHandle(pair.server, GoalInfo(), Fibonacci.Goal())
    with pytest.raises(TypeError, match=r"expected .*_Feedback, got Fibonacci_Goal"):
        goal.publish_feedback(Fibonacci.Goal())
    with pytest.raises(RCLError, match=r"SUCCEED is invalid .* ACCEPTED; valid"):
        goal.succeed()
    with pytest.raises(RCLError, match="valid events: none"):
        next_status(S.STATUS_ABORTED, GoalEvent.EXECUTE)


def test_destroying(make: Make, graph: GraphHarness) -> None:
    pair = make()
    handle = pair.send()
    pair.server.destroy()
    assert not pair.client.server_is_ready()
    assert list(pair.server_node.waitables) == []
    future = handle.get_result_async()
    with pair.client:
        pass
    assert future.cancelled()
    with pytest.raises(ROSInterruptException):
        pair.client.wait_for(future)
    pair.server_node.destroy_node()
    pair.client_node.destroy_node()
    assert graph.context.graph.service_endpoints() == []


def run(seed_goals: int) -> list[bytes]:
    context = Context(clock=VirtualClock())
    node = Node("n", context=context)
    executor = Executor(context=context)
    executor.add_node(node)
    ActionServer(node, Fibonacci, "fib", count_up)
    client = ActionClient(
        node,
        Fibonacci,
        "fib",
        callback_group=ReentrantCallbackGroup(),
        feedback_sub_qos_profile=QoSProfile(depth=3),
    )
    futures = [client.send_goal_async(Fibonacci.Goal()) for _ in range(seed_goals)]
    executor.spin_for(1_000_000_000)
    handles: Any = [future.result() for future in futures]
    return [bytes(handle.goal_id.uuid) for handle in handles]


def test_goal_ids_are_the_same_in_every_run() -> None:
    assert run(3) == run(3)
    assert len(set(run(3))) == 3
