"""``navette cancel``: cancel the goals of every robot."""

from typing import TYPE_CHECKING

from navette.cli.output import show
from navette.cli.service_calls import ServiceRequest, call_all
from navette.cli.session import connect, endpoints, fail, wait_for
from navette.msgs import topics

if TYPE_CHECKING:
    from navette.runtime import Node

_CANCEL = "action_msgs/srv/CancelGoal"
_SUFFIX = "/_action/cancel_goal"
# Actions that send goals to others come first, so that they send no next one.
_FIRST = ("follow_waypoints", "navigate_through_poses", "navigate_to_pose")
_DELIVERY_S = 0.2


def cancel() -> None:
    """Cancel every goal: the robot stops and waits for the next one.

    Goals of Nav2's actions are cancelled, whatever sent them, and the goals that follow
    in a mission are skipped.
    """
    from navette.msgs.std_msgs.msg import Empty
    from navette.transports import EndpointKind

    with connect() as node:
        goal_topics = sorted(
            {
                each.topic
                for each in endpoints(node, kind=EndpointKind.SUBSCRIPTION)
                if each.topic.endswith(topics.CANCEL_GOAL.name)
                and each.type_name == topics.CANCEL_GOAL.type
            }
        )
        actions = _navigation_actions(node)
        if not actions and not goal_topics:
            fail(
                "no node navigates: no action of nav2_msgs and no subscription of "
                f"{topics.CANCEL_GOAL.name}; check navette node list"
            )
        requests = [ServiceRequest(a + _SUFFIX, _CANCEL, {}) for a in actions]
        answers = call_all(node, requests)
        # Then goals that no action has: of a list, or sent to a planner directly.
        for topic in goal_topics:
            node.create_publisher(Empty, topic, 1).publish(Empty())
        wait_for(node, lambda: False, _DELIVERY_S)
        cancelled = [
            action
            for action, answer in zip(actions, answers, strict=True)
            if answer.response is not None and answer.response.goals_canceling
        ]
        if cancelled:
            show(f"cancelled: {', '.join(cancelled)}")
        elif actions:
            show("no goal of an action was active")
        else:
            show(f"requested on {', '.join(goal_topics)}")
        silent = [
            f"{action}: {answer.reason}"
            for action, answer in zip(actions, answers, strict=True)
            if answer.response is None
        ]
        if silent:
            fail("; ".join(silent))


def _navigation_actions(node: "Node") -> list[str]:
    """Return the full names of the actions of nav2_msgs, composed ones first."""
    from navette.runtime.action.graph import get_action_names_and_types

    found = [
        name
        for name, types in get_action_names_and_types(node)
        if any(each.startswith("nav2_msgs/") for each in types)
    ]

    def rank(name: str) -> tuple[int, str]:
        last = name.rpartition("/")[2]
        return _FIRST.index(last) if last in _FIRST else len(_FIRST), name

    return sorted(found, key=rank)
