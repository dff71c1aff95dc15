"""``navette launch`` from end to end: nodes in this process, and one process each."""

import os
import re
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import navette
from navette.errors import InvalidValueError, NavetteError
from navette.ros2.launch import launch, parse_launch_arguments, show_arguments
from navette.ros2.launch.session import find_launch_file
from navette.ros2.names import install, uninstall

pytestmark = pytest.mark.slow
NODES = '''
import sys

import rclpy
from rclpy.node import Node
from std_msgs.msg import String


class Talker(Node):
    def __init__(self):
        super().__init__("talker")
        word = self.declare_parameter("word", "hello").value
        publisher = self.create_publisher(String, "chatter", 10)
        self.create_timer(0.01, lambda: publisher.publish(String(data=word)))


class Listener(Node):
    """Ends, and its program with it, at the first message."""

    def __init__(self):
        super().__init__("listener")
        self.create_subscription(String, "chatter", self.receive, 10)

    def receive(self, message):
        print("received", message.data, "as", self.get_fully_qualified_name())
        raise SystemExit(0)


def spin(node_class):
    rclpy.init()
    node = node_class()
    try:
        sys.stdout.write("ready\\n")  # at once: SIGINT may follow
        rclpy.spin(node)
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        print("interrupted")
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


def talker():
    spin(Talker)


def listener():
    spin(Listener)


def arguments():
    print("argv", sys.argv)


def broken():
    raise ValueError("of its own making")


def stuck():
    import threading

    try:
        print("stuck")
        threading.Event().wait()
    except KeyboardInterrupt:  # it may arrive before the wait
        threading.Event().wait()
'''
TAIL = """
from launch import LaunchDescription
from launch.actions import *
from launch.conditions import IfCondition
from launch.event_handlers import OnProcessExit, OnProcessIO, OnProcessStart
from launch.substitutions import LaunchConfiguration, ThisLaunchFileDir
from launch_ros.actions import *
from launch_ros.descriptions import ComposableNode
from launch_ros.substitutions import FindPackageShare
import launch.events
import launch.logging
import logging


def shut_down_after_an_error(context):
    class End(logging.Handler):
        def emit(self, record):
            if record.levelname == "ERROR":
                context.emit_event_sync(launch.events.Shutdown())

    launch.logging.get_logger("launch_ros").addHandler(End())
"""


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    package = tmp_path / "src" / "parlance"
    (package / "parlance").mkdir(parents=True)
    (package / "launch").mkdir()
    (package / "parlance" / "__init__.py").touch()
    (package / "parlance" / "nodes.py").write_text(NODES)
    (package / "package.xml").write_text(
        "<package format='3'><name>parlance</name><version>1.0.0</version>"
        "<description>d</description><maintainer email='a@b.org'>a</maintainer>"
        "<license>MIT</license></package>"
    )
    names = ("talker", "listener", "arguments", "broken", "stuck")
    scripts = ", ".join(f"'{name} = parlance.nodes:{name}'" for name in names)
    (package / "setup.py").write_text(
        "from setuptools import setup\n"
        f"setup(name='parlance', entry_points={{'console_scripts': [{scripts}]}})\n"
    )
    monkeypatch.chdir(tmp_path)
    path = list(sys.path)
    install()
    yield package
    uninstall()
    sys.path[:] = path
    for name in [n for n in sys.modules if n.partition(".")[0] == "parlance"]:
        del sys.modules[name]


def write(package: Path, body: str) -> Path:
    file = package / "launch" / "it.launch.py"
    file.write_text(
        f"{TAIL}\ndef generate_launch_description():\n    return LaunchDescription([\n"
        f"{body}\n    ])\n"
    )
    return file


def test_nodes_of_one_process_communicate(workspace: Path, capsys: Any) -> None:
    file = write(
        workspace,
        """
        DeclareLaunchArgument("word", default_value="hi"),
        GroupAction([
            PushRosNamespace("robot"),
            Node(package="parlance", executable="talker",
                 parameters=[{"word": LaunchConfiguration("word")}]),
            Node(package="parlance", executable="listener", name="ear",
                 on_exit=Shutdown(reason="received")),
        ]),
        """,
    )
    assert launch(file, {"word": "salut"}) == 0
    out, err = capsys.readouterr()
    assert "[listener-2] received salut as /robot/ear\n" in out
    assert "[talker-1] interrupted\n" in out
    assert "[INFO] [launch]: process[listener-2] was required" in out
    assert not err


