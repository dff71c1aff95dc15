"""Select the goals of a cancel request (action_msgs/srv/CancelGoal)."""

from collections.abc import Mapping

from navette.msgs.action_msgs.msg import GoalInfo
from navette.msgs.action_msgs.srv import CancelGoal
from navette.runtime.action.goal_states import is_cancelable
from navette.runtime.action.server_goal_handle import ServerGoalHandle
from navette.runtime.time import stamp_to_ns


def goals_to_cancel(
    requested: GoalInfo, goals: Mapping[bytes, ServerGoalHandle]
) -> tuple[int, list[ServerGoalHandle]]:
    """Return the return code and the cancellable goals that the request selects.

    Without id and time, the request selects all goals; with a time, the goals accepted
    until then and the goal with the id, if given; with an id alone, that goal.
    """
    key = bytes(requested.goal_id.uuid)
    until_ns = stamp_to_ns(requested.stamp)
    codes = CancelGoal.Response
    if any(key) and not until_ns:
        if key not in goals:
            return codes.ERROR_UNKNOWN_GOAL_ID, []
        if not is_cancelable(goals[key].status):
            return codes.ERROR_GOAL_TERMINATED, []
        return codes.ERROR_NONE, [goals[key]]
    return codes.ERROR_NONE, [
        goal
        for each, goal in goals.items()
        if is_cancelable(goal.status)
        and (
            not until_ns or each == key or stamp_to_ns(goal.goal_info.stamp) <= until_ns
        )
    ]
