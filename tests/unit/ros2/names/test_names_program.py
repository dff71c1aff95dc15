"""Programs run as Python and ROS 2 run them: name, arguments, exit code."""

import sys
import threading
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest

from navette.ros2.names.process import RunningProgram, run_alone, run_together
from navette.ros2.names.program import Program
from navette.ros2.names.targets import read_programs
from navette.runtime.context import new_graph

Write = Callable[..., Path]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    def write(text: str, name: str = "program.py") -> Path:
        path = tmp_path / name
        path.write_text(text)
        return path

    return write


def run(*words: object) -> int:
    programs = read_programs([str(word) for word in words])
    return run_alone(programs[0]) if len(programs) == 1 else run_together(programs)


def test_a_script_is_main_and_has_its_arguments_and_folder(
    write: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    write("ANSWER = 42\n", "beside_me.py")
    path = write("import sys, beside_me\nprint(__name__, sys.argv, beside_me.ANSWER)")
    before = list(sys.path), sys.argv

    assert run(path, "-a", "b") == 0

    assert capsys.readouterr().out == f"__main__ ['{path}', '-a', 'b'] 42\n"
    assert (sys.path, sys.argv) == before


@pytest.mark.parametrize(
    ("line", "code", "said"),
    [
        ("pass", 0, ""),
        ("raise SystemExit(3)", 3, ""),
        ("raise SystemExit('no robot')", 1, "no robot\n"),
        ("raise KeyboardInterrupt", 130, ""),
    ],
)
def test_exit_codes(
    write: Write,
    capsys: pytest.CaptureFixture[str],
    line: str,
    code: int,
    said: str,
) -> None:
    assert run(write(line)) == code
    assert capsys.readouterr().err == said


def test_a_file_that_cannot_be_compiled_shows_its_own_line_only(
    write: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(write("x = 'two")) == 1
    said = capsys.readouterr().err
    assert said.splitlines()[1:2] == ["    x = 'two"]
    assert "unterminated string" in said
    assert "interop" not in said


def test_a_traceback_starts_in_the_program(
    write: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write("def fly():\n    raise ValueError('no wings')\nfly()\n")
    assert run(path) == 1
    lines = capsys.readouterr().err.splitlines()
    assert lines[1] == f'  File "{path}", line 3, in <module>'
    assert lines[-1] == "ValueError: no wings"


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("import rospy", "docs/reference/idioms.md"),
        ("from rosbag2_py import SequentialReader", "navette.bags"),
        ("import rosbag2_py.reader", "navette.bags"),
        ("from fleet_msgs.msg import Truck", "NAVETTE_INTERFACE_PATH"),
    ],
)
def test_a_module_of_ros_that_is_not_here_says_what_to_do(
    write: Write, capsys: pytest.CaptureFixture[str], line: str, said: str
) -> None:
    assert run(write(line)) == 1
    error, advice = capsys.readouterr().err.splitlines()[-2:]
    assert error.startswith("ModuleNotFoundError: No module named ")
    assert said in advice


@pytest.mark.parametrize(
    ("word", "said"),
    [
        ("no_such.nodes:Drive", "module 'no_such.nodes' cannot be imported: No module"),
        ("{path}:Fly", "program:Fly: wanted a node class or a function; "),
    ],
)
def test_a_program_that_is_not_there_is_told_in_a_line(
    write: Write, capsys: pytest.CaptureFixture[str], word: str, said: str
) -> None:
    path = write("def walk(): pass\n")
    assert run(word.format(path=path)) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"navette: {said}")