def test_a_process_per_node(workspace: Path, capfd: Any) -> None:
    file = write(
        workspace,
        """
        Node(package="parlance", executable="arguments", arguments=["--x", "a b"],
             name="n", ros_arguments=["--log-level", "debug"]),
        """,
    )
    assert launch(file, {}, processes=True) == 0
    out = capfd.readouterr().out
    assert (
        "'--x', 'a b', '--ros-args', '--log-level', 'debug', '--ros-args', '-r'" in out
    )
    assert "[arguments-1] argv ['parlance" in out


def test_each_program_has_its_own_arguments(workspace: Path, capsys: Any) -> None:
    file = write(
        workspace,
        """
        Node(package="parlance", executable="arguments", arguments=["one"]),
        Node(package="parlance", executable="arguments", arguments=["two"]),
        """,
    )
    argv = sys.argv
    assert launch(file, {}) == 0
    out = capsys.readouterr().out
    assert "[arguments-1] argv ['arguments', 'one', '--ros-args']" in out
    assert "[arguments-2] argv ['arguments', 'two', '--ros-args']" in out
    assert sys.argv is argv


def test_a_program_that_raises_fails(workspace: Path, capsys: Any) -> None:
    file = write(
        workspace,
        """
        Node(package="parlance", executable="talker"),
        RegisterEventHandler(OnProcessIO(
            on_stdout=lambda event: Node(
                package="parlance", executable="broken", required=True)
            if event.text.strip() == b"ready" else None)),
        """,
    )
    assert launch(file, {}) == 1
    out, err = capsys.readouterr()
    assert "[broken-2] ValueError: of its own making" in err
    assert "process has died [pid" in err
    assert "[talker-1] interrupted" in out


def test_a_program_that_does_not_end_is_abandoned(workspace: Path, capsys: Any) -> None:
    file = write(
        workspace,
        """
        RegisterEventHandler(
            OnProcessIO(on_stdout=lambda event: Shutdown(), handle_once=True)),
        Node(package="parlance", executable="stuck",
             sigterm_timeout="0.05", sigkill_timeout="0.05"),
        """,
    )
    assert launch(file, {}) == 0
    assert "does not end; sending SIGKILL" in capsys.readouterr().err


def test_components_share_an_executor(workspace: Path, capsys: Any) -> None:
    file = write(
        workspace,
        """
        ComposableNodeContainer(
            name="box", namespace="", package="rclcpp_components",
            executable="component_container",
            composable_node_descriptions=[
                ComposableNode(package="parlance", plugin="parlance.nodes.Talker",
                               name="mouth", remappings=[("chatter", "/talk")],
                               parameters=[{"word": "inside"}]),
                ComposableNode(package="parlance", plugin="parlance.nodes::Listener",
                               namespace="in", remappings=[("chatter", "/talk")]),
            ],
        ),
        """,
    )
    launch(file, {})
    out, err = capsys.readouterr()
    assert "received inside as /in/listener" in out
    assert "loaded parlance.nodes.Talker as /mouth" in err


@pytest.mark.parametrize(
    ("plugin", "options", "reason"),
    [
        ("parlance.nodes::Walker", "", "unknown node class .* known: .*Talker"),
        ("nowhere::Talker", "", "no Python module 'nowhere'"),
        ("parlance.nodes::Talker", ", parameters=[{'wrod': 1}]", "unknown parameter"),
    ],
)
def test_a_component_that_fails_to_load(
    workspace: Path, capsys: Any, plugin: str, options: str, reason: str
) -> None:
    # The container stays, as in ROS 2; the test ends the launch.
    file = write(
        workspace,
        f"""
        OpaqueFunction(function=shut_down_after_an_error),
        ComposableNodeContainer(
            name="box", namespace="", composable_node_descriptions=[
                ComposableNode(package="parlance", plugin="{plugin}"{options})]),
        """,
    )
    assert launch(file, {}) == 1
    err = capsys.readouterr().err
    assert re.search(reason, err)
    assert "Failed to load node" in err


