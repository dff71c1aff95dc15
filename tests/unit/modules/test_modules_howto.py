"""The file that docs/howto/modules.md shows is one."""

import re
from pathlib import Path
from typing import Any

PAGE = Path(__file__).parents[3] / "docs" / "howto" / "modules.md"


def test_the_example_is_read(bench: Any) -> None:
    (text,) = re.findall(r"```yaml\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)
    bench.write(text)
    bench.write("", "drive.py")
    bench.write("", "sensors.launch.py")
    bench.write("/**: {ros__parameters: {use_sim_time: true}}", "robot.yaml")
    specs = {spec.name: spec for spec in bench.specs()}
    assert list(specs) == ["sim", "robot", "sensors"]
    names = [process.name for process in specs["robot"].processes]
    assert names == ["costmap", "map_memory", "planner", "control", "pilot"]
    pilot = specs["robot"].processes[-1]
    assert pilot.env["ROS_DOMAIN_ID"] == "7"
    assert pilot.words[-4:] == ("-p", "speed_mps:=0.4", "-r", "cmd:=/cmd_vel")
    assert [process.name for process in specs["sensors"].processes] == [
        "sensors",
        "clock",
    ]
    assert specs["sensors"].processes[0].restart.limit == 3
