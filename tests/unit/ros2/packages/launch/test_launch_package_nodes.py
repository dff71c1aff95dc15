"""Command lines of nodes: names, namespaces, parameters, remappings, containers."""

import os
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from navette.ros2.packages.launch import LaunchContext
from navette.ros2.packages.launch.actions import (
    GroupAction,
    LogInfo,
    OpaqueFunction,
    SetLaunchConfiguration,
    Shutdown,
    TimerAction,
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
    SetROSLogDir,
    get_composable_node_load_request,
)
from navette.ros2.packages.launch_ros.descriptions import (
    ComposableNode,
    Parameter,
    ParameterFile,
    ParameterValue,
)
from navette.ros2.packages.launch_ros.substitutions import (
    ExecutableInPackage,
    FindPackagePrefix,
    FindPackageShare,
)
from navette.ros2.packages.launch_ros.substitutions import Parameter as SetValue
from navette.ros2.packages.launch_ros.utilities import get_node_name_count
from navette.runtime import Parameter as NodeParameter
from navette.runtime.parameter_files import read_parameter_file

SCRIPT = "#!/usr/bin/env python3\n"


@pytest.fixture
def program(tmp_path: Path) -> str:
    file = tmp_path / "prog.py"
    file.write_text(SCRIPT)
    return str(file)


def ros_args(launch: Any, index: int = 0) -> list[str]:
    words: list[str] = launch.argv[index]
    return words[words.index("--ros-args") + 1 :]


def blocks(words: list[str]) -> list[Any]:
    """Return the parameters of words: rules, and contents of files."""
    pairs = pairwise(words)
    return [
        word if flag == "-p" else read_parameter_file(word)
        for flag, word in pairs
        if flag in ("-p", "--params-file")
    ]


def test_the_simplest_node_has_no_arguments(launch: Any, program: str) -> None:
    launch.run(Node(executable=program))
    assert launch.argv == [[program, "--ros-args"]]
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
    assert words[:2] == ["-r", "__node:=n"]
    values = {
        "int": 1, "float": 2.0, "flag": True, "text": "3", "path": str(tmp_path),
        "list": ["a", "b"], "from_arg": 2, "joined": "2x", "forced": "2",
        "as_float": 2.0, "nested.deep": 1, "nested.2": 2,
    }  # fmt: skip
    of_file = [("/n", {"x": 1})]
    assert blocks(words) == [[("/**", values)], of_file, of_file, "single:=[1.5]"]


def test_parameters_of_a_full_name_override_those_of_patterns(
    launch: Any, program: str
) -> None:
    node = Node(executable=program, name="n", namespace="a", parameters=[{"x": 1}])
    launch.run(node)
    assert not launch.errors
    assert blocks(ros_args(launch)) == [[("/a/n", {"x": 1})]]


@pytest.mark.parametrize(
    "value",
    [None, object(), {1, 2}, [], [1, [2]], [1, "a"], {5: 1}, {"deep": {5: 1}},
     {"deep": {"x": {1}}}],
)  # fmt: skip
def test_values_that_parameters_cannot_have(
    launch: Any, program: str, value: object
) -> None:
    launch.run(OpaqueFunction(function=lambda context: node_with(program, value)))
    assert "parameter" in launch.errors or "expected" in launch.errors


def node_with(program: str, value: object) -> list[Node]:
    return [Node(executable=program, parameters=[{"x": value}])]


def test_parameters_of_the_wrong_form(program: str) -> None:
    for wrong in ({"x": 1}, "file.yaml", [5.0]):
        with pytest.raises(TypeError, match="expected a"):
            Node(executable=program, parameters=wrong)  # type: ignore[arg-type]
    with pytest.raises(InvalidLaunchValueError, match="int, float, bool, str"):
        ParameterValue(1, value_type=dict)
    with pytest.raises(TypeError):
        ParameterValue("1", value_type=int)


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
    given = ParameterFile(file, allow_substs=True)
    launch.run(Node(executable=program, parameters=[given]), v="7")
    assert blocks(ros_args(launch)) == [[("/**", {"x": 7})]]
    copy = Path(launch.argv[0][-1])
    assert copy == given.param_file
    given.cleanup()
    assert not copy.exists()


