"""rclpy's module-level functions and their use in programs."""

import threading
from collections.abc import Iterator
from typing import Any

import pytest

import navette
from navette.errors import InvalidValueError
from navette.msgs.std_msgs.msg import String
from navette.runtime import (
    Context,
    Executor,
    ExternalShutdownException,
    Future,
    Node,
    ReentrantCallbackGroup,
    VirtualClock,
)
from navette.runtime.context import get_default_context, reset_default_context
from navette.runtime.exceptions import (
    ConditionReachedException,
    NotInitializedException,
    RCLError,
    ShutdownException,
    TimeoutException,
)


@pytest.fixture(autouse=True)
def fresh_default_context() -> Iterator[None]:
    reset_default_context()
    yield
    get_default_context().try_shutdown()
    reset_default_context()


def start() -> None:
    navette.init(args=[], clock=VirtualClock())


def test_life_cycle() -> None:
    assert not navette.ok()
    with pytest.raises(NotInitializedException, match=r"navette\.init"):
        navette.Node("early")
    start()
    assert navette.ok()
    node = navette.create_node("n")
    node.destroy_node()
    node.destroy_node()
    navette.shutdown()
    assert not navette.ok()
    with pytest.raises(RCLError, match="try_shutdown"):
        navette.shutdown()
    navette.try_shutdown()
    start()
    assert navette.ok()


def test_shutdown_after_a_shutdown_by_signal_is_allowed() -> None:
    navette.init(args=[], clock=VirtualClock())
    navette.get_default_context().try_shutdown()  # as a signal does
    navette.shutdown()
    navette.shutdown()
    assert not navette.ok()


def test_shutdown_before_init_and_init_twice() -> None:
    with pytest.raises(RuntimeError, match="before it can be shut down"):
        navette.shutdown()
    start()
    with pytest.raises(RuntimeError, match="only be called once"):
        start()


def test_init_as_a_context_manager() -> None:
    with navette.init(args=[], clock=VirtualClock()):
        assert navette.ok()
    assert not navette.ok()


def test_shutdown_destroys_nodes_and_runs_callbacks() -> None:
    start()
    called: list[str] = []
    navette.get_default_context().on_shutdown(lambda: called.append("down"))
    node = navette.Node("n")
    navette.shutdown()
    assert called == ["down"]
    assert node.get_fully_qualified_node_names() == []


def test_spin_until_shutdown_from_a_callback() -> None:
    start()
    node = navette.Node("n")
    ticks: list[int] = []

    def tick() -> None:
        ticks.append(1)
        if len(ticks) == 3:
            navette.shutdown()

    node.create_timer(1.0, tick)
    navette.spin(node)
    assert len(ticks) == 3
    assert not navette.ok()


def test_virtual_spin_ends_when_no_event_is_left() -> None:
    start()
    navette.spin(navette.Node("idle"))


def test_spin_once_runs_one_event() -> None:
    start()
    node = navette.Node("n")
    received: list[str] = []
    publisher = node.create_publisher(String, "t", 10)
    node.create_subscription(String, "t", lambda m: received.append(m.data), 10)
    for text in "abc":
        publisher.publish(String(data=text))
    navette.spin_once(node)
    assert received == ["a"]
    navette.spin_once(node, timeout_sec=0)
    assert received == ["a", "b"]


def test_spin_once_waits_for_the_timeout_at_most() -> None:
    start()
    node = navette.Node("n")
    navette.spin_once(node, timeout_sec=0.25)
    assert node.get_clock().now().nanoseconds == 250_000_000


def test_loop_with_spin_once_and_rate() -> None:
    """Publish, spin once, sleep: one message per turn is processed."""
    start()
    talker, listener = navette.Node("talker"), navette.Node("listener")
    received: list[str] = []
    publisher = talker.create_publisher(String, "t", 10)
    listener.create_subscription(String, "t", lambda m: received.append(m.data), 2)
    rate = listener.create_rate(10)
    for turn in range(3):
        for number in range(3):
            publisher.publish(String(data=f"{turn}{number}"))
        rate.sleep()
        navette.spin_once(listener, timeout_sec=0)
    assert received == ["01", "11", "21"]


def test_spin_until_future_complete() -> None:
    start()
    node = navette.Node("n")
    future: Future[str] = Future()
    node.create_timer(1.0, lambda: future.set_result("there"))
    navette.spin_until_future_complete(node, future, timeout_sec=0.5)
    assert not future.done()
    navette.spin_until_future_complete(node, future)
    assert future.result() == "there"


def test_spin_until_future_complete_inside_a_callback() -> None:
    start()
    node = navette.Node("n")
    group = navette.ReentrantCallbackGroup()
    future: Future[int] = Future()
    results: list[int | None] = []

    def ask() -> None:
        asking.cancel()
        navette.spin_until_future_complete(node, future)
        results.append(future.result())

    asking = node.create_timer(1.0, ask)
    answering = node.create_timer(
        2.0, lambda: (future.set_result(7), answering.cancel()), group
    )
    navette.spin(node)
    assert results == [7]


