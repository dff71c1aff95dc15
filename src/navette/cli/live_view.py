"""The live view in place of ROS 2's windows: rviz2, rqt_graph, rqt_console."""

from navette.cli.ros_program import add_live_view, ros_program
from navette.runtime import SingleThreadedExecutor


def main() -> None:
    """Serve the page until the program is interrupted.

    The program runs on where another one serves the page: launches end when their rviz2
    does.
    """
    with ros_program():
        executor = SingleThreadedExecutor()
        add_live_view(executor)
        executor.spin()
