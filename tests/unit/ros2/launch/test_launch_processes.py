"""``navette launch`` with processes: how they end."""

import os
import select
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

import navette

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(os.name != "posix", reason="signals are POSIX's"),
]
WAIT_S = 60.0
HOLD = "import os, signal; os.open('{pipe}', os.O_WRONLY); signal.pause()"
# A node that starts a process of its own, which leaves the node's group; both hold the
# pipe open as long as they live.
NODE = """
import os, signal, subprocess, sys
import rclpy

held = os.open(sys.argv[1], os.O_WRONLY)
code = ("import os, signal; signal.signal(signal.SIGINT, signal.SIG_DFL);"
        f"os.open('{sys.argv[1]}', os.O_WRONLY); print('ready', flush=True);"
        "signal.pause()")
child = subprocess.Popen([sys.executable, "-c", code], start_new_session=True,
                         stdout=subprocess.PIPE, text=True)
child.stdout.readline()
rclpy.init()
node = rclpy.create_node("parent")
print("both are up", flush=True)
try:
    rclpy.spin(node)
except KeyboardInterrupt:
    pass
"""
LAUNCH = """
from launch import LaunchDescription
from launch.actions import *
from launch.event_handlers import *
from launch.events import matches_action
from launch_ros.actions import LifecycleNode, Node
from launch_ros.event_handlers import OnStateTransition
from launch_ros.events.lifecycle import ChangeState
from launch_ros.events.matchers import matches_node_name
from lifecycle_msgs.msg import Transition


def generate_launch_description():
    return LaunchDescription([
        {body}
    ])
"""


class Pipe:
    """A named pipe whose end shows that no process holds it open."""

    def __init__(self, folder: Path) -> None:
        self.path = folder / "pipe"
        os.mkfifo(self.path)
        self._file = os.open(self.path, os.O_RDONLY | os.O_NONBLOCK)

    def wait_end(self) -> None:
        poll = select.poll()
        poll.register(self._file, 0)
        assert poll.poll(WAIT_S * 1000), "it is still held, or never was"
        os.close(self._file)


@contextmanager
def launched(
    folder: Path, body: str, *options: str
) -> Iterator["subprocess.Popen[str]"]:
    """Run ``navette launch`` in a process; its errors are part of its output."""
    file = folder / "it.launch.py"
    file.write_text(LAUNCH.format(body=body))
    source = str(Path(navette.__file__).parent.parent)
    process = subprocess.Popen(
        [sys.executable, "-u", "-m", "navette", "launch", *options, str(file)],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        env={
            **os.environ,
            "PYTHONPATH": source,
            "NAVETTE_TRANSPORT": "inprocess",
            "ROS_LOG_DIR": str(folder / "log"),
        },
    )
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


def read_until(process: "subprocess.Popen[str]", words: str) -> str:
    """Return the output up to these words; bounded."""
    assert process.stdout is not None
    pipe, seen = process.stdout.fileno(), ""
    while words not in seen:
        ready, _, _ = select.select([pipe], [], [], WAIT_S)
        data = os.read(pipe, 65536) if ready else b""
        assert data, seen
        seen += data.decode()
    return seen


@pytest.mark.parametrize("options", [[], ["--processes"]], ids=["one", "each"])
@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGINT, signal.SIGTERM])
@pytest.mark.skipif(
    not Path("/proc/self").is_dir(), reason="what left its group is found in /proc"
)
def test_no_process_outlives_the_launch(
    tmp_path: Path, options: list[str], how: signal.Signals
) -> None:
    (tmp_path / "node.py").write_text(NODE)
    pipe = Pipe(tmp_path)
    body = f'Node(executable="{tmp_path}/node.py", arguments=["{pipe.path}"])'
    with launched(tmp_path, body, *options) as launch:
        read_until(launch, "both are up")
        launch.send_signal(how)
        pipe.wait_end()
        expected = -9 if how == signal.SIGKILL else 130
        assert launch.wait(WAIT_S) == expected


def test_the_exit_of_a_required_node_ends_the_launch(tmp_path: Path) -> None:
    (tmp_path / "short.py").write_text(
        "import rclpy\nrclpy.init()\nprint('gone')\nraise SystemExit(3)\n"
    )
    pipe = Pipe(tmp_path)
    hold = HOLD.format(pipe=pipe.path)
    body = f"""
        ExecuteProcess(cmd=["{sys.executable}", "-c", "{hold}"], name="rest"),
        Node(executable="{tmp_path}/short.py", on_exit=Shutdown(reason="it is over")),
    """
    with launched(tmp_path, body, "--processes") as launch:
        output = read_until(launch, "[rest-1]: process has ended")
        assert launch.wait(WAIT_S) == 1
    pipe.wait_end()
    assert "[short-2] gone" in output
    assert "process has died [pid" in output
    assert "exit code 3" in output


MANAGED = """
import rclpy
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn


class Managed(LifecycleNode):
    def on_configure(self, state):
        print("configures")
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state):
        print("activates")
        return super().on_activate(state)


rclpy.init()
node = Managed("managed")
try:
    rclpy.spin(node)
except KeyboardInterrupt:
    pass
"""


def test_lifecycle_events_cause_transitions(tmp_path: Path) -> None:
    (tmp_path / "managed.py").write_text(MANAGED)
    body = f"""
        *(lambda node: [
            RegisterEventHandler(OnStateTransition(
                target_lifecycle_node=node, start_state="configuring",
                goal_state="inactive", entities=[
                    LogInfo(msg="it is inactive"),
                    EmitEvent(event=ChangeState(
                        lifecycle_node_matcher=matches_node_name("/r1/managed"),
                        transition_id=Transition.TRANSITION_ACTIVATE)),
                ])),
            RegisterEventHandler(OnStateTransition(
                goal_state="active", entities=[Shutdown(reason="it is active")])),
            node,
            EmitEvent(event=ChangeState(
                lifecycle_node_matcher=matches_action(node),
                transition_id=Transition.TRANSITION_CONFIGURE)),
        ])(LifecycleNode(executable="{tmp_path}/managed.py", name="managed",
                         namespace="r1")),
    """
    with launched(tmp_path, body) as launch:
        output = read_until(launch, "process has finished cleanly")
        assert launch.wait(WAIT_S) == 0
    order = ["configures", "it is inactive", "activates"]
    assert sorted(order, key=output.index) == order


def test_autostart_activates_a_lifecycle_node(tmp_path: Path) -> None:
    (tmp_path / "managed.py").write_text(MANAGED)
    body = f"""
        LifecycleNode(executable="{tmp_path}/managed.py", name="managed",
                      namespace="", autostart=True),
    """
    with launched(tmp_path, body) as launch:
        read_until(launch, "[managed-1] activates")
        launch.send_signal(signal.SIGINT)
        assert launch.wait(WAIT_S) == 130
