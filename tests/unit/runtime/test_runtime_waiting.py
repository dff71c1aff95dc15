"""Guard conditions, waiting for a message, serialisation, names."""

import threading
from typing import Any

import pytest

from navette.errors import DecodeError
from navette.msgs.std_msgs.msg import String
from navette.msgs.std_srvs.srv import Trigger
from navette.runtime import (
    Context,
    Executor,
    Future,
    Node,
    ReentrantCallbackGroup,
    SystemClock,
    VirtualClock,
    deserialize_message,
    serialize_message,
    spin_once,
)
from navette.runtime.exceptions import InvalidParameterException
from navette.runtime.guard_condition import GuardCondition
from navette.runtime.names import topic_or_service_is_hidden
from navette.runtime.parameter import validate_parameter_name
from navette.runtime.testing import GraphHarness
from navette.runtime.wait_for_message import wait_for_message
from navette.runtime.wait_set import NumberOfEntities, WaitSet
from navette.runtime.waitable import Waitable


def test_guard_condition(graph: GraphHarness) -> None:
    calls: list[int] = []
    guard = graph.node.create_guard_condition(lambda: calls.append(1))
    graph.run_for(0.1)
    assert calls == []
    guard.trigger()
    guard.trigger()
    graph.run_for(0.1)
    assert calls == [1]
    guard.trigger()
    assert list(graph.node.guards) == [guard]
    assert guard.callback_group is graph.node.default_callback_group
    assert graph.node.destroy_guard_condition(guard)
    graph.run_for(0.1)
    assert calls == [1]
    assert not graph.node.destroy_guard_condition(guard)


def test_guard_condition_from_another_thread() -> None:
    context = Context(clock=SystemClock())
    node = Node("n", context=context)
    calls: list[int] = []
    guard = node.create_guard_condition(lambda: calls.append(1))
    thread = threading.Thread(target=guard.trigger)
    thread.start()
    spin_once(node, timeout_sec=10.0)
    thread.join()
    assert calls == [1]
    context.shutdown()


def test_wait_for_message(graph: GraphHarness) -> None:
    graph.publish_every(1.0, "/t", lambda now_ns: String(data=str(now_ns)))
    found = wait_for_message(String, graph.node, "/t", time_to_wait=5.0)
    assert found == (True, String(data="1000000000"))
    lonely = Node("lonely", context=graph.context)  # without an executor
    assert wait_for_message(String, lonely, "/t")[1] == String(data="2000000000")
    assert wait_for_message(String, graph.node, "/x", time_to_wait=2) == (False, None)
    assert graph.now_ns == 4_000_000_000
    assert graph.node.count_subscribers("/t") == 0


def test_wait_for_message_from_a_callback(graph: GraphHarness) -> None:
    graph.publish_every(1.0, "/t", lambda now_ns: String(data=str(now_ns)))
    node = graph.add(Node("n", context=graph.context))
    found: list[object] = []
    # The wait is longer than the timer period; the run must still end.
    node.create_timer(
        0.5, lambda: found.append(wait_for_message(String, node, "/t")[0])
    )
    graph.run_for(0.5)
    assert found == [True, True]
    assert graph.now_ns == 2_000_000_000


def test_serialization() -> None:
    data = serialize_message(String(data="x"))
    assert deserialize_message(data, String) == String(data="x")
    with pytest.raises(DecodeError):
        deserialize_message(b"\x00", String)
    with pytest.raises(TypeError, match="which is a service"):
        deserialize_message(data, Trigger)
    with pytest.raises(TypeError, match="not a ROS 2 interface"):
        serialize_message("x")


def test_names() -> None:
    assert topic_or_service_is_hidden("/fib/_action/feedback")
    assert not topic_or_service_is_hidden("/a_b/c")
    assert validate_parameter_name("a.b")
    with pytest.raises(InvalidParameterException):
        validate_parameter_name("")


def test_a_node_without_executor_has_no_callbacks() -> None:
    context = Context(clock=VirtualClock())
    node = Node("n", context=context)
    guard = node.create_guard_condition(lambda: pytest.fail("in no executor"))
    guard.trigger()
    context.loop.run(until_ns=1)


