"""What is displayed of a goal, from the planner's status."""

import pytest

from navette.msgs import topics
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from navette.navigation.stack.monitor import LATCHED, MonitorNode, RunProgress
from navette.runtime.testing import GraphHarness


def after(**values: str) -> RunProgress:
    with GraphHarness() as graph:
        seen: list[RunProgress] = []
        monitor = MonitorNode(context=graph.context, on_change=seen.append)
        graph.add(monitor)
        publisher = graph.node.create_publisher(
            DiagnosticStatus, topics.PLANNER_STATUS.name, LATCHED
        )
        items = [KeyValue(key=k, value=v) for k, v in values.items()]
        publisher.publish(DiagnosticStatus(message="planning", values=items))
        graph.run_for(0.1)
        return monitor.progress


@pytest.mark.parametrize(
    ("plan", "left_m"), [({"plan": ""}, None), ({"plan": "ok"}, 0.0), ({}, 0.0)]
)
def test_the_distance_is_unknown_before_the_first_plan(
    plan: dict[str, str], left_m: float | None
) -> None:
    progress = after(
        goal_id="1", goal_x="6.2", goal_y="-3.4", distance_left_m="0.0", **plan
    )
    assert progress.goal == (6.2, -3.4)
    assert progress.distance_left_m == left_m
