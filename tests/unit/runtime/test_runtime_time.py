"""Time, Duration, clocks of nodes, simulated time from /clock."""

import pytest

from navette.msgs.rosgraph_msgs.msg import Clock as ClockMsg
from navette.msgs.std_msgs.msg import Header
from navette.runtime import (
    Clock,
    ClockType,
    Context,
    ContextClock,
    Duration,
    Executor,
    JumpThreshold,
    Node,
    Parameter,
    ROSClock,
    Time,
    TimeJump,
    VirtualClock,
    ns_to_stamp,
    stamp_to_ns,
)
from navette.runtime.clock import Wakeup
from navette.runtime.exceptions import NotInitializedException
from navette.runtime.testing import GraphHarness

S = 1_000_000_000


def test_duration() -> None:
    duration = Duration(seconds=1.5, nanoseconds=1)
    assert duration.nanoseconds == 1_500_000_001
    assert (duration + Duration(seconds=1)).nanoseconds == 2_500_000_001
    assert (Duration(seconds=1) - Duration(seconds=2)).nanoseconds == -S
    assert (Duration(seconds=1) * 0.5).nanoseconds == S // 2
    assert (Duration(seconds=1) * 3).nanoseconds == 3 * S
    assert (-Duration(seconds=1)).nanoseconds == -S
    assert Duration(seconds=1) < Duration(seconds=2) <= Duration(seconds=2)
    assert Duration(seconds=2) > Duration(seconds=1) >= Duration(seconds=1)
    assert Duration(seconds=1) == Duration(nanoseconds=S) != 3
    assert len({Duration(seconds=1), Duration(nanoseconds=S)}) == 1
    assert Duration.from_msg(duration.to_msg()) == duration
    negative = Duration(nanoseconds=-1)
    assert (negative.to_msg().sec, negative.to_msg().nanosec) == (-1, 999_999_999)
    assert Duration.from_msg(negative.to_msg()) == negative
    assert repr(duration) == "Duration(nanoseconds=1500000001)"
    with pytest.raises(OverflowError):
        Duration(seconds=1e12)
    with pytest.raises(TypeError):
        Duration.from_msg(3)  # type: ignore[arg-type]


def test_time() -> None:
    time = Time(seconds=2, nanoseconds=5)
    assert time.seconds_nanoseconds() == (2, 5)
    assert (time + Duration(seconds=1)).nanoseconds == 3 * S + 5
    assert (Duration(seconds=1) + time).nanoseconds == 3 * S + 5
    assert (time - Time(seconds=1)).nanoseconds == S + 5
    assert (time - Duration(seconds=1)).nanoseconds == S + 5
    assert Time(seconds=1) < time <= time
    assert time > Time(seconds=1)
    assert time >= time
    assert time == Time(nanoseconds=2 * S + 5)
    assert time != "time"
    assert Time.from_msg(time.to_msg(), ClockType.SYSTEM_TIME) == time
    assert "SYSTEM_TIME" in repr(time)
    assert stamp_to_ns(ns_to_stamp(123_456_789_012)) == 123_456_789_012


def test_invalid_times_raise() -> None:
    with pytest.raises(TypeError, match="cannot compare times"):
        _ = Time() == Time(clock_type=ClockType.ROS_TIME)
    with pytest.raises(TypeError, match="cannot compare times"):
        _ = Time() - Time(clock_type=ClockType.ROS_TIME)
    with pytest.raises(TypeError):
        _ = Time() < 3
    with pytest.raises(ValueError, match="negative"):
        Time(seconds=-1)
    with pytest.raises(ValueError, match="negative"):
        Time(nanoseconds=-1)
    with pytest.raises(ValueError, match="negative"):
        Time(seconds=1) - Duration(seconds=2)
    with pytest.raises(TypeError, match="clock_type"):
        Time(clock_type=1)  # type: ignore[arg-type]
    with pytest.raises(TypeError):
        Time.from_msg("x")  # type: ignore[arg-type]


def test_every_clock_of_a_virtual_context_has_its_time() -> None:
    context = Context(clock=VirtualClock(5 * S))
    for kind in (ClockType.SYSTEM_TIME, ClockType.STEADY_TIME, ClockType.ROS_TIME):
        clock = Clock(clock_type=kind, context=context)
        assert clock.now() == Time(seconds=5, clock_type=kind)
        assert isinstance(clock, ROSClock) is (kind is ClockType.ROS_TIME)
    assert Node("n", context=context).get_clock().clock_type is ClockType.ROS_TIME


