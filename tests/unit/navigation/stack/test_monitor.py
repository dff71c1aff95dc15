"""What is displayed of a goal, from the planner's status."""

import pytest

from navette.msgs import topics
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from navette.navigation.stack.monitor import LATCHED, MonitorNode, RunProgress
from navette.runtime.testing import GraphHarness


def status(state: str, **values: str) -> DiagnosticStatus:
    items = [KeyValue(key=k, value=v) for k, v in values.items()]
    return DiagnosticStatus(
        message=state,
        level=DiagnosticStatus.ERROR if state == "stuck" else DiagnosticStatus.OK,
        values=items,
    )


def after(*received: DiagnosticStatus) -> RunProgress:
    with GraphHarness() as graph:
        monitor = MonitorNode(context=graph.context, on_change=lambda _: None)
        graph.add(monitor)
        publisher = graph.node.create_publisher(
            DiagnosticStatus, topics.PLANNER_STATUS.name, LATCHED
        )
        for each in received:
            publisher.publish(each)
            graph.run_for(0.1)
        return monitor.progress


@pytest.mark.parametrize(
    ("plan", "left_m"), [({"plan": ""}, None), ({"plan": "ok"}, 0.0), ({}, 0.0)]
)
def test_the_distance_is_unknown_before_the_first_plan(
    plan: dict[str, str], left_m: float | None
) -> None:
    progress = after(
        status("planning", goal_id="1", goal_x="6.2", goal_y="-3.4",
               distance_left_m="0.0", **plan)
    )  # fmt: skip
    assert progress.goal == (6.2, -3.4)
    assert progress.distance_left_m == left_m


def test_the_same_goal_after_a_failure_is_a_retry() -> None:
    goal = {"goal_x": "6.2", "goal_y": "-3.4"}
    drives = [
        status(state, goal_id=str(number), **goal)
        for number in (1, 2, 3)
        for state in ("following", "stuck")
    ]
    assert [after(*drives[: i + 1]).retry for i in range(6)] == [0, 0, 1, 1, 2, 2]
    other = status("planning", goal_id="4", goal_x="0.0", goal_y="0.0")
    assert after(*drives, other).retry == 0
    reached = status("reached", goal_id="3", **goal)
    assert after(reached, status("planning", goal_id="4", **goal)).retry == 0
