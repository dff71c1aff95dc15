"""``pytest -p navette.ros2.names.pytest_plugin`` runs tests of rclpy programs.

Where ROS 2 is installed, the tests run on ROS 2. Otherwise files with
``generate_test_description`` are tests of launch_testing, and ``@pytest.mark.launch``
belongs to launch_pytest.
"""

from pathlib import Path
from typing import Any

import pytest

from navette.ros2.names.hook import install, installed_rclpy
from navette.ros2.packages.launch_pytest.plugin import LaunchPlugin
from navette.ros2.packages.launch_testing.pytest_hooks import (
    LaunchTestModule,
    is_launch_test,
)

_HAS_ROS = installed_rclpy() is not None


def pytest_addoption(parser: pytest.Parser) -> None:
    if not _HAS_ROS:
        parser.addoption(
            "--launch-args",
            nargs="*",
            default=[],
            help="name:=value arguments of launch tests",
        )


@pytest.hookimpl(tryfirst=True)
def pytest_load_initial_conftests() -> None:
    """Install the hook before pytest imports a conftest.py, which may import rclpy."""
    if not _HAS_ROS:
        install()


def pytest_configure(config: pytest.Config) -> None:
    """Install the hook before pytest imports the tests."""
    if not _HAS_ROS:
        install()
        config.addinivalue_line("markers", "launch_test: a launch with its tests")
        config.addinivalue_line("markers", "rostest: a launch with its tests")
        config.pluginmanager.register(LaunchPlugin(), "navette_launch_pytest")


def pytest_pycollect_makemodule(module_path: Path, parent: Any) -> Any:
    if _HAS_ROS or not is_launch_test(module_path):
        return None
    return LaunchTestModule.from_parent(parent, path=module_path)