def test_clock_sleeps(graph: GraphHarness) -> None:
    clock = graph.node.get_clock()
    assert clock.sleep_for(Duration(seconds=2))
    assert graph.now_ns == 2 * S
    assert clock.sleep_until(Time(seconds=3, clock_type=ClockType.ROS_TIME))
    assert clock.sleep_until(Time(seconds=1, clock_type=ClockType.ROS_TIME))
    assert graph.now_ns == 3 * S
    with pytest.raises(ValueError, match="SYSTEM_TIME"):
        clock.sleep_until(Time(seconds=4))
    graph.node.create_timer(1.0, graph.context.shutdown)
    assert not clock.sleep_for(Duration(seconds=9))
    with pytest.raises(NotInitializedException):
        clock.sleep_for(Duration(seconds=1))


class ManualClock(ContextClock):
    """Clock that is not virtual and that the test advances; never waits."""

    def __init__(self) -> None:
        self.ns = 100 * S

    @property
    def now_ns(self) -> int:
        return self.ns

    def go_to(self, target_ns: int | None, wakeup: Wakeup) -> bool:
        assert target_ns is not None, "would wait for ever"
        self.ns = max(self.ns, target_ns)
        return True


@pytest.fixture
def outside() -> tuple[Executor, Node, Node]:
    """An executor, a node with simulated time, and a node that publishes /clock."""
    executor = Executor(clock=ManualClock())
    node = Node("n", context=executor.context)
    simulator = Node("simulator", context=executor.context)
    for each in (node, simulator):
        executor.add_node(each)
    node.set_parameters([Parameter("use_sim_time", value=True)])
    return executor, node, simulator