def test_rate_sleeps_while_another_thread_spins() -> None:
    """A common rclpy program: spin in a thread, a loop in the main thread."""
    navette.init(args=[])
    node = navette.Node("n")
    spinning = threading.Event()
    timer = node.create_timer(0.001, spinning.set)
    thread = threading.Thread(target=navette.spin, args=(node,))
    thread.start()
    assert spinning.wait(60.0)
    timer.cancel()
    rate = node.create_rate(200.0)
    before = node.get_clock().now()
    rate.sleep()
    rate.sleep()
    assert (node.get_clock().now() - before).nanoseconds >= 5_000_000
    navette.shutdown()
    thread.join(60.0)
    assert not thread.is_alive()


def test_publishing_from_another_thread_wakes_the_spinning_one() -> None:
    navette.init(args=[])
    node = navette.Node("n")
    publisher = node.create_publisher(String, "t", 10)
    received: list[str] = []

    def receive(message: String) -> None:
        received.append(message.data)
        navette.shutdown()

    node.create_subscription(String, "t", receive, 10)
    thread = threading.Thread(target=publisher.publish, args=(String(data="x"),))
    node.context.loop.call_soon(thread.start)
    navette.spin(node)
    thread.join()
    assert received == ["x"]


def test_full_queue_fed_from_another_thread_keeps_the_newest() -> None:
    navette.init(args=[])
    node = navette.Node("n")
    publisher = node.create_publisher(String, "t", 10)
    received: list[str] = []

    def receive(message: String) -> None:
        received.append(message.data)
        if message.data == "last":
            navette.shutdown()

    node.create_subscription(String, "t", receive, 1)

    def talk() -> None:
        for number in range(500):
            publisher.publish(String(data=str(number)))
        publisher.publish(String(data="last"))

    thread = threading.Thread(target=talk)
    node.context.loop.call_soon(thread.start)
    navette.spin(node)
    thread.join()
    assert received[-1] == "last"
    numbers = [int(text) for text in received[:-1]]
    assert numbers == sorted(set(numbers))


def test_shutdown_from_another_thread_waits_for_the_callback() -> None:
    navette.init(args=[])
    node = navette.Node("n")
    order: list[str] = []
    begun = threading.Event()
    closing = threading.Event()

    def slow() -> None:
        begun.set()
        assert closing.wait(60.0)
        node.create_publisher(String, "still_there", 1)
        order.append("callback ends")

    def close() -> None:
        assert begun.wait(60.0)
        node.context.on_shutdown(lambda: order.append("nodes go"))
        closing.set()
        navette.shutdown()

    node.context.loop.call_soon(slow)
    thread = threading.Thread(target=close)
    thread.start()
    navette.spin(node)
    thread.join()
    assert order == ["callback ends", "nodes go"]


def test_executor_and_nodes_must_share_the_context() -> None:
    first, second = Context(clock=VirtualClock()), Context(clock=VirtualClock())
    node = Node("n", context=first)
    with pytest.raises(InvalidValueError, match="/n belongs to another context"):
        Executor(context=second).add_node(node)
    with pytest.raises(InvalidValueError, match=r"cannot be replaced.*/n"):
        Executor(context=first, clock=VirtualClock())


def test_executor_adds_and_removes_nodes() -> None:
    executor = navette.MultiThreadedExecutor(4, clock=VirtualClock())
    node = Node("n", context=executor.context)
    assert executor.add_node(node)
    assert not executor.add_node(node)
    assert executor.get_nodes() == [node]
    assert node.executor is executor
    other = navette.SingleThreadedExecutor(context=executor.context)
    node.executor = other
    assert (executor.get_nodes(), other.get_nodes()) == ([], [node])
    with other:
        pass
    assert node.executor is None


def test_executor_conditions() -> None:
    executor = Executor(clock=VirtualClock())
    node = Node("n", context=executor.context)
    executor.add_node(node)
    ticks: list[int] = []
    node.create_timer(1.0, lambda: ticks.append(executor.now_ns))
    assert executor.spin_until_complete(lambda: len(ticks) == 2)
    assert not executor.spin_until_complete(lambda: False, timeout_ns=3_000_000_000)
    assert executor.now_ns == 5_000_000_000
    node.create_timer(0.5, executor.stop)
    executor.spin()
    assert executor.now_ns == 5_500_000_000


def test_a_nested_spin_does_not_clear_a_stop() -> None:
    executor = Executor(clock=VirtualClock())
    node = Node("n", context=executor.context)
    executor.add_node(node)

    def stop_then_wait() -> None:
        executor.stop()
        executor.spin_for(1_000_000_000)

    node.create_timer(1.0, stop_then_wait)
    node.create_timer(10.0, lambda: pytest.fail("was stopped"))
    executor.spin()
    assert executor.now_ns < 3_000_000_000


def test_create_task_on_the_executor() -> None:
    executor = Executor(clock=VirtualClock())
    task = executor.create_task(lambda a, b=0: a + b, 1, b=2)
    executor.spin_until_future_complete(task)
    assert task.result() == 3


