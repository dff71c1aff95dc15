"""Extreme but type-correct inputs do not end any node of the stack.

Through each subscribed topic, each service and each parameter. Outputs stay finite.
"""

import math
from collections.abc import Callable
from typing import Any

import pytest

from fuzz.extremes import Extremes, unusable_numbers
from fuzz.limits import rounds, within
from fuzz.parameter_values import extremes, infos, wrong_types
from fuzz.subjects import SUBJECTS, Feed, Subject, running, stamped, valid_message
from navette.msgs import Message, serialize
from navette.msgs.rcl_interfaces.srv import SetParameters
from navette.runtime import Node, Parameter, VirtualClock
from navette.runtime.testing import GraphHarness
from navette.sim.run_control import RunControl

pytestmark = pytest.mark.long

_INPUTS = 120
_REQUESTS = 60
#: Of the services that every node has: parameters, types, action bookkeeping.
_COMMON_REQUESTS = 10
#: They stop the time that the test itself runs in; see test_run_control.
_STOPS_TIME = ("set_simulation_state", "step_simulation")
_COMMON = ("parameter", "get_type_description", "cancel_goal", "get_result", "frames")
#: No return of a beam is infinite, and goals are passed on to the planner, which
#: refuses them by a named status.
_MAY_BE_INFINITE = (
    "sensor_msgs/msg/LaserScan",
    "geometry_msgs/msg/PoseStamped",
    "geometry_msgs/msg/PointStamped",
)

subjects = pytest.mark.parametrize("subject", SUBJECTS, ids=str)


class Outputs:
    """Checks every message that a node publishes: serializable, numbers finite."""

    def __init__(self, graph: GraphHarness, node: Node) -> None:
        self.count = 0
        own = {subscription.topic_name for subscription in node.subscriptions}
        for publisher in list(node.publishers):
            kind = publisher.msg_type._type_name_
            if publisher.topic_name in own or kind.startswith("rcl_interfaces"):
                continue
            graph.node.create_subscription(
                publisher.msg_type, publisher.topic_name, self._checker(kind), 100
            )

    def _checker(self, kind: str) -> Callable[[Message], None]:
        def check(msg: Message) -> None:
            self.count += 1
            serialize(msg)
            if kind not in _MAY_BE_INFINITE:
                assert not unusable_numbers(msg), f"{kind}: {msg!r:.500}"

        return check


@subjects
def test_topics(subject: Subject) -> None:
    for seed in rounds():
        with running(subject) as (graph, node, feed):
            extremes = Extremes(seed)
            Outputs(graph, node)
            inputs = [(s.topic_name, s.msg_type) for s in node.subscriptions]
            for topic, kind in inputs:
                for number in range(_INPUTS):
                    send_one(graph, extremes, topic, kind)
                    with within():
                        graph.run_for(0.01)
                    if number % 50 == 0:
                        feed.all()
                    elif number % 5 == 0:
                        feed.periodic()


def send_one(graph: GraphHarness, extremes: Extremes, topic: str, kind: Any) -> None:
    """Publish one extreme message, one in eight as damaged bytes."""
    valid = stamped(valid_message(topic, kind), graph.now_ns)
    draw = int(extremes.rng.integers(8))
    if draw == 0:
        data, _ = extremes.spoiled_bytes(valid)
        graph.publish(topic, valid, latched=True)
        graph._publishers[topic, kind].publish_encoded(data)
    elif draw == 1:
        graph.publish(topic, extremes.message(kind), latched=True)
    else:
        graph.publish(topic, extremes.spoiled(valid)[0], latched=True)


@subjects
def test_services(subject: Subject) -> None:
    for seed in rounds():
        with running(subject) as (graph, node, feed):
            extremes = Extremes(seed)
            Outputs(graph, node)
            services = [
                (s.service_name, s.srv_type)
                for s in node.services
                if not s.service_name.endswith(_STOPS_TIME)
            ]
            for name, kind in services:
                client = graph.node.create_client(kind, name)
                is_common = any(part in name for part in _COMMON)
                for number in range(_COMMON_REQUESTS if is_common else _REQUESTS):
                    if number % 20 == 0:
                        feed.periodic()
                    if extremes.rng.integers(2):
                        request = extremes.message(kind.Request)
                    else:
                        request, _ = extremes.spoiled(kind.Request())
                    client.call_async(request)
                    with within():
                        graph.run_for(0.01)
                client.destroy()


def test_run_control() -> None:
    for seed in rounds():
        extremes, clock = Extremes(seed), VirtualClock()
        control = RunControl(clock, None, 10_000_000, reset=lambda: None)
        for kind, serve in control.services.values():
            for _ in range(_REQUESTS):
                clock.paused = bool(extremes.rng.integers(2))
                with within():
                    response = serve(extremes.message(kind.Request), kind.Response())
                assert response is not None
        assert clock.now_ns == 0


@subjects
def test_parameters(subject: Subject) -> None:
    with running(subject) as (graph, node, feed):
        Outputs(graph, node)
        known = infos(subject.node_class.PARAMS)
        for name in list(node._node_known_parameters() or []):
            before = node.get_parameter(name)
            values = (
                *extremes(before.type_, known.get(name)),
                *wrong_types(before.type_),
            )
            for value in values:
                with within():
                    set_one(graph, node, Parameter(name, value=value), feed)
            with within():
                set_one(graph, node, before, feed)


def set_one(
    graph: GraphHarness, node: Node, parameter: Parameter[Any], feed: Feed
) -> None:
    """Set a parameter by the service; if it is accepted, drive with it for a while."""
    client = graph.node.create_client(
        SetParameters, f"{node.get_fully_qualified_name()}/set_parameters"
    )
    request = SetParameters.Request(parameters=[parameter.to_parameter_msg()])
    answer = client.call_async(request)
    graph.run_for(0.0)
    (result,) = answer.result().results
    client.destroy()
    if not result.successful:
        assert result.reason, f"{parameter.name} = {parameter.value!r} without a reason"
        return
    value = parameter.value
    for number in value if isinstance(value, list) else [value]:
        is_number = isinstance(number, float)
        assert not is_number or math.isfinite(number), f"{parameter.name} = {number}"
    feed.all()
    for _ in range(2):
        feed.periodic()
        graph.run_for(0.05)
