"""Extreme but type-correct inputs do not end any node of the stack.

Through each subscribed topic, each service and each parameter. Outputs stay finite.
"""

from collections.abc import Callable
from typing import Any

import pytest

from fuzz.extremes import Extremes, unusable_numbers
from fuzz.limits import rounds, within
from fuzz.subjects import SUBJECTS, Subject, running, stamped, valid_message
from navette.msgs import Message, serialize
from navette.runtime import Node
from navette.testing import GraphHarness

_INPUTS = 300
_REQUESTS = 200
#: Types in which infinite numbers have a meaning: no return of a beam.
_MAY_BE_INFINITE = ("sensor_msgs/msg/LaserScan",)

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
            feed()
            graph.run_for(0.2)
            inputs = [(s.topic_name, s.msg_type) for s in node.subscriptions]
            for topic, kind in inputs:
                for number in range(_INPUTS):
                    send_one(graph, extremes, topic, kind)
                    with within():
                        graph.run_for(0.01)
                    if number % 5 == 0:
                        feed()


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
            services = [(s.srv_name, s.srv_type) for s in node.services]
            for name, kind in services:
                client = graph.node.create_client(kind, name)
                for number in range(_REQUESTS):
                    if number % 20 == 0:
                        feed()
                    if extremes.rng.integers(2):
                        request = extremes.message(kind.Request)
                    else:
                        request, _ = extremes.spoiled(kind.Request())
                    client.call_async(request)
                    with within():
                        graph.run_for(0.01)
                client.destroy()