def test_lazy_names_are_those_of_the_runtime() -> None:
    from navette import runtime
    from navette.ros2.packages import nav2_simple_commander as commander

    others = {"__version__": navette.__version__} | {
        name: getattr(commander, name) for name in ("BasicNavigator", "TaskResult")
    }
    for name in navette.__all__:
        expected = others[name] if name in others else getattr(runtime, name)
        assert getattr(navette, name) is expected
    assert "Node" in dir(navette)
    with pytest.raises(AttributeError, match="no attribute 'Nod'"):
        _ = navette.Nod


def test_remove_ros_args() -> None:
    assert navette.remove_ros_args(["p", "--ros-args", "-r", "a:=b"]) == ["p"]


def test_domain_id(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")
    context = Context()
    context.init(args=[])
    assert context.get_domain_id() == 7
    given = Context()
    given.init(args=[], domain_id=3)
    assert given.get_domain_id() == 3
    monkeypatch.setenv("ROS_DOMAIN_ID", "seven")
    with pytest.raises(InvalidValueError, match=r"ROS_DOMAIN_ID must be .+ 'seven'"):
        Context().init(args=[])


class Picking(Executor):
    """Runs ready events one by one and records their nodes."""

    def __init__(self) -> None:
        super().__init__(clock=VirtualClock())
        self.seen: list[str] = []

    def spin_once(self, timeout_sec: float | None = None) -> None:
        handler, entity, node = self.wait_for_ready_callbacks(timeout_sec)
        assert self.can_execute(entity)
        self.seen.append(node.get_name() if node is not None else "")
        handler()


def test_a_custom_executor() -> None:
    with Picking() as executor:
        node = Node("n", context=executor.context)
        executor.add_node(node)
        ticks: list[int] = []
        timer = node.create_timer(0.5, lambda: ticks.append(executor.now_ns))

        def stop() -> None:
            executor.stop()

        node.create_timer(1.6, stop)
        executor.spin()
        assert [round(t / 1e9, 3) for t in ticks] == [0.5, 1.0, 1.5]
        assert executor.seen == ["n"] * 4
        timer.cancel()
        with pytest.raises(TimeoutException, match="in time"):
            executor.wait_for_ready_callbacks(timeout_sec=0.1)
        with pytest.raises(ConditionReachedException):
            executor.wait_for_ready_callbacks(condition=lambda: True)
        executor.stop()
        with pytest.raises(ShutdownException):
            executor.wait_for_ready_callbacks()
        executor.context.shutdown()
        with pytest.raises(ExternalShutdownException):
            executor.wait_for_ready_callbacks()


def test_handlers_run_in_other_threads_one_at_a_time() -> None:
    with Picking() as executor:
        node = Node("n", context=executor.context)
        executor.add_node(node)
        names: list[str] = []
        node.create_timer(0.5, lambda: names.append(threading.current_thread().name))
        handler, _, _ = executor.wait_for_ready_callbacks()
        thread = threading.Thread(target=handler, name="worker")
        thread.start()
        thread.join(60.0)
        assert names == ["worker"]


def test_a_handler_may_run_inside_a_callback() -> None:
    with Picking() as executor:
        node = Node("n", context=executor.context)
        executor.add_node(node)
        ran: list[str] = []
        group = ReentrantCallbackGroup()
        node.create_timer(1.0, lambda: ran.append("late"), callback_group=group)
        late, _, _ = executor.wait_for_ready_callbacks()
        node.create_timer(0.1, late, callback_group=group)
        early, _, _ = executor.wait_for_ready_callbacks()
        early()
        assert ran == ["late"]


def test_spin_once_after_shutdown_raises() -> None:
    start()
    node = Node("n")
    executor = navette.SingleThreadedExecutor()
    executor.add_node(node)
    navette.shutdown()
    with pytest.raises(ExternalShutdownException, match="shut down"):
        executor.spin_once()


def test_a_missing_call_of_the_base_class_is_reported() -> None:
    class Forgot(Node):
        def __init__(self) -> None:
            self.create_timer(1.0, lambda: None)

    class Late(Node):
        def __init__(self) -> None:
            self.create_publisher(String, "t", 1)
            super().__init__("late")

    start()
    for each in (Forgot, Late):
        with pytest.raises(AttributeError, match=r"call super\(\).__init__\('name'\)"):
            each()
    with pytest.raises(AttributeError, match=r"'Node' .* no attribute 'publsher'$"):
        Node("n").publsher  # type: ignore[attr-defined]  # noqa: B018 - raises
    assert not hasattr(Node("n2"), "wings")


@pytest.mark.parametrize("not_a_node", [Node, None, "talker"])
def test_spinning_something_other_than_a_node_raises(not_a_node: Any) -> None:
    start()
    with pytest.raises(TypeError, match=r"node must be a Node, got"):
        navette.spin(not_a_node)
    with pytest.raises(TypeError, match="node must be a Node"):
        navette.spin_once(not_a_node, timeout_sec=0)
