"""Programs: names, arguments, exit codes, several in one process."""

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
    ("line", "code", "printed"),
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
    printed: str,
) -> None:
    assert run(write(line)) == code
    assert capsys.readouterr().err == printed


def test_the_traceback_of_a_syntax_error_has_no_frame_of_navette(
    write: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(write("x = 'two")) == 1
    printed = capsys.readouterr().err
    assert printed.splitlines()[1:2] == ["    x = 'two"]
    assert "unterminated string" in printed
    assert "navette" not in printed


def test_a_traceback_starts_in_the_program(
    write: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write("def fly():\n    raise ValueError('no wings')\nfly()\n")
    assert run(path) == 1
    lines = capsys.readouterr().err.splitlines()
    assert lines[1] == f'  File "{path}", line 3, in <module>'
    assert lines[-1] == "ValueError: no wings"


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("import rospy", "docs/reference/idioms.md"),
        ("import ros2param", "navette param"),
        ("from fleet_msgs.msg import Truck", "NAVETTE_INTERFACE_PATH"),
    ],
)
def test_the_error_of_a_missing_ros_package_gives_advice(
    write: Write, capsys: pytest.CaptureFixture[str], line: str, expected: str
) -> None:
    assert run(write(line)) == 1
    error, advice = capsys.readouterr().err.splitlines()[-2:]
    assert error.startswith("ModuleNotFoundError: No module named ")
    assert expected in advice


@pytest.mark.parametrize(
    ("word", "expected"),
    [
        ("no_such.nodes:Drive", "module 'no_such.nodes' cannot be imported: No module"),
        ("{path}:Fly", "program:Fly is not a node class or a function; "),
    ],
)
def test_a_missing_program_is_an_error_of_one_line(
    write: Write, capsys: pytest.CaptureFixture[str], word: str, expected: str
) -> None:
    path = write("def walk(): pass\n")
    assert run(word.format(path=path)) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"navette: {expected}")


def test_the_error_of_another_missing_module_is_pythons(
    write: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(write("import wings")) == 1
    lines = capsys.readouterr().err.splitlines()
    assert lines[-1] == "ModuleNotFoundError: No module named 'wings'"


def test_a_context_that_the_program_left_open_is_shut_down(write: Write) -> None:
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
        self.create_subscription(String, "chatter", self.receive, 10)

    def receive(self, msg):
        print("received", msg.data)
        raise SystemExit(self.context.arguments.other[1:] and 7)

def stop():
    return 5
"""


def test_a_node_of_a_node_class_is_created_and_spun(
    write: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write(NODES)
    assert run(f"{path}:Talker", "--with", f"{path}:Listener", "loud") == 7
    assert capsys.readouterr().out == "received hello 1\n"


def test_remappings_and_parameters_belong_to_one_program(
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
    assert capsys.readouterr().out == "received hello 1\n"


def test_the_result_of_a_function_is_the_exit_code(write: Write) -> None:
    assert run(f"{write(NODES)}:stop") == 5


def test_the_error_of_another_attribute_lists_the_valid_ones(
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
def check():
    context = rclpy.get_default_context()
    print(sys.argv[1:], context is node.context)
thread = threading.Thread(target=check)
thread.start()
thread.join()
"""
    path = write(text)
    assert run(path, "a", "--with", path, "b") == 0
    lines = sorted(capsys.readouterr().out.splitlines())
    assert lines == ["['a'] True", "['b'] True"]


def test_sys_argv_behaves_as_a_list(
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
ran = []

def sleep():
    time.sleep(0.05)  # as ROS 2 programs do
    print("other" in ran)
    raise SystemExit

node.create_timer(0.01, sleep)
node.create_timer(0.02, lambda: ran.append("other"), ReentrantCallbackGroup())
executor = globals()[sys.argv[1] + "ThreadedExecutor"]()
executor.add_node(node)
executor.spin()
"""


@pytest.mark.parametrize(
    ("executor", "other_ran"),
    [("Multi", "True\n"), ("Single", "False\n")],
)
def test_other_callbacks_run_during_a_sleep_with_a_multi_threaded_executor(
    write: Write, capsys: pytest.CaptureFixture[str], executor: str, other_ran: str
) -> None:
    assert run(write(SLEEPER), executor) == 0
    assert capsys.readouterr().out == other_ran


CALLER = """
import threading
import rclpy
from rclpy.executors import MultiThreadedExecutor
from std_srvs.srv import Trigger

def answer(request, response):
    response.message = "here"
    return response

def call():
    timer.cancel()
    future = client.call_async(Trigger.Request())
    answered = threading.Event()
    future.add_done_callback(lambda _: answered.set())
    print(answered.wait(20.0), future.result().message)
    notified = threading.Event()
    thread = threading.Thread(target=notified.set)
    other.create_guard_condition(thread.start).trigger()
    print(notified.wait(20.0), threading.Event().wait(0.001))
    thread.join()
    raise SystemExit

rclpy.init()
node, other = rclpy.create_node("n"), rclpy.create_node("m")
other.create_service(Trigger, "answer", answer)
client = node.create_client(Trigger, "answer")
timer = node.create_timer(0.01, call)
executor = MultiThreadedExecutor()
executor.add_node(node)
executor.add_node(other)
executor.spin()
"""


def test_a_callback_waits_for_an_event_that_a_response_sets(
    write: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(write(CALLER)) == 0
    assert capsys.readouterr().out == "True here\nTrue False\n"


def test_an_interrupt_waits_for_the_end_of_an_import(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An import lock that is never released would block every later import."""
    (tmp_path / "slow_module.py").write_text(
        "import gates\ngates.entered.set()\ngates.proceed.wait(20)\nvalue = 1\n"
    )
    gates = ModuleType("gates")
    gates.entered, gates.proceed = threading.Event(), threading.Event()  # type: ignore[attr-defined]
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
    gates.proceed.set()
    assert running.join(20)
    assert running.exit_code == 130
    import slow_module

    assert slow_module.value == 1
    del sys.modules["slow_module"]  # delitem would put it back
