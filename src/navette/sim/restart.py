"""Messages after a reset: goal, pose estimate and maps are those of the run before.

A reset by any program, such as a service call from the command line, leaves no part of
the run before: the robot stands at its start, without a goal, and the maps are empty.
"""

from navette.msgs import topics
from navette.msgs.geometry_msgs.msg import PoseWithCovarianceStamped
from navette.msgs.nav2_msgs.srv import ClearEntireCostmap
from navette.msgs.nav_msgs.msg import Odometry
from navette.msgs.std_msgs.msg import Empty
from navette.runtime import StageNode

_CLEAR = "nav2_msgs/srv/ClearEntireCostmap"
_SETTLE_S = 0.3  # until scans are placed by the new estimate
_PLANAR = (0, 7, 35)  # x, y, yaw on the diagonal of 6 × 6
_VARIANCE = 1e-4  # of the start, in m² and rad²


def start_again(node: StageNode, truth: Odometry) -> None:
    """Cancel the goal, publish the true pose as the estimate, then clear the maps."""
    node.publish(topics.CANCEL_GOAL.name, Empty())
    estimate = PoseWithCovarianceStamped(header=truth.header, pose=truth.pose)
    for index in _PLANAR:
        estimate.pose.covariance[index] = _VARIANCE
    node.publish(topics.INITIAL_POSE.name, estimate)

    def clear() -> None:
        node.destroy_timer(timer)
        _clear_maps(node)

    timer = node.create_timer(_SETTLE_S, clear)


def _clear_maps(node: StageNode) -> None:
    for name, types in node.get_service_names_and_types():
        if _CLEAR in types:
            _clear(node, name)


def _clear(node: StageNode, name: str) -> None:
    client = node.create_client(ClearEntireCostmap, name)
    cleared = client.call_async(ClearEntireCostmap.Request())
    cleared.add_done_callback(lambda _: node.destroy_client(client))
