"""Command lines of nodes: names, namespaces, parameters, remappings, containers."""

import json
import math
from pathlib import Path
from typing import Any

import pytest

from navette.errors import ParameterError
from navette.ros2.packages.launch.actions import (
    DeclareLaunchArgument,
    GroupAction,
    LogInfo,
    SetLaunchConfiguration,
)
from navette.ros2.packages.launch.conditions import IfCondition
from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.substitutions import LaunchConfiguration
from navette.ros2.packages.launch_ros.actions import (
    ComposableNodeContainer,
    LifecycleNode,
    LoadComposableNodes,
    Node,
    PushRosNamespace,
    SetParameter,
    SetParametersFromFile,
    SetRemap,
    SetUseSimTime,
)
from navette.ros2.packages.launch_ros.descriptions import (
    ComposableNode,
    Parameter,
    ParameterFile,
    ParameterValue,
)
from navette.ros2.packages.launch_ros.node_arguments import parameter_text
from navette.ros2.packages.launch_ros.substitutions import (
    ExecutableInPackage,
    FindPackagePrefix,
    FindPackageShare,
)
from navette.ros2.packages.launch_ros.substitutions import Parameter as SetValue
from navette.runtime.parameter_files import parse_value

SCRIPT = "#!/usr/bin/env python3\n"


@pytest.fixture
def program(tmp_path: Path) -> str:
    file = tmp_path / "prog.py"
    file.write_text(SCRIPT)
    return str(file)


def ros_args(launch: Any, index: int = 0) -> list[str]:
    words: list[str] = launch.argv[index]
    return words[words.index("--ros-args") + 1 :] if "--ros-args" in words else []


def test_the_simplest_node_has_no_arguments(launch: Any, program: str) -> None:
    launch.run(Node(executable=program))
    assert launch.argv == [[program]]
    assert launch.labels == ["prog-1"]
    assert launch.runner.started[0].command.program.file == Path(program)
    assert not launch.runner.started[0].command.own_process


@pytest.mark.parametrize(
    ("pushed", "own", "full"),
    [
        ([], "a", "/a"),
        (["x"], "a", "/x/a"),
        (["x", "y"], "a/b", "/x/y/a/b"),
        (["x"], "/a", "/a"),
        (["x", "/y"], None, "/y"),
        (["/"], None, "/"),
    ],
)
def test_namespaces(
    launch: Any, program: str, pushed: list[str], own: str | None, full: str
) -> None:
    node = Node(executable=program, name="n", namespace=own)
    launch.run(*(PushRosNamespace(each) for each in pushed), node)
    assert f"__ns:={full}" in ros_args(launch)
    assert node.node_name == f"{full.rstrip('/')}/n"


@pytest.mark.parametrize("wrong", [{"name": "a-b"}, {"namespace": "a b"}])
def test_an_invalid_name_or_namespace_is_refused(
    launch: Any, program: str, wrong: dict[str, str]
) -> None:
    launch.run(Node(executable=program, **wrong))
    assert next(iter(wrong.values())) in launch.errors
    assert "Node(" in launch.errors


def test_parameters_of_every_kind(launch: Any, program: str, tmp_path: Path) -> None:
    file = tmp_path / "p.yaml"
    file.write_text("n:\n  ros__parameters: {x: 1}\n")
    launch.run(
        SetLaunchConfiguration("v", "2"),
        Node(
            executable=program,
            name="n",
            parameters=[
                {
                    "int": 1,
                    "float": 2.0,
                    "flag": True,
                    "text": "3",
                    "path": tmp_path,
                    "list": ["a", "b"],
                    "from_arg": LaunchConfiguration("v"),
                    "joined": [LaunchConfiguration("v"), "x"],
                    "forced": ParameterValue(LaunchConfiguration("v"), value_type=str),
                    "as_float": ParameterValue(
                        LaunchConfiguration("v"), value_type=float
                    ),
                    "nested": {"deep": 1, LaunchConfiguration("v"): 2},
                },
                str(file),
                ParameterFile(file),
                Parameter("single", [1.5]),
            ],
        ),
    )
    assert not launch.errors
    words = ros_args(launch)
    given = [w for w in words if ":=" in w or w.startswith("/")]
    assert given == [
        "__node:=n",
        "int:=1",
        "float:=2.0",
        "flag:=true",
        'text:="3"',
        f'path:="{tmp_path}"',
        'list:=["a", "b"]',
        "from_arg:=2",
        'joined:="2x"',
        'forced:="2"',
        "as_float:=2.0",
        "nested.deep:=1",
        "nested.2:=2",
        str(file),
        str(file),
        "single:=[1.5]",
    ]


