"""Clocks that jump: nodes stay alive, the robot stops and drives on.

A simulated robot publishes ``/clock`` as a machine of its own; the stack follows it on
the system clock, which here advances event by event.
"""

import math
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from fuzz.extremes import Extremes, unusable_numbers
from fuzz.limits import rounds, within
from fuzz.subjects import SUBJECTS, Subject, recorded, stamped, valid_message
from navette.msgs import Message
from navette.msgs.copying import copy_message
from navette.msgs.rosgraph_msgs.msg import Clock
from navette.navigation.stack.options import RunOptions
from navette.navigation.stack.scene import resolve_scene
from navette.runtime import Node, VirtualClock, ns_to_stamp
from navette.runtime.testing import GraphHarness

S = 1_000_000_000
_START_NS = 1_700_000_000 * S
_LATEST_NS = (2**31 - 2) * S


class HostClock(VirtualClock):
    """Replaces the system clock: nodes may follow /clock instead."""

    is_virtual = False


class ClockedStage:
    """A stage that follows ``/clock``, with its inputs stamped by that clock."""

    def __init__(self, graph: GraphHarness, subject: Subject) -> None:
        self._graph = graph
        self.now_ns = 100 * S
        overrides = graph.context.overrides
        resolve_scene(RunOptions()).override_parameters(overrides)
        overrides.add("/**", {"use_sim_time": True}, "test")
        self.node = graph.add(subject.make(graph.context))
        self._inputs: dict[str, Message] = {
            each.topic_name: valid_message(each.topic_name, each.msg_type)
            for each in self.node.subscriptions
            if each.topic_name != "/clock"
        }

    def run(self, seconds: float) -> None:
        """Let both clocks advance, with inputs at 10 Hz."""
        for number in range(round(seconds * 20)):
            self.now_ns = min(self.now_ns + S // 20, _LATEST_NS)
            self._graph.publish("/clock", Clock(clock=ns_to_stamp(self.now_ns)))
            if number % 2 == 0:
                for topic, msg in self._inputs.items():
                    sent = stamped(copy_message(msg), self.now_ns)
                    self._graph.publish(topic, sent, latched=True)
            self._graph.run_for(0.05)


@contextmanager
def clocked(subject: Subject) -> Iterator[tuple[GraphHarness, ClockedStage]]:
    with GraphHarness(clock=HostClock(_START_NS)) as graph:
        yield graph, ClockedStage(graph, subject)


JUMPS_NS = (0, 1, S, 50 * S, 99 * S, 101 * S, 10**6 * S, _LATEST_NS, -S, -(2**31) * S)

# The simulator and the mission follow the clock of their process.
subjects = pytest.mark.parametrize(
    "subject", [each for each in SUBJECTS if each.name != "sim"], ids=str
)


@subjects
def test_a_clock_topic_that_jumps_ends_no_stage(subject: Subject) -> None:
    for seed in rounds():
        rng = Extremes(seed).rng
        with clocked(subject) as (graph, stage):
            stage.run(0.5)
            for _ in range(10):
                to_ns = JUMPS_NS[int(rng.integers(len(JUMPS_NS)))]
                if to_ns < 0:  # not a time: ignored
                    message = Clock()
                    message.clock.sec = max(to_ns // S, -(2**31))
                    message.clock.nanosec = 2**32 - 1
                    graph.publish("/clock", message)
                    graph.run_for(0.02)
                else:
                    stage.now_ns = to_ns
                with within():
                    stage.run(0.3)


@subjects
def test_a_system_clock_that_jumps_ends_no_stage(subject: Subject) -> None:
    for seed in rounds():
        rng = Extremes(seed).rng
        with GraphHarness(clock=HostClock(_START_NS)) as graph:
            overrides = graph.context.overrides
            resolve_scene(RunOptions()).override_parameters(overrides)
            node = graph.add(subject.make(graph.context))
            for _ in range(12):
                _feed(graph, node)
                with within():
                    graph.run_for(0.3)
                steps = (-3600 * S, -S, -1, 1, S, 3600 * S, -86400 * S)
                step_ns = steps[int(rng.integers(len(steps)))]
                graph.context.clock.now_ns += step_ns  # type: ignore[misc]


def test_timers_continue_after_the_system_clock_was_set_back() -> None:
    with GraphHarness(clock=HostClock(_START_NS)) as graph:
        ticks: list[int] = []
        graph.node.create_timer(0.1, lambda: ticks.append(graph.now_ns))
        graph.run_for(1.0)
        assert len(ticks) == 10
        for step_ns in (-S, -3600 * S, -(10**6) * S):
            graph.context.clock.now_ns += step_ns  # type: ignore[misc]
            ticks.clear()
            graph.run_for(1.0)
            assert len(ticks) == 10


def test_a_stage_recovers_from_a_system_clock_that_was_set_back() -> None:
    control = next(each for each in SUBJECTS if each.name == "control")
    with GraphHarness(clock=HostClock(_START_NS)) as graph:
        resolve_scene(RunOptions()).override_parameters(graph.context.overrides)
        node = graph.add(control.make(graph.context))
        commands = graph.collect("/cmd_vel_nav", "geometry_msgs/msg/Twist")
        for step_ns in (0, -S, -3600 * S, 3600 * S):
            graph.context.clock.now_ns += step_ns  # type: ignore[misc]
            commands.clear()
            graph.run_for(0.5)  # no input: the robot stands
            assert not commands.messages or commands.last.linear.x == 0.0
            for _ in range(20):
                _feed(graph, node)
                graph.run_for(0.05)
            assert commands.last.linear.x > 0.1


def _feed(graph: GraphHarness, node: Node) -> None:
    for each in node.subscriptions:
        msg = stamped(valid_message(each.topic_name, each.msg_type), graph.now_ns)
        graph.publish(each.topic_name, msg, latched=True)


def test_the_controller_stops_at_a_jump_and_drives_again() -> None:
    control = next(each for each in SUBJECTS if each.name == "control")
    with clocked(control) as (graph, stage):
        assert len(recorded()["/path"].poses) > 1  # type: ignore[attr-defined]
        commands = graph.collect("/cmd_vel_nav", "geometry_msgs/msg/Twist")
        stage.run(1.0)
        assert commands.last.linear.x > 0.1
        for to_s in (50, 10, 5000, 1):
            path = stage._inputs.pop("/path")
            stage.now_ns = to_s * S
            commands.clear()
            stage.run(0.5)
            if to_s in (50, 10, 1):  # backward: a new run, which has no path yet
                assert commands.last.linear.x == 0.0
            assert not any(unusable_numbers(each) for each in commands.messages)
            stage._inputs["/path"] = path
            stage.run(1.0)
            assert commands.last.linear.x > 0.1
            assert all(math.isfinite(each.linear.x) for each in commands.messages)
