"""The command ``ros2`` in launch files, where ROS 2 is not installed."""

from typing import Any

import pytest

from navette.ros2.packages.launch import LaunchContext, LaunchDescription, LaunchService
from navette.ros2.packages.launch.actions import ExecuteProcess
from navette.ros2.packages.launch.substitutions import FindExecutable


@pytest.mark.parametrize(
    "first", ["ros2", FindExecutable(name="ros2")], ids=["name", "found"]
)
def test_commands_of_ros2_are_those_of_navette(
    monkeypatch: pytest.MonkeyPatch, first: Any
) -> None:
    monkeypatch.setenv("PATH", "/usr/bin:/bin")
    action = ExecuteProcess(
        cmd=[[first, " interface show std_msgs/msg/Bool"]],
        shell=True,
        cached_output=True,
    )
    launch = LaunchService()
    launch.include_launch_description(LaunchDescription([action]))
    assert launch.run() == 0
    assert action.get_stdout() == "bool data\n"


def test_an_installed_ros2_is_used(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Any
) -> None:
    command = tmp_path / "ros2"
    command.write_text("#!/bin/sh\n")
    command.chmod(0o755)
    monkeypatch.setenv("PATH", f"/usr/bin:/bin:{tmp_path}")
    found = FindExecutable(name="ros2").perform(LaunchContext())
    assert found == str(command)