@pytest.mark.parametrize(
    "value",
    [True, 0, -5, 1.0, 1e300, -2.5e-7, "", "true", "1.0", "é\n\"'", "[1]", [1, 2],
     [0.1, 1e22], ["a", "b, c"], [True], math.inf, -math.inf, "~", "2020-01-01"],
)  # fmt: skip
def test_values_survive_formatting_and_parsing(value: object) -> None:
    found = parse_value(parameter_text("x", value))
    assert found == value
    assert type(found) is type(value)
    assert math.isnan(parse_value(parameter_text("x", math.nan)))


def test_an_invalid_parameter_value(launch: Any, program: str) -> None:
    with pytest.raises(ParameterError, match="expected a bool"):
        parameter_text("x", object())
    launch.run(Node(executable=program, parameters=[{"x": None}]))
    assert "parameter 'x': None" in launch.errors
    with pytest.raises(InvalidLaunchValueError, match="expected a list"):
        Node(executable=program, parameters={"x": 1})
    with pytest.raises(InvalidLaunchValueError, match="int, float, bool, str"):
        ParameterValue(1, value_type=dict)


@pytest.mark.parametrize(
    ("value", "value_type"), [("x", int), ("1.5", int), ("3", list[int]), ("yes", int)]
)
def test_a_value_of_the_wrong_type(
    launch: Any, program: str, value: str, value_type: Any
) -> None:
    given = ParameterValue(LaunchConfiguration("v"), value_type=value_type)
    launch.run(Node(executable=program, parameters=[{"x": given}]), v=value)
    assert "expected" in launch.errors


def test_a_parameter_file_without_a_matching_node(
    launch: Any, program: str, tmp_path: Path
) -> None:
    file = tmp_path / "p.yaml"
    file.write_text("/talkre:\n  ros__parameters: {x: 1}\n")
    node = Node(executable=program, name="talker", parameters=[file])
    assert launch.run(node) == 1
    assert (
        f"{file}: has no parameters for /talker; it has some for /talkre"
        in launch.errors
    )
    assert launch.runner.started[0].signals, "what was started is ended"


def test_a_parameter_file_for_one_of_several_nodes(
    launch: Any, program: str, tmp_path: Path
) -> None:
    file = tmp_path / "p.yaml"
    file.write_text("two:\n  ros__parameters: {x: 1}\n")
    nodes = [
        Node(executable=program, name=n, parameters=[file]) for n in ("one", "two")
    ]
    assert launch.run(*nodes) == 0, launch.errors


def test_a_missing_parameter_file(launch: Any, program: str, tmp_path: Path) -> None:
    launch.run(Node(executable=program, parameters=[str(tmp_path / "no.yaml")]))
    assert "no.yaml: no such parameter file" in launch.errors


def test_substitutions_in_a_parameter_file(
    launch: Any, program: str, tmp_path: Path
) -> None:
    file = tmp_path / "p.yaml"
    file.write_text("/**:\n  ros__parameters: {x: $(var v)}\n")
    read = []
    launch.runner.behaviour = lambda p: read.append(
        Path(p.command.words[-1]).read_text()
    )
    launch.run(
        Node(executable=program, parameters=[ParameterFile(file, allow_substs=True)]),
        v="7",
    )
    assert read == ["/**:\n  ros__parameters: {x: 7}\n"]
    assert not Path(launch.argv[0][-1]).exists()