def test_settings_of_a_scope_apply_to_its_nodes(
    launch: Any, program: str, tmp_path: Path, caplog: Any
) -> None:
    file = tmp_path / "all.yaml"
    file.write_text("/**:\n  ros__parameters: {y: 1}\n")
    launch.run(
        SetParameter("use_sim_time", "true"),
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
    words = ros_args(launch, 0)
    assert blocks(words) == [
        "use_sim_time:=true", "x:=1.5", [("/**", {"y": 1})], [("/**", {"x": 2})],
    ]  # fmt: skip
    assert words[-4:] == ["-r", "a:=b", "-r", "c:=d"]
    assert ros_args(launch, 1) == ["-p", "use_sim_time:=true"]
    assert "x is 1.5" in caplog.text


@pytest.mark.parametrize("rule", ["a:=b", ["a", "b"], ("a", "b", "c")])
def test_remappings_are_pairs(program: str, rule: object) -> None:
    with pytest.raises(TypeError, match=r"expected a pair, as in \('from', 'to'\)"):
        Node(executable=program, remappings=[rule])


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
    assert launch.argv == [[str(tool), "--ros-args"]]
    assert launch.runner.started[0].command.program is None
    assert "unknown executable of demo 'tol'; known: tool" in launch.errors
    assert "Node('demo' 'tol')" in launch.errors


def test_requests_to_load_components(tmp_path: Path) -> None:
    file = tmp_path / "p.yaml"
    file.write_text(
        "/**:\n  ros__parameters: {x: 1, y: 2}\n"
        "/robot/in/a:\n  ros__parameters: {x: 3}\n"
        "/robot/in/b:\n  ros__parameters: {z: 4}\n"
    )
    context = LaunchContext()
    for action in (
        PushRosNamespace("robot"),
        SetParameter("use_sim_time", True),
        SetRemap("s", "t"),
    ):
        action.execute(context)
    node = ComposableNode(
        package="demo",
        plugin="demo::Part",
        name="a",
        namespace="in",
        parameters=[str(file), {"w": "5"}],
        remappings=[("u", "v")],
        extra_arguments=[{"use_intra_process_comms": True}],
    )
    request = get_composable_node_load_request(node, context)
    assert (request.package_name, request.plugin_name) == ("demo", "demo::Part")
    assert (request.node_name, request.node_namespace) == ("a", "/robot/in")
    assert request.remap_rules == ["s:=t", "u:=v"]
    given = [
        NodeParameter.from_parameter_msg(each)
        for each in (*request.parameters, *request.extra_arguments)
    ]
    assert [(each.name, each.value) for each in given] == [
        ("use_sim_time", True), ("x", 3), ("y", 2), ("w", "5"),
        ("use_intra_process_comms", True),
    ]  # fmt: skip


def test_a_component_whose_condition_does_not_hold() -> None:
    node = ComposableNode(package="p", plugin="q", condition=IfCondition("false"))
    assert get_composable_node_load_request(node, LaunchContext()) is None


def test_components_wait_for_their_container_until_the_shutdown(
    launch: Any, caplog: Any
) -> None:
    node = ComposableNode(package="demo", plugin="demo::Part", name="a")
    launch.run(
        ComposableNodeContainer(
            name="box", namespace="in", composable_node_descriptions=[node]
        ),
        LoadComposableNodes(
            composable_node_descriptions=[node], target_container="bax"
        ),
        TimerAction(period=20.0, actions=[Shutdown()]),
    )
    assert not launch.errors
    (container,) = launch.runner.started
    assert container.command.program.module == "navette.ros2.launch.container"
    assert "the container '/bax' to load 1 node(s)" in caplog.text
    assert "containers of this launch: /in/box" in caplog.text


def test_names_are_counted(launch: Any, program: str, caplog: Any) -> None:
    launch.run(*(Node(executable=program, name="n", namespace="a") for _ in range(2)))
    assert get_node_name_count(launch.context, "/a/n") == 2
    assert "there are now at least 2 nodes with the name /a/n" in caplog.text


def test_a_relative_folder_of_logs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_LOG_DIR", "/logs")
    SetROSLogDir("robot").execute(LaunchContext())
    assert os.environ["ROS_LOG_DIR"] == "/logs/robot"
