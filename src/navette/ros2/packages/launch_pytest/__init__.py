"""ROS 2's ``launch_pytest``: pytest tests beside the processes of a launch."""

from navette.ros2.packages.launch_pytest import actions, tools
from navette.ros2.packages.launch_pytest.fixture import fixture

__all__ = ["actions", "fixture", "tools"]