def test_settings_of_a_scope_apply_to_its_nodes(
    launch: Any, program: str, tmp_path: Path, caplog: Any
) -> None:
    file = tmp_path / "all.yaml"
    file.write_text("/**:\n  ros__parameters: {y: 1}\n")
    launch.run(
        SetUseSimTime(True),
        GroupAction(
            [
                SetParameter("x", 1.5),
                SetParametersFromFile(file),
                SetRemap("a", "b"),
                Node(
                    executable=program, parameters=[{"x": 2}], remappings=[("c", "d")]
                ),
                LogInfo(msg=["x is ", SetValue("x")]),
            ]
        ),
        Node(executable=program),
    )
    assert ros_args(launch, 0) == [
        "-p", "use_sim_time:=true", "-p", "x:=1.5", "--params-file", str(file),
        "-p", "x:=2", "-r", "a:=b", "-r", "c:=d",
    ]  # fmt: skip
    assert ros_args(launch, 1) == ["-p", "use_sim_time:=true"]
    assert "x is 1.5" in caplog.text


def test_remappings_are_pairs(launch: Any, program: str) -> None:
    launch.run(Node(executable=program, remappings=["a:=b"]))
    assert "expected a pair, as in ('from', 'to')" in launch.errors


def test_options_that_require_a_process(
    launch: Any, program: str, tmp_path: Path
) -> None:
    launch.run(
        Node(executable=program, additional_env={"A": "1"}),
        Node(executable=program, prefix="nice"),
        LifecycleNode(executable=program, name="l", namespace="", cwd=str(tmp_path)),
    )
    assert [p.command.own_process for p in launch.runner.started] == [True] * 3


def test_packages(
    launch: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: Any
) -> None:
    prefix = tmp_path / "install"
    share = prefix / "share" / "demo"
    share.mkdir(parents=True)
    index = prefix / "share" / "ament_index" / "resource_index" / "packages"
    index.mkdir(parents=True)
    (index / "demo").touch()
    (share / "package.xml").write_text(
        "<package format='3'><name>demo</name><version>1.0.0</version>"
        "<description>d</description><maintainer email='a@b.org'>a</maintainer>"
        "<license>MIT</license></package>"
    )
    tool = prefix / "lib" / "demo" / "tool"
    tool.parent.mkdir(parents=True)
    tool.write_bytes(b"\x7fELF")
    tool.chmod(0o755)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(prefix))
    launch.run(
        LogInfo(msg=[FindPackageShare("demo"), " ", FindPackagePrefix("demo")]),
        LogInfo(msg=ExecutableInPackage("tool", "demo")),
        Node(package="demo", executable="tool"),
        Node(package="demo", executable="tol"),
    )
    assert f"{prefix / 'share' / 'demo'} {prefix}" in caplog.text
    assert launch.argv == [[str(tool)]]
    assert launch.runner.started[0].command.program is None
    assert "unknown executable of demo 'tol'; known: tool" in launch.errors
    assert "Node('demo' 'tol')" in launch.errors


def requests(process: Any) -> list[dict[str, Any]]:
    return [json.loads(line) for line in process.written.splitlines()]


def test_components_are_loaded_into_their_container(launch: Any) -> None:
    def part(name: str, **options: Any) -> ComposableNode:
        return ComposableNode(package="demo", plugin="demo::Part", name=name, **options)

    launch.run(
        PushRosNamespace("robot"),
        ComposableNodeContainer(
            name="box",
            namespace="in",
            package="rclcpp_components",
            executable="component_container",
            composable_node_descriptions=[
                part("a", parameters=[{"x": 1}], remappings=[("s", "t")]),
                part("b", condition=IfCondition("false")),
            ],
        ),
        LoadComposableNodes(
            composable_node_descriptions=[part("c", namespace="sub")],
            target_container="in/box",
        ),
    )
    assert not launch.errors
    (container,) = launch.runner.started
    assert container.command.program.module == "navette.ros2.launch.container"
    assert requests(container) == [
        {
            "package": "demo",
            "plugin": "demo::Part",
            "arguments": [
                "-r", "__node:=a", "-r", "__ns:=/robot", "-p", "x:=1", "-r", "s:=t",
            ],
        },
        {
            "package": "demo",
            "plugin": "demo::Part",
            "arguments": ["-r", "__node:=c", "-r", "__ns:=/robot/sub"],
        },
    ]  # fmt: skip


def test_an_unknown_container(launch: Any) -> None:
    launch.run(
        DeclareLaunchArgument("c", default_value="box"),
        LoadComposableNodes(
            composable_node_descriptions=[], target_container=LaunchConfiguration("c")
        ),
    )
    assert "unknown target_container '/box'; started containers: none" in (
        launch.errors
    )
