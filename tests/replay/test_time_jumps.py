"""Bags that loop, and time jumps back: nodes reset their state.

The nodes run as with the system clock, which here jumps instead of waiting.
"""

from typing import Any

import pytest
from stages import STAGES, Stage

from navette.bags import open_bag
from navette.bags.compare.fields import message_differences
from navette.bags.compare.tolerance import EXACT
from navette.bags.play import PlayOptions
from navette.bags.play.node import PlayerNode
from navette.msgs.geometry_msgs.msg import (
    PointStamped,
    Transform,
    TransformStamped,
    Vector3,
)
from navette.msgs.std_msgs.msg import Header
from navette.msgs.tf2_msgs.msg import TFMessage
from navette.navigation.stack.recorded_parameters import give_recorded_parameters
from navette.navigation.stack.stage_classes import node_class
from navette.ros2.packages.message_filters import (
    ApproximateTimeSynchronizer,
    Cache,
    Subscriber,
)
from navette.runtime import Time, TransformListener, VirtualClock, ns_to_stamp
from navette.runtime.testing import GraphHarness
from navette.runtime.tf import Buffer

S = 1_000_000_000


class HostClock(VirtualClock):
    """Replaces the system clock: nodes may follow /clock instead."""

    is_virtual = False


def passes(stage: Stage, count: int, *, with_clock: bool) -> list[dict[str, list[Any]]]:
    """Return the outputs of the stage in each pass of its bag, by topic."""
    outputs = []
    with GraphHarness(clock=HostClock(10**18)) as graph, open_bag(stage.bag) as bag:
        overrides = graph.context.overrides
        give_recorded_parameters(overrides, bag)
        overrides.add("/**", {"use_sim_time": with_clock}, "test")
        inputs = tuple(t.name for t in bag.topics if t.name in stage.inputs)
        player = graph.add(
            PlayerNode(
                bag,
                PlayOptions(loop=True, topics=inputs),
                context=graph.context,
                clock_rate_hz=100.0 if with_clock else None,
            )
        )
        probes = [graph.collect(t.name, t.type_name) for t in bag.topics
                  if t.name in stage.outputs]  # fmt: skip
        graph.add(node_class(stage.name)(context=graph.context))  # type: ignore[call-arg]
        player.start()
        length_s = (bag.end_ns - bag.start_ns) / 1e9
        graph.run_for(-0.001 + length_s)
        for _ in range(count):
            for probe in probes:
                probe.clear()
            graph.run_for(length_s)
            outputs.append({probe.topic: list(probe.messages) for probe in probes})
    return outputs


@pytest.mark.slow
@pytest.mark.parametrize("stage", STAGES, ids=lambda stage: stage.name)
def test_every_pass_of_a_loop_gives_the_same_results(stage: Stage) -> None:
    second, third = passes(stage, 2, with_clock=True)
    assert set(second) == set(stage.outputs)
    for topic, messages in second.items():
        assert messages
        differences = [
            message_differences(one, other, lambda path: EXACT)
            for one, other in zip(messages, third[topic], strict=True)
        ]
        assert not any(differences), topic


@pytest.mark.slow
@pytest.mark.parametrize("stage", STAGES, ids=lambda stage: stage.name)
def test_a_loop_without_a_clock_gives_as_many_messages(stage: Stage) -> None:
    """Stamps jump back while the nodes' time advances."""
    second, third = passes(stage, 2, with_clock=False)
    for topic, messages in second.items():
        assert messages
        assert len(messages) == len(third[topic])


def moving(stamp_ns: int, x: float, child: str = "base") -> TFMessage:
    header = Header(stamp=ns_to_stamp(stamp_ns), frame_id="odom")
    transform = Transform(translation=Vector3(x=x))
    return TFMessage(
        transforms=[
            TransformStamped(header=header, child_frame_id=child, transform=transform)
        ]
    )


def x_of(buffer: Buffer, child: str = "base") -> float:
    found = buffer.lookup_transform("odom", child, Time())
    return float(found.transform.translation.x)


def test_a_jump_back_of_transforms_clears_the_buffer() -> None:
    with GraphHarness() as graph:
        buffer = Buffer()
        TransformListener(buffer, graph.node)
        for second in range(8):
            graph.publish("/tf", moving((100 + second) * S, float(second)))
            graph.publish("/tf", moving((100 + second) * S, -1.0, "arm"))
        graph.run_for(0.1)
        assert x_of(buffer) == 7.0
        graph.publish("/tf", moving(101 * S, 1.0))
        graph.run_for(0.1)
        assert x_of(buffer) == 1.0
        assert not buffer.can_transform("odom", "arm", Time())


def test_a_late_transform_is_not_a_jump() -> None:
    with GraphHarness() as graph:
        buffer = Buffer()
        TransformListener(buffer, graph.node)
        for stamp_s, x in ((100.0, 0.0), (101.0, 1.0), (100.5, 0.5)):
            graph.publish("/tf", moving(round(stamp_s * S), x))
        graph.run_for(0.1)
        assert x_of(buffer) == 1.0
        there = buffer.lookup_transform("odom", "base", Time(nanoseconds=100 * S))
        assert there.transform.translation.x == 0.0


def point(stamp_s: float) -> PointStamped:
    return PointStamped(header=Header(stamp=ns_to_stamp(round(stamp_s * S))))


def test_message_filters_reset() -> None:
    with GraphHarness() as graph:
        inputs = [Subscriber(graph.node, PointStamped, name) for name in ("a", "b")]
        together: list[float] = []
        both = ApproximateTimeSynchronizer(inputs, 3, 0.01)
        both.registerCallback(lambda a, b: together.append(float(a.header.stamp.sec)))
        cache = Cache(inputs[0], 10)
        for stamp_s in (100.0, 101.0, 102.0):
            graph.publish("/a", point(stamp_s))  # without partner messages
        graph.run_for(0.1)
        for stamp_s in (10.0, 11.0, 12.0, 13.0):
            graph.publish("/a", point(stamp_s))
            graph.publish("/b", point(stamp_s))
            graph.run_for(0.1)
        assert together == [10.0, 11.0, 12.0, 13.0]
        # A cache is a ring of the last messages, in any order of their stamps.
        assert [m.header.stamp.sec for m in cache.cache_msgs] == [
            *(100, 101, 102),
            *(10, 11, 12, 13),
        ]
