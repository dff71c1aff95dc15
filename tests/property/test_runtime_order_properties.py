"""Event order by (time, sequence), repeatability, queue depths."""

from collections.abc import Callable

from hypothesis import given
from hypothesis import strategies as st

from navette.msgs.std_msgs.msg import Int64
from navette.runtime import VirtualClock
from navette.runtime.loop import EventLoop
from navette.runtime.testing import GraphHarness


@given(st.lists(st.integers(0, 5), max_size=30))
def test_events_run_by_time_then_by_sequence(times_ns: list[int]) -> None:
    loop = EventLoop(VirtualClock())
    order: list[tuple[int, int]] = []
    for index, time_ns in enumerate(times_ns):

        def note(entry: tuple[int, int] = (time_ns, index)) -> None:
            assert loop.clock.now_ns == entry[0]
            order.append(entry)

        loop.call_at(time_ns, note)
    loop.run()
    # Events due immediately (time 0) are in the heap too and do not overtake others.
    assert order == sorted(order)


tree = st.recursive(
    st.integers(0, 3), lambda children: st.lists(children, max_size=4), max_leaves=20
)


@given(tree)
def test_events_that_create_events_run_in_the_same_order(plan: object) -> None:
    def run() -> list[tuple[int, str]]:
        loop = EventLoop(VirtualClock())
        trace: list[tuple[int, str]] = []

        def grow(node: object, path: str) -> Callable[[], None]:
            def event() -> None:
                trace.append((loop.clock.now_ns, path))
                for index, child in enumerate(node if isinstance(node, list) else []):
                    delay = child if isinstance(child, int) else index % 3
                    loop.call_at(
                        loop.clock.now_ns + delay, grow(child, f"{path}.{index}")
                    )

            return event

        loop.call_at(0, grow(plan, "0"))
        loop.run()
        return trace

    first = run()
    assert first == run()
    assert [stamp for stamp, _ in first] == sorted(stamp for stamp, _ in first)


@given(
    periods_ms=st.lists(st.integers(1, 50), min_size=1, max_size=5),
    duration_ms=st.integers(0, 200),
)
def test_timers_fire_exactly_as_often_as_their_periods_fit(
    periods_ms: list[int], duration_ms: int
) -> None:
    with GraphHarness() as graph:
        counts = [0] * len(periods_ms)
        for index, period_ms in enumerate(periods_ms):

            def tick(index: int = index) -> None:
                counts[index] += 1
                assert graph.now_ns == counts[index] * periods_ms[index] * 1_000_000

            graph.node.create_timer(period_ms / 1000, lambda tick=tick: tick())
        graph.executor.spin_for(duration_ms * 1_000_000)
    assert counts == [duration_ms // period_ms for period_ms in periods_ms]


@given(
    depth=st.integers(1, 6),
    bursts=st.lists(st.integers(0, 10), max_size=6),
)
def test_a_queue_holds_the_newest_depth_samples(depth: int, bursts: list[int]) -> None:
    with GraphHarness() as graph:
        received: list[int] = []
        graph.node.create_subscription(
            Int64, "t", lambda m: received.append(int(m.data)), depth
        )
        publisher = graph.node.create_publisher(Int64, "t", 1)
        expected: list[int] = []
        number = 0
        for size in bursts:
            burst = list(range(number, number + size))
            number += size
            for value in burst:
                publisher.publish(Int64(data=value))
            graph.run_for(0.01)
            expected += burst[-depth:]
        assert received == expected