def test_node_follows_the_clock_topic(outside: tuple[Executor, Node, Node]) -> None:
    executor, node, simulator = outside
    clock = simulator.create_publisher(ClockMsg, "/clock", 10)
    assert node.get_clock().now().nanoseconds == 0
    fired: list[int] = []
    node.create_timer(1.0, lambda: fired.append(node.get_clock().now().nanoseconds))
    for tenth in range(1, 26):
        clock.publish(ClockMsg(clock=ns_to_stamp(tenth * S // 10)))
        executor.spin_for(0)
    assert fired == [S, 2 * S]
    assert executor.now_ns == 100 * S  # the context's time did not advance
    assert simulator.get_clock().now().nanoseconds == 100 * S


def test_a_clock_set_back_is_a_jump_and_timers_continue(
    outside: tuple[Executor, Node, Node],
) -> None:
    executor, node, simulator = outside
    clock = simulator.create_publisher(ClockMsg, "/clock", 10)
    jumps: list[TimeJump] = []
    threshold = JumpThreshold(
        min_forward=None, min_backward=Duration(nanoseconds=-1), on_clock_change=False
    )
    handle = node.get_clock().create_jump_callback(
        threshold, post_callback=jumps.append
    )
    fired: list[int] = []
    node.create_timer(1.0, lambda: fired.append(node.get_clock().now().nanoseconds))

    def tell(seconds: float) -> None:
        clock.publish(ClockMsg(clock=ns_to_stamp(round(seconds * S))))
        executor.spin_for(0)

    for seconds in (5.0, 5.5, 1.0, 1.9, 2.0):
        tell(seconds)
    assert fired == [5 * S, 2 * S]
    assert [jump.delta.nanoseconds for jump in jumps] == [round(-4.5 * S)]
    handle.unregister()
    tell(0.5)
    assert len(jumps) == 1


def test_simulated_time_can_be_switched_off_again(
    outside: tuple[Executor, Node, Node],
) -> None:
    executor, node, _ = outside
    changes: list[str] = []
    threshold = JumpThreshold(min_forward=None, min_backward=None)
    node.get_clock().create_jump_callback(
        threshold,
        pre_callback=lambda: changes.append("before"),
        post_callback=lambda jump: changes.append(jump.clock_change.name),
    )
    fired: list[int] = []
    node.create_timer(1.0, lambda: fired.append(executor.now_ns))
    node.set_parameters([Parameter("use_sim_time", value=False)])
    executor.spin_for(3 * S // 2)
    assert fired == [101 * S]
    assert changes == ["before", "ROS_TIME_DEACTIVATED"]
    result = node.set_parameters([Parameter("use_sim_time", value=1)])[0]
    assert not result.successful


@pytest.mark.parametrize("begins", [False, True])
def test_a_sleep_ends_when_simulated_time_begins_or_ends(
    outside: tuple[Executor, Node, Node], begins: bool
) -> None:
    executor, node, simulator = outside
    follows = Parameter("use_sim_time", value=begins)
    if begins:
        node.set_parameters([Parameter("use_sim_time", value=False)])
    changed: list[int] = []

    def change() -> None:
        if not changed:
            node.set_parameters([follows])
            changed.append(executor.now_ns)

    simulator.create_timer(0.3, change)
    assert not node.get_clock().sleep_for(Duration(seconds=20))
    assert changed == [executor.now_ns]


def test_a_rate_begins_a_new_period_when_simulated_time_is_set_back(
    outside: tuple[Executor, Node, Node],
) -> None:
    executor, node, simulator = outside
    clock = simulator.create_publisher(ClockMsg, "/clock", 10)
    stamps = iter([50.0, 50.5, 51.0, 51.5, 1.0, 1.5, 2.0, 2.5, 3.0])

    def tell() -> None:
        clock.publish(ClockMsg(clock=ns_to_stamp(round(next(stamps) * S))))

    tell()
    executor.spin_for(0)
    simulator.create_timer(0.1, tell)
    rate = node.create_rate(1.0)
    ends = []
    for _ in range(3):
        rate.sleep()
        ends.append(node.get_clock().now().nanoseconds / S)
    assert ends == [51.0, 2.0, 3.0]


def test_use_sim_time_as_an_argument() -> None:
    context = Context(clock=ManualClock())
    context.init(["--ros-args", "-p", "use_sim_time:=true"])
    node = Node("n", context=context)
    clock = node.get_clock()
    assert isinstance(clock, ROSClock)
    assert clock.ros_time_is_active
    assert node.count_subscribers("/clock") == 1


def test_use_sim_time_has_no_effect_under_a_virtual_clock(
    graph: GraphHarness,
) -> None:
    graph.node.set_parameters([Parameter("use_sim_time", value=True)])
    graph.run_for(1.0)
    assert graph.node.get_clock().now().nanoseconds == S
    assert graph.node.count_subscribers("/clock") == 0


def test_invalid_jump_thresholds_raise(graph: GraphHarness) -> None:
    zero = Duration()
    with pytest.raises(ValueError, match="min_backward"):
        JumpThreshold(min_forward=None, min_backward=zero)
    with pytest.raises(ValueError, match="min_forward"):
        JumpThreshold(min_forward=Duration(nanoseconds=-1), min_backward=None)
    with pytest.raises(ValueError, match="at least one"):
        JumpThreshold(min_forward=None, min_backward=None, on_clock_change=False)
    threshold = JumpThreshold(min_forward=None, min_backward=None)
    with pytest.raises(ValueError, match="callable"):
        graph.node.get_clock().create_jump_callback(threshold)
    with pytest.raises(TypeError, match="clock_type"):
        Clock(clock_type=3, context=graph.context)  # type: ignore[arg-type]


def test_forward_jumps_are_reported_from_the_threshold_on(
    outside: tuple[Executor, Node, Node],
) -> None:
    _, node, _ = outside
    clock = node.get_clock()
    assert isinstance(clock, ROSClock)
    jumps: list[int] = []
    threshold = JumpThreshold(
        min_forward=Duration(seconds=1), min_backward=None, on_clock_change=False
    )
    with clock.create_jump_callback(
        threshold, post_callback=lambda jump: jumps.append(jump.delta.nanoseconds)
    ):
        for stamp in (S // 2, S, 3 * S):
            clock.set_ros_time_override(
                Time(nanoseconds=stamp, clock_type=ClockType.ROS_TIME)
            )
    assert jumps == [2 * S]


def test_a_time_assigned_to_a_message_field_raises_with_a_hint() -> None:
    with pytest.raises(
        AssertionError, match=r"is Time, expected .* \(use its to_msg\(\)"
    ):
        Header(stamp=Time(seconds=1))