class Doorbell(Waitable[str]):
    """Custom waitable that runs on a guard condition or when a timer is due."""

    def __init__(self, node: Node) -> None:
        super().__init__(ReentrantCallbackGroup())
        self.guard = GuardCondition(None, None, context=node.context)
        self.timer = node.create_timer(5.0, None)
        self.guard_index: int | None = None
        self.timer_index: int | None = None
        self.rung: list[str] = []
        self._reason = ""

    def add_to_wait_set(self, wait_set: WaitSet) -> None:
        self.guard_index = wait_set.add_guard_condition(self.guard.handle)
        self.timer_index = wait_set.add_timer(self.timer)

    def is_ready(self, wait_set: WaitSet) -> bool:
        if wait_set.is_ready("guard_condition", self.guard_index):
            self._reason = "guard"
        elif wait_set.is_ready("timer", self.timer_index):
            self._reason = "timer"
        return self._reason != ""

    def take_data(self) -> str:
        reason, self._reason = self._reason, ""
        return reason

    async def execute(self, taken_data: str) -> None:
        if taken_data == "guard" and not self.rung:
            self.rung.append("first")
            return
        self.rung.append(taken_data)

    def get_num_entities(self) -> NumberOfEntities:
        return NumberOfEntities(num_gcs=1, num_timers=1)


def test_a_custom_waitable(graph: GraphHarness) -> None:
    node = graph.add(Node("n", context=graph.context))
    bell = Doorbell(node)
    node.add_waitable(bell)
    assert list(node.waitables) == [bell]
    graph.run_for(1.0)
    assert bell.rung == []
    bell.guard.trigger()
    bell.guard.trigger()
    graph.run_for(1.0)
    bell.guard.trigger()
    graph.run_for(4.0)
    assert bell.rung == ["first", "guard", "timer"]
    node.remove_waitable(bell)
    assert list(node.waitables) == []


def test_an_exception_of_a_waitable_names_it(graph: GraphHarness) -> None:
    class Broken(Doorbell):
        async def execute(self, taken_data: str) -> None:
            raise ValueError(taken_data)

    node = graph.add(Node("n", context=graph.context))
    bell = Broken(node)
    node.add_waitable(bell)
    bell.guard.trigger()
    with pytest.raises(ValueError, match=r"/n: callback of waitable Broken .*guar"):
        graph.run_for(1.0)


def test_methods_that_a_waitable_must_implement() -> None:
    waitable: Waitable[Any] = Waitable(ReentrantCallbackGroup())
    wait_set = WaitSet(on_due=print)
    for call in (
        lambda: waitable.add_to_wait_set(wait_set),
        lambda: waitable.is_ready(wait_set),
        waitable.take_data,
        waitable.get_num_entities,
    ):
        with pytest.raises(NotImplementedError, match="subclass"):
            call()
    future: Future[int] = Future()
    waitable.add_future(future)
    waitable.remove_future(future)


def test_numbers_of_entities() -> None:
    total = NumberOfEntities(1, 2, 3) + NumberOfEntities(num_events=4)
    assert total == NumberOfEntities(1, 2, 3, 0, 0, 4)
    total += NumberOfEntities(num_subs=1)
    assert (total.num_subscriptions, total.num_guard_conditions) == (2, 2)
    assert repr(total) == "<NumberOfEntities(2, 2, 3, 0, 0, 4)>"
    assert total != 3


@pytest.mark.parametrize("end", ["set_result", "set_exception", "cancel"])
def test_a_spin_ends_when_another_thread_completes_its_future(end: str) -> None:
    """A future without an executor, as programs make it."""
    context = Context(clock=SystemClock())
    executor = Executor(context=context)
    future: Future[Any] = Future()
    arguments = {"set_result": [1], "set_exception": [ValueError()], "cancel": []}

    def complete() -> None:
        while not executor.loop.waiting:
            pass
        getattr(future, end)(*arguments[end])

    thread = threading.Thread(target=complete)
    thread.start()
    executor.spin_until_future_complete(future)
    thread.join()
    assert future.done()
    context.shutdown()


def test_every_done_callback_is_called_though_one_raises() -> None:
    future: Future[int] = Future()
    called: list[str] = []
    future.add_done_callback(lambda _: 1 // 0)  # type: ignore[arg-type,return-value]
    future.add_done_callback(lambda _: called.append("second"))
    removed = called.append
    future.add_done_callback(removed)  # type: ignore[arg-type]
    assert future.remove_done_callback(removed)  # type: ignore[arg-type]
    assert not future.remove_done_callback(removed)  # type: ignore[arg-type]
    with pytest.warns(RuntimeWarning, match="ZeroDivisionError"):
        future.set_result(1)
    assert called == ["second"]


def test_every_entity_has_its_callback_group(graph: GraphHarness) -> None:
    node, group = graph.node, ReentrantCallbackGroup()
    timer = node.create_timer(1.0, lambda: None, callback_group=group)
    reader = node.create_subscription(
        String, "text", lambda _: None, 10, callback_group=group
    )
    assert timer.callback_group is reader.callback_group is group
