"""ROS 2's ``launch_testing``: unittest cases beside the processes of a launch."""

from navette.ros2.packages.launch_testing import (
    actions,
    asserts,
    event_handlers,
    markers,
    tools,
)
from navette.ros2.packages.launch_testing import process_selection as util
from navette.ros2.packages.launch_testing.decorators import (
    parametrize,
    post_shutdown_test,
    ready_to_test_action_timeout,
)
from navette.ros2.packages.launch_testing.io_handler import ActiveIoHandler, IoHandler
from navette.ros2.packages.launch_testing.proc_info_handler import (
    ActiveProcInfoHandler,
    ProcInfoHandler,
)
from navette.ros2.packages.launch_testing.ready_aggregator import ReadyAggregator

__all__ = [
    "ActiveIoHandler",
    "ActiveProcInfoHandler",
    "IoHandler",
    "ProcInfoHandler",
    "ReadyAggregator",
    "actions",
    "asserts",
    "event_handlers",
    "markers",
    "parametrize",
    "post_shutdown_test",
    "ready_to_test_action_timeout",
    "tools",
    "util",
]