@pytest.mark.parametrize("element", ["<executable cmd='nosuch'/>", "<node exec='x'/>"])
def test_a_missing_program_is_named_with_its_place(
    tmp_path: Path, capsys: Any, element: str
) -> None:
    file = tmp_path / "a.launch.xml"
    file.write_text(f"<launch>\n  {element}\n</launch>", encoding="utf-8")
    assert launch(file, {}) == 1
    assert re.search(
        rf"{file}:2: \w+\('\w+'\): cannot start '", capsys.readouterr().err
    )


def test_an_undeclared_argument(workspace: Path) -> None:
    file = write(workspace, 'DeclareLaunchArgument("speed", default_value="1")')
    with pytest.raises(InvalidValueError, match="'sped'; did you mean 'speed'"):
        launch(file, {"sped": "2"})


def test_an_argument_declared_by_a_function(workspace: Path, capsys: Any) -> None:
    file = write(
        workspace,
        """
        OpaqueFunction(function=lambda context: [
            DeclareLaunchArgument("speed", default_value="1"),
            LogInfo(msg=["speed ", LaunchConfiguration("speed")])]),
        """,
    )
    assert launch(file, {"speed": "2"}) == 0
    assert "speed 2" in capsys.readouterr().out
    assert launch(file, {"sped": "2"}) == 1
    assert "no argument 'sped'; did you mean 'speed'" in capsys.readouterr().err


def test_arguments_are_listed(workspace: Path) -> None:
    file = write(
        workspace,
        """
        DeclareLaunchArgument("a", description="first", choices=["x", "y"]),
        DeclareLaunchArgument("b", default_value=["p", LaunchConfiguration("a")]),
        """,
    )
    assert show_arguments(file) == (
        "Arguments (pass arguments as '<name>:=<value>'):\n\n"
        "    'a':\n        first. Valid choices are: ['x', 'y']\n\n"
        "    'b':\n        no description given\n"
        "        (default: 'p' + LaunchConfiguration('a'))\n"
    )


def test_launch_files_by_package_or_path(workspace: Path) -> None:
    file = write(workspace, "")
    words = ["parlance", "it.launch.py", "a:=b"]
    assert find_launch_file(words) == (file, ["a:=b"])
    assert find_launch_file([str(file), "a:=b"]) == (file, ["a:=b"])
    multisim, _ = find_launch_file(["turtlesim", "multisim.launch.py"])  # built in
    assert "Arguments" in show_arguments(multisim)
    for wrong in (["nowhere.py"], ["parlance", "nothing.py"], ["unknown", "x.py"]):
        with pytest.raises(NavetteError):
            find_launch_file(wrong)


@pytest.mark.parametrize("words", [["a=b"], [":=b"], ["a:=b", "a:=c"]])
def test_malformed_arguments(words: list[str]) -> None:
    with pytest.raises(InvalidValueError, match="launch argument"):
        parse_launch_arguments(words)


@pytest.mark.skipif(os.name != "posix", reason="signals are POSIX's")
@pytest.mark.parametrize("options", [[], ["--processes"]])
def test_an_interrupt_ends_all_processes(workspace: Path, options: list[str]) -> None:
    file = write(
        workspace, 'Node(package="parlance", executable="stuck", required=True)'
    )
    source = str(Path(navette.__file__).parent.parent)
    launched = subprocess.Popen(
        [
            *(sys.executable, "-c", "from navette.cli import main; main()", "launch"),
            *(*options, str(file), "sigterm_timeout:=0.1", "sigkill_timeout:=0.1"),
        ],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": source, "PYTHONUNBUFFERED": "1"},
    )
    assert launched.stdout is not None
    alarm = threading.Timer(60.0, launched.kill)
    alarm.start()
    seen = ""
    while "[stuck-1] stuck" not in seen:
        line = launched.stdout.readline()
        assert line, seen
        seen += line
    launched.send_signal(signal.SIGINT)
    rest, errors = launched.communicate()
    alarm.cancel()
    assert launched.returncode == 130, seen + rest + errors
    assert "SIGINT: shutting down" in errors
