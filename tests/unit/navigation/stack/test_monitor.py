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


def test_a_goal_that_timed_out_is_not_shown_as_cancelled() -> None:
    shown: list[tuple[str, str]] = []
    with GraphHarness() as graph:
        monitor = MonitorNode(
            context=graph.context,
            on_change=lambda progress: shown.append((progress.goal_id, progress.state)),
        )
        graph.add(monitor)
        publisher = graph.node.create_publisher(
            DiagnosticStatus, topics.PLANNER_STATUS.name, LATCHED
        )

        def receive(state: str, goal_id: str) -> None:
            publisher.publish(
                status(state, goal_id=goal_id, goal_x="1.0", goal_y="0.0")
            )
            graph.run_for(0.1)

        receive("following", "1")
        monitor.on_timed_out((1.0, 0.0))
        receive("canceled", "1")
        receive("canceled", "1")  # a status is repeated
        receive("following", "2")
        receive("canceled", "2")
    states = [("following", "1"), ("timed_out", "1"), ("following", "2")]
    assert shown == [(i, state) for state, i in [*states, ("canceled", "2")]]


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


@pytest.mark.parametrize(("reported", "retry"), [({"retry": "2"}, 2), ({}, 0)])
def test_the_planner_reports_retries(reported: dict[str, str], retry: int) -> None:
    progress = after(
        status("following", goal_id="3", goal_x="6.2", goal_y="-3.4", **reported)
    )
    assert progress.retry == retry
