"""Message filters: caches and synchronizers, with ROS 2's results."""

import itertools
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from navette.errors import CallbackError, InvalidValueError
from navette.msgs.geometry_msgs.msg import PointStamped
from navette.msgs.std_msgs.msg import String
from navette.ros2.packages.message_filters import (
    ApproximateTimeSynchronizer,
    Cache,
    SimpleFilter,
    Subscriber,
    TimeSynchronizer,
)
from navette.runtime import ClockType, Time
from navette.runtime.testing import GraphHarness

MS = 1_000_000


def point(stamp_ms: int, x: float = 0.0) -> PointStamped:
    message = PointStamped()
    message.header.stamp = Time(nanoseconds=stamp_ms * MS).to_msg()
    message.point.x = x
    return message


def ros_time(stamp_ms: int) -> Time:
    return Time(nanoseconds=stamp_ms * MS, clock_type=ClockType.ROS_TIME)


def stamp_ms_of(message: Any) -> int:
    return int(Time.from_msg(message.header.stamp).nanoseconds // MS)


class Sets:
    """Collects the output of a filter as stamps in ms."""

    def __init__(self, source: SimpleFilter) -> None:
        self.seen: list[tuple[int, ...]] = []
        source.registerCallback(self)

    def __call__(self, *messages: Any) -> None:
        self.seen.append(tuple(stamp_ms_of(m) for m in messages))


def test_callbacks_receive_their_arguments() -> None:
    source, seen = SimpleFilter(), []
    assert source.registerCallback(lambda *args: seen.append(args), "a", 1) == 0
    assert source.registerCallback(lambda *args: seen.append(args)) == 1
    source.signalMessage("m", "n")
    assert seen == [("m", "n", "a", 1), ("m", "n")]


def test_a_subscriber_is_a_subscription(graph: GraphHarness) -> None:
    subscriber = Subscriber(graph.node, PointStamped, "points", qos_profile=3)
    sets = Sets(subscriber)
    publisher = graph.node.create_publisher(PointStamped, "points", 10)
    publisher.publish(point(5))
    graph.run_for(0.0)
    assert sets.seen == [(5,)]
    assert subscriber.getTopic() == "points"
    assert subscriber.topic_name == "/points"
    assert subscriber.qos_profile.depth == 3
    with pytest.raises(AttributeError, match="no_such"):
        subscriber.no_such  # noqa: B018 - raises


@pytest.fixture
def cache() -> Cache:
    """Five messages, from 0 to 4 s."""
    cache = Cache(SimpleFilter(), 5)
    for second in range(5):
        cache.add(point(second * 1000))
    return cache


def test_cache_by_time(cache: Cache) -> None:
    def found(message: Any) -> Any:
        return None if message is None else stamp_ms_of(message)

    between = cache.getInterval(ros_time(2000), ros_time(3500))
    assert [stamp_ms_of(m) for m in between] == [2000, 3000]
    assert found(cache.getElemAfterTime(ros_time(1500))) == 2000
    assert found(cache.getElemAfterTime(ros_time(4001))) is None
    assert found(cache.getElemBeforeTime(ros_time(1500))) == 1000
    assert found(cache.getElemBeforeTime(point(3000).header.stamp)) == 3000
    assert found(cache.getLast()) == 4000
    assert cache.getLastestTime() == ros_time(4000)
    cache.add(point(9000))
    assert cache.getOldestTime() == ros_time(1000)
    with pytest.raises(InvalidValueError, match="before its start"):
        cache.getInterval(ros_time(2), ros_time(1))


def test_empty_cache() -> None:
    cache = Cache(SimpleFilter())
    assert cache.getOldestTime() is None
    assert cache.getLatestTime() is None
    assert cache.getLast() is None
    assert cache.getElemBeforeTime(ros_time(1)) is None
    with pytest.raises(InvalidValueError, match="cache_size 0"):
        Cache(SimpleFilter(), 0)


def test_messages_without_header(
    graph: GraphHarness, caplog: pytest.LogCaptureFixture
) -> None:
    subscriber = Subscriber(graph.node, String, "text")
    strict = Cache(subscriber, 5)
    lax = Cache(subscriber, 5, allow_headerless=True)
    handed_on: list[str] = []
    lax.registerCallback(lambda message: handed_on.append(message.data))
    graph.run_for(2.0)
    for word in ("one", "two"):
        graph.publish("/text", String(data=word))
        graph.run_for(0.5)
    assert strict.getLast() is None
    assert handed_on == ["one", "two"]
    assert lax.cache_times == [ros_time(2000), ros_time(2500)]  # the node's clock
    warnings = [r for r in caplog.records if "allow_headerless" in r.getMessage()]
    assert len(warnings) == 1


def test_messages_with_equal_stamps(graph: GraphHarness) -> None:
    inputs = [Subscriber(graph.node, PointStamped, name) for name in ("a", "b", "c")]
    sets = Sets(TimeSynchronizer(inputs, 10))
    for topic, stamp in [("a", 1), ("a", 2), ("b", 2), ("c", 1), ("c", 2), ("b", 1)]:
        graph.publish(f"/{topic}", point(stamp))
        graph.run_for(0.01)
    assert sets.seen == [(2, 2, 2), (1, 1, 1)]


def test_the_oldest_message_of_a_full_queue_is_dropped() -> None:
    a, b = SimpleFilter(), SimpleFilter()
    sets = Sets(TimeSynchronizer([a, b], 2))
    for stamp in (3, 1, 2):
        a.signalMessage(point(stamp))
    for stamp in (1, 2, 3):
        b.signalMessage(point(stamp))
    assert sets.seen == [(2, 2), (3, 3)]


def test_stamps_in_any_order() -> None:
    a, b = SimpleFilter(), SimpleFilter()
    sets = Sets(TimeSynchronizer([a, b], 10))
    for seconds in (5, 1, 3):
        a.signalMessage(point(seconds * 1000))
    for seconds in (1, 3, 5):
        b.signalMessage(point(seconds * 1000))
    assert sets.seen == [(1000, 1000), (3000, 3000), (5000, 5000)]


def test_a_bag_that_loops() -> None:
    a, b = SimpleFilter(), SimpleFilter()
    sets = Sets(TimeSynchronizer([a, b], 2))
    for seconds in (100, 101, 1):
        a.signalMessage(point(seconds * 1000))
    b.signalMessage(point(1000))
    assert sets.seen == [(1000, 1000)]


def test_the_exact_synchronizer_requires_stamps(graph: GraphHarness) -> None:
    TimeSynchronizer([Subscriber(graph.node, String, "text"), SimpleFilter()], 1)
    graph.publish("/text", String())
    with pytest.raises(CallbackError, match="String has no header"):
        graph.run_for(0.0)


def test_messages_with_close_stamps() -> None:
    a, b = SimpleFilter(), SimpleFilter()
    sets = Sets(ApproximateTimeSynchronizer([a, b], 10, 0.1))
    a.signalMessage(point(0))
    b.signalMessage(point(100))  # not less than the slop
    assert sets.seen == []
    a.signalMessage(point(60))
    assert sets.seen == [(60, 100)]
    b.signalMessage(point(50))
    assert sets.seen == [(60, 100), (0, 50)]


def test_the_nearest_message_is_tried_first() -> None:
    a, b, c = (SimpleFilter() for _ in range(3))
    sets = Sets(ApproximateTimeSynchronizer([a, b, c], 10, 0.05))
    for stamp in (0, 30, 100):
        a.signalMessage(point(stamp))
    for stamp in (10, 25):
        b.signalMessage(point(stamp))
    c.signalMessage(point(20))
    assert sets.seen == [(30, 25, 20)]


def test_messages_without_header_have_the_time_of_arrival(graph: GraphHarness) -> None:
    points = Subscriber(graph.node, PointStamped, "points")
    words = Subscriber(graph.node, String, "words")
    seen: list[tuple[int, str]] = []
    both = ApproximateTimeSynchronizer([points, words], 5, 0.2, allow_headerless=True)
    both.registerCallback(lambda p, w: seen.append((stamp_ms_of(p), w.data)))
    graph.run_for(1.0)
    for stamp in (500, 1100):
        graph.publish("/points", point(stamp))
    graph.publish("/words", String(data="now"))
    graph.run_for(0.0)
    assert seen == [(1100, "now")]


def test_chained_filters() -> None:
    a, b, c = (SimpleFilter() for _ in range(3))
    cached = Cache(a, 3)
    sets = Sets(ApproximateTimeSynchronizer([cached, b], 5, 0.1))
    exact = Sets(TimeSynchronizer([Cache(b), c], 5))
    a.signalMessage(point(1))
    b.signalMessage(point(2))
    c.signalMessage(point(2))
    assert (sets.seen, exact.seen) == ([(1, 2)], [(2, 2)])
    with pytest.raises(InvalidValueError, match="queue_size 0"):
        TimeSynchronizer([a, b], 0)


class Plain:
    """Reference: try every combination in order."""

    def __init__(self, inputs: int, size: int, slop: int) -> None:
        self.queues: list[list[int]] = [[] for _ in range(inputs)]
        self.size, self.slop = size, slop
        self.seen: list[tuple[int, ...]] = []

    def add(self, index: int, stamp: int) -> None:
        mine = self.queues[index]
        if stamp not in mine:
            mine.append(stamp)
        while len(mine) > self.size:
            mine.remove(min(mine))
        others = [
            sorted(
                (t for t in queue if abs(t - stamp) <= self.slop),
                key=lambda t: abs(t - stamp),
            )
            for number, queue in enumerate(self.queues)
            if number != index
        ]
        for combination in itertools.product(*others):
            chosen = [*combination[:index], stamp, *combination[index:]]
            close = max(chosen) - min(chosen) < self.slop
            if close and stamp in mine:
                self.seen.append(tuple(chosen))
                for queue, taken in zip(self.queues, chosen, strict=True):
                    queue.remove(taken)
                return


@given(
    st.integers(2, 4),
    st.integers(1, 6),
    st.integers(0, 12),
    st.lists(st.tuples(st.integers(0, 3), st.integers(0, 40)), max_size=60),
)
def test_same_sets_as_the_reference(
    inputs: int, size: int, slop: int, events: list[tuple[int, int]]
) -> None:
    sources = [SimpleFilter() for _ in range(inputs)]
    sets = Sets(ApproximateTimeSynchronizer(sources, size, slop / 1000))
    plain = Plain(inputs, size, slop)
    for index, stamp in events:
        sources[index % inputs].signalMessage(point(stamp))
        plain.add(index % inputs, stamp)
    assert sets.seen == plain.seen
