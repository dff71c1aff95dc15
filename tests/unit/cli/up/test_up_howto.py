"""The examples of docs/howto/services.md and ros2.md are valid."""

import re
from pathlib import Path
from typing import Any

HOWTO = Path(__file__).parents[4] / "docs" / "howto"


def yaml_of(page: str) -> str:
    text = (HOWTO / page).read_text("utf-8")
    (found,) = re.findall(r"```yaml\n(.*?)```", text, re.DOTALL)
    return str(found)


def test_the_example_is_read(bench: Any) -> None:
    bench.write(yaml_of("services.md"))
    bench.write("", "drive.py")
    bench.write("", "sensors.launch.py")
    bench.write("/**: {ros__parameters: {use_sim_time: true}}", "robot.yaml")
    specs = {spec.name: spec for spec in bench.specs()}
    assert list(specs) == ["sim", "robot", "sensors"]
    names = [process.name for process in specs["robot"].processes]
    assert names == ["costmap", "map_memory", "planner", "control", "arbiter", "pilot"]
    pilot = specs["robot"].processes[-1]
    assert pilot.env["ROS_DOMAIN_ID"] == "7"
    assert pilot.argv[-4:] == ("-p", "speed_mps:=0.4", "-r", "cmd:=/cmd_vel")
    assert [process.name for process in specs["sensors"].processes] == [
        "sensors",
        "clock",
    ]
    assert specs["sensors"].processes[0].restart.max_attempts == 3


def test_the_example_for_a_robot_of_ros_2_is_read(bench: Any) -> None:
    bench.write(yaml_of("ros2.md"))
    (service,) = bench.specs()
    names = [process.name for process in service.processes]
    assert names == ["costmap", "map_memory", "planner", "control", "arbiter"]
    assert "/lidar:=/scan" in service.processes[0].argv
    assert any(word.startswith("map_frame:=") for word in service.processes[-2].argv)
