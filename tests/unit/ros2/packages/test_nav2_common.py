"""nav2_common: copies of files with other values."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml

from navette.ros2.packages.launch import LaunchContext
from navette.ros2.packages.launch.conditions import IfCondition
from navette.ros2.packages.launch.substitutions import LaunchConfiguration
from navette.ros2.packages.nav2_common.launch import (
    HasNodeParams,
    ParseMultiRobotPose,
    ReplaceString,
    RewrittenYaml,
)

Rewriting = Callable[..., Any]

PARAMETERS = """
amcl:
  ros__parameters:
    use_sim_time: false
    map_topic: <ns>/map
    sizes: [0.2, 0.3]
controller:
  server:
    ros__parameters: {use_sim_time: false, plugins: {follow: {speed: 0.5}}}
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "nav2.yaml"
    path.write_text(PARAMETERS)
    return path


@pytest.fixture
def context() -> Iterator[LaunchContext]:
    context = LaunchContext()
    context.launch_configurations["sim_time"] = "True"
    yield context
    context.close()


@pytest.fixture
def rewritten(file: Path, context: LaunchContext) -> Rewriting:
    def rewrite(*args: Any, **kwargs: Any) -> Any:
        path = RewrittenYaml(str(file), *args, **kwargs).perform(context)
        return yaml.safe_load(Path(path).read_text())

    return rewrite


def test_a_name_is_rewritten_wherever_it_occurs(rewritten: Rewriting) -> None:
    content = rewritten({"use_sim_time": LaunchConfiguration("sim_time")})
    assert content["amcl"]["ros__parameters"]["use_sim_time"] is True
    server = content["controller"]["server"]["ros__parameters"]
    assert server == {"use_sim_time": True, "plugins": {"follow": {"speed": 0.5}}}


def test_a_path_is_rewritten_there_only_and_added_if_new(
    rewritten: Callable[..., Any],
) -> None:
    content = rewritten(
        {
            "controller.server.ros__parameters.plugins.follow.speed": "0.7",
            "amcl.ros__parameters.sizes.1": "4",
            "amcl.ros__parameters.new.value": "12",
            "not.a.parameter": "1",
        },
        convert_types=True,
    )
    amcl = content["amcl"]["ros__parameters"]
    assert amcl["sizes"] == [0.2, 4]
    assert amcl["new"] == {"value": 12}
    server = content["controller"]["server"]["ros__parameters"]
    assert server["plugins"]["follow"]["speed"] == 0.7
    assert "not" not in content


def test_root_keys_and_values(rewritten: Rewriting) -> None:
    content = rewritten(
        {"use_sim_time": "1.5"},
        root_key="robot1",
        key_rewrites={"amcl": "localizer"},
        value_rewrites={"<ns>/map": "/robot1/map"},
    )
    assert list(content) == ["robot1"]
    localizer = content["robot1"]["localizer"]["ros__parameters"]
    # Without convert_types a number stays text.
    assert localizer["use_sim_time"] == "1.5"
    assert localizer["map_topic"] == "/robot1/map"


def test_texts_are_replaced_if_the_condition_holds(
    file: Path, context: LaunchContext
) -> None:
    replaced = ReplaceString(str(file), {"<ns>": "/robot1"}).perform(context)
    assert "map_topic: /robot1/map" in Path(replaced).read_text()
    no = ReplaceString(str(file), {"<ns>": ""}, condition=IfCondition("false"))
    assert no.perform(context) == str(file)


def test_sections_of_nodes(file: Path, context: LaunchContext) -> None:
    assert HasNodeParams(str(file), "amcl").perform(context) == "True"
    assert HasNodeParams(str(file), "planner").perform(context) == "False"


def test_poses_of_robots(monkeypatch: pytest.MonkeyPatch) -> None:
    text = "robots:=a={x: 1.0, yaw: 0.5}; b={y: 2.0}"
    monkeypatch.setattr("sys.argv", ["launch", "file", text])
    robots = ParseMultiRobotPose("robots").value()
    assert [*robots["a"].values()] == [1.0, 0.0, 0.0, 0.0, 0.0, 0.5]
    assert robots["b"]["y"] == 2.0
    assert ParseMultiRobotPose("others").value() == {}