def test_other_modules_that_are_not_here_are_pythons_business(
    write: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(write("import wings")) == 1
    lines = capsys.readouterr().err.splitlines()
    assert lines[-1] == "ModuleNotFoundError: No module named 'wings'"


def test_what_the_program_left_open_is_shut_down(write: Write) -> None:
    from navette.runtime import ok

    assert run(write("import rclpy\nrclpy.init()\nassert rclpy.ok()")) == 0
    assert not ok()


NODES = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import String

class Talker(Node):
    def __init__(self):
        super().__init__("talker")
        self.count = self.declare_parameter("count", 3).value
        self.pub = self.create_publisher(String, "chatter", 10)
        self.create_timer(0.01, self.talk)

    def talk(self):
        self.pub.publish(String(data=f"hello {self.pub.get_subscription_count()}"))

class Listener(Node):
    def __init__(self):
        super().__init__("listener")
        self.create_subscription(String, "chatter", self.hear, 10)

    def hear(self, msg):
        print("heard", msg.data)
        raise SystemExit(self.context.arguments.other[1:] and 7)

def stop():
    return 5
"""


def test_a_node_class_is_made_and_spun(
    write: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write(NODES)
    assert run(f"{path}:Talker", "--with", f"{path}:Listener", "loud") == 7
    assert capsys.readouterr().out == "heard hello 1\n"


def test_each_program_has_its_own_remaps_and_parameters(
    write: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write(NODES)
    remap = ["--ros-args", "-r", "chatter:=/radio"]
    assert (
        run(
            f"{path}:Talker", *remap, "-p", "count:=9",
            "--with", f"{path}:Talker", "--ros-args", "-r", "__ns:=/other",
            "--with", f"{path}:Listener", "x", *remap,
        )
        == 7
    )  # fmt: skip
    assert capsys.readouterr().out == "heard hello 1\n"


def test_a_function_is_called_and_its_value_is_the_exit_code(write: Write) -> None:
    assert run(f"{write(NODES)}:stop") == 5


def test_another_attribute_is_refused_and_the_fitting_ones_named(
    write: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(f"{write(NODES)}:Robot") == 1
    assert "the module has Listener, Talker, stop" in capsys.readouterr().err


def test_a_program_that_fails_ends_the_others(
    write: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    spins = write("import rclpy; rclpy.init(); rclpy.spin(rclpy.create_node('n'))")
    fails = write("raise RuntimeError('broken')", "fails.py")
    assert run(spins, "--with", fails) == 1
    assert "RuntimeError: broken" in capsys.readouterr().err


def test_threads_of_a_program_belong_to_it(
    write: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    text = """
import sys, threading, rclpy
rclpy.init()
node = rclpy.create_node(sys.argv[1])
def look():
    context = rclpy.get_default_context()
    print(sys.argv[1:], context is node.context)
thread = threading.Thread(target=look)
thread.start()
thread.join()
"""
    path = write(text)
    assert run(path, "a", "--with", path, "b") == 0
    lines = sorted(capsys.readouterr().out.splitlines())
    assert lines == ["['a'] True", "['b'] True"]


def test_arguments_are_a_list_like_any_other(
    write: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    text = """
import argparse, sys
parser = argparse.ArgumentParser()
parser.add_argument("--speed", type=float)
sys.argv.append("--speed=2")
sys.argv[1] = "--speed=1.5"
assert len(sys.argv) == 3 and sys.argv == [*sys.argv]
del sys.argv[2]
print(parser.parse_args())
"""
    assert run(write(text), "x", "--with", write("", "empty.py")) == 0
    assert capsys.readouterr().out == "Namespace(speed=1.5)\n"


SLEEPER = """
import sys, time
import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor

rclpy.init()
node = rclpy.create_node("sleeper")
said = []

def sleep():
    time.sleep(0.05)  # as ROS 2 programs do
    print("other" in said)
    raise SystemExit

node.create_timer(0.01, sleep)
node.create_timer(0.02, lambda: said.append("other"), ReentrantCallbackGroup())
executor = globals()[sys.argv[1] + "ThreadedExecutor"]()
executor.add_node(node)
executor.spin()
"""


@pytest.mark.parametrize(
    ("executor", "other_ran"),
    [("Multi", "True\n"), ("Single", "False\n")],
)
def test_sleeping_in_a_callback_lets_others_run_where_ros_has_threads(
    write: Write, capsys: pytest.CaptureFixture[str], executor: str, other_ran: str
) -> None:
    assert run(write(SLEEPER), executor) == 0
    assert capsys.readouterr().out == other_ran


ASKER = """
import threading
import rclpy
from rclpy.executors import MultiThreadedExecutor
from std_srvs.srv import Trigger

def answer(request, response):
    response.message = "here"
    return response

def ask():
    timer.cancel()
    future = client.call_async(Trigger.Request())
    answered = threading.Event()
    future.add_done_callback(lambda _: answered.set())
    print(answered.wait(20.0), future.result().message)
    told = threading.Event()
    thread = threading.Thread(target=told.set)
    other.create_guard_condition(thread.start).trigger()
    print(told.wait(20.0), threading.Event().wait(0.001))
    thread.join()
    raise SystemExit

rclpy.init()
node, other = rclpy.create_node("n"), rclpy.create_node("m")
node.create_service(Trigger, "answer", answer)
client = node.create_client(Trigger, "answer")
timer = node.create_timer(0.01, ask)
executor = MultiThreadedExecutor()
executor.add_node(node)
executor.add_node(other)
executor.spin()
"""


def test_an_event_that_an_answer_sets(
    write: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(write(ASKER)) == 0
    assert capsys.readouterr().out == "True here\nTrue False\n"


def test_an_interrupt_waits_for_the_end_of_an_import(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An import lock that is never let go would stop every later import."""
    (tmp_path / "slow_module.py").write_text(
        "import gates\ngates.entered.set()\ngates.go_on.wait(20)\nvalue = 1\n"
    )
    gates = ModuleType("gates")
    gates.entered, gates.go_on = threading.Event(), threading.Event()  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "gates", gates)
    monkeypatch.syspath_prepend(tmp_path)
    seen: list[object] = []

    def main() -> None:
        import slow_module  # type: ignore[import-not-found]

        seen.append(slow_module.value)
        while True:
            threading.Event().wait(0.01)

    running = RunningProgram(Program("p", (), main), new_graph())
    running.start()
    assert gates.entered.wait(20)
    running.interrupt()
    assert not seen
    gates.go_on.set()
    assert running.join(20)
    assert running.exit_code == 130
    import slow_module

    assert slow_module.value == 1
    del sys.modules["slow_module"]  # delitem would put it back
