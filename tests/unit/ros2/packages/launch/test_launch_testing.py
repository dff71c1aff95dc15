"""launch_testing and launch_pytest: tests beside the processes of a launch."""

import re
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from xml.etree import ElementTree

import pytest

from navette.ros2.names.hook import install, uninstall
from navette.ros2.packages.launch import LaunchDescription, LaunchService
from navette.ros2.packages.launch.actions import ExecuteProcess
from navette.ros2.packages.launch_testing.asserts import SequentialTextChecker
from navette.ros2.packages.launch_testing.junitxml import unittestResultsToXml
from navette.ros2.packages.launch_testing.launch_test import main
from navette.ros2.packages.launch_testing.legacy import LaunchTestService
from navette.ros2.packages.launch_testing.legacy.output import (
    create_output_lines_test,
    create_output_regex_test,
)
from navette.ros2.packages.launch_testing.loader import LoadTestsFromPythonModule
from navette.ros2.packages.launch_testing.ready_aggregator import ReadyAggregator
from navette.ros2.packages.launch_testing.test_runner import LaunchTestRunner
from navette.ros2.packages.launch_testing.text_matching import make_matcher
from navette.ros2.packages.launch_testing.tools import expect_output

DESCRIPTION = """
import sys, unittest
import launch, launch.substitutions, launch_testing, launch_testing.actions
import launch_testing.asserts
import launch_testing.util
from launch_testing.event_handlers.stdout_ready_listener import StdoutReadyListener

PROGRAM = "import sys; print('ready'); print('done'); print('oh', file=sys.stderr)"

def process(*words):
    command = [sys.executable, '-u', '-c', PROGRAM, *words]
    return launch.actions.ExecuteProcess(cmd=command, name='dut')
"""
TALKER = (
    DESCRIPTION
    + """
@launch_testing.parametrize('word', ['a', 'b'])
def generate_test_description(word):
    dut = process(word, launch.substitutions.LaunchConfiguration('speed'))
    ready = StdoutReadyListener(
        target_action=dut, ready_txt='ready',
        actions=[launch_testing.actions.ReadyToTest()],
    )
    speed = launch.actions.DeclareLaunchArgument('speed', default_value='2')
    return launch.LaunchDescription([
        speed,
        launch.actions.RegisterEventHandler(ready),
        launch_testing.util.KeepAliveProc(), dut,
    ]), {'dut': dut}

class TestBeside(unittest.TestCase):
    @classmethod
    def setUpClass(cls, word):
        cls.word = word

    def test_output(self, proc_output, proc_info, dut, word, test_args):
        assert self.word == word
        assert test_args == {'speed': '1'}
        proc_output.assertWaitFor('done', process=dut, timeout=20, stream='stdout')
        proc_output.assertWaitFor('oh', timeout=20)
        assert not proc_output.waitFor('never', timeout=0.01)
        proc_info.assertWaitForShutdown(process='dut-1', timeout=20)
        assert dut.process_details['cmd'][-2:] == [word, '1']

    def test_a_further_process(self, launch_service, proc_info, proc_output):
        own = process()
        with launch_testing.tools.launch_process(
            launch_service, own, proc_info, proc_output
        ) as proxy:
            assert proxy.wait_for_output(lambda text: 'done' in text, timeout=20)
            assert proxy.wait_for_shutdown(timeout=20)
            assert proxy.exit_code == 0

@launch_testing.post_shutdown_test()
class TestAfter(unittest.TestCase):
    def test_codes_and_order(self, proc_info, proc_output, dut):
        launch_testing.asserts.assertExitCodes(proc_info, process=dut)
        launch_testing.asserts.assertInStdout(proc_output, 'done', dut)
        with launch_testing.asserts.assertSequentialStdout(proc_output, dut) as checker:
            checker.assertInStdout('ready')
            checker.assertInStdout('done')
            with self.assertRaisesRegex(AssertionError, "'ready' not found"):
                checker.assertInStdout('ready')
"""
)


@pytest.fixture(autouse=True)
def _names(monkeypatch: pytest.MonkeyPatch):  # type: ignore[no-untyped-def]
    install()
    yield
    uninstall()


def _module(text: str) -> ModuleType:
    module = ModuleType("launch_test_of_a_process")
    exec(compile(text, "launch_test.py", "exec"), vars(module))
    return module


def test_tests_beside_and_after_each_launch() -> None:
    runs = LoadTestsFromPythonModule(_module(TALKER), name="talker")
    assert list(map(str, runs)) == ["talker[a]", "talker[b]"]
    results = LaunchTestRunner(runs, ["speed:=1"]).run()
    for result in results.values():
        assert result.errors + result.failures == []
        assert result.testsRun == 3


ENDS_EARLY = (
    DESCRIPTION
    + """
def generate_test_description():
    dut = launch.actions.ExecuteProcess(cmd=[sys.executable, '-c', 'exit(3)'])
    return launch.LaunchDescription([dut, launch_testing.actions.ReadyToTest()])

class TestBeside(unittest.TestCase):
    def test_exit(self, proc_info):
        proc_info.assertWaitForShutdown(process='python', timeout=20)

@launch_testing.post_shutdown_test()
class TestAfter(unittest.TestCase):
    def test_codes(self, proc_info):
        launch_testing.asserts.assertExitCodes(proc_info)
"""
)


def test_a_process_that_ends_early_and_its_code_fail() -> None:
    runs = LoadTestsFromPythonModule(_module(ENDS_EARLY))
    (result,) = LaunchTestRunner(runs).run().values()
    text = "\n".join(trace for _, trace in result.failures)
    assert "ended with code 3; allowed: 0" in text


def test_a_description_without_ready_is_refused() -> None:
    text = DESCRIPTION + "generate_test_description = launch.LaunchDescription\n"
    runs = LoadTestsFromPythonModule(_module(text))
    LaunchTestRunner(runs).validate()  # calls nothing
    with pytest.raises(ValueError, match=r"ReadyToTest\(\); this one has 0"):
        LaunchTestRunner(runs).run()


@pytest.mark.parametrize(
    ("decorator", "arguments", "problem"),
    [
        ("", "extra", "unexpected extra argument 'extra'"),
        ("@launch_testing.parametrize('word', ['a'])", "", "Could not find .* 'word'"),
    ],
)
def test_wrong_arguments_of_a_description_are_named(
    decorator: str, arguments: str, problem: str
) -> None:
    text = (
        f"{DESCRIPTION}\n{decorator}\ndef generate_test_description({arguments}): pass"
    )
    runs = LoadTestsFromPythonModule(_module(text))
    with pytest.raises(TypeError, match=problem):
        LaunchTestRunner(runs).validate()


SKIPPED = """
import unittest, launch_testing

@unittest.skip('no robot')
def generate_test_description(): ...

class TestBeside(unittest.TestCase):
    def test_one(self): ...
    def test_two(self): ...
"""


def test_a_skipped_description_skips_its_tests() -> None:
    runs = LoadTestsFromPythonModule(_module(SKIPPED), name="skipped")
    results = LaunchTestRunner(runs).run()
    (result,) = results.values()
    assert result.wasSuccessful()
    assert [reason for _, reason in result.skipped] == ["no robot"] * 2
    suite = unittestResultsToXml(test_results=results).getroot()[0]
    assert suite.attrib["skipped"] == suite.attrib["tests"] == "2"
    assert [case.attrib["name"] for case in suite] == ["test_one", "test_two"]


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "talker_launch_test.py"
    file.write_text(ENDS_EARLY)
    report = tmp_path / "report.xml"
    arguments = ["--package-name", "talker", "--junit-xml", str(report)]
    assert main([str(file), *arguments]) == 1
    assert "talker.talker_launch_test.launch_tests: " in capsys.readouterr().out
    root = ElementTree.parse(report).getroot()
    assert root.attrib["name"] == "talker.talker_launch_test"
    assert int(root.attrib["failures"]) > 0


def test_the_command_lists_arguments(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "args_launch_test.py"
    file.write_text(
        f"""{DESCRIPTION}
def generate_test_description():
    speed = launch.actions.DeclareLaunchArgument(
        'speed', default_value='1', description='of the robot')
    return launch.LaunchDescription([speed, launch_testing.actions.ReadyToTest()])
"""
    )
    assert main([str(file), "--show-args"]) == 0
    shown = capsys.readouterr().out
    assert "'speed':\n        of the robot\n" in shown


def test_python_files_that_import_rclpy_get_the_names_of_ros(tmp_path: Path) -> None:
    talker = tmp_path / "talker.py"
    talker.write_text("import sys\nimport rclpy\nprint(rclpy.__name__, sys.argv[1])\n")
    environment = {"NAVETTE_TRANSPORT": "inprocess"}
    action = ExecuteProcess(
        cmd=[sys.executable, str(talker), "a"],
        additional_env=environment,
        cached_output=True,
    )
    launch = LaunchService()
    launch.include_launch_description(LaunchDescription([action]))
    assert launch.run() == 0
    assert action.get_stdout() == "rclpy a\n"
    assert action.process_details is not None
    assert action.process_details["name"].startswith("python")


@pytest.mark.parametrize(("code", "expected"), [(0, 0), (3, 3)])
def test_a_process_decides_as_a_legacy_test(code: int, expected: int) -> None:
    program = f"print('ready'); print('10 done'); raise SystemExit({code})"
    action = ExecuteProcess(cmd=[sys.executable, "-u", "-c", program])
    description, service = LaunchDescription(), LaunchTestService()
    service.add_test_action(description, action)
    lines = create_output_lines_test([b"ready", b"done"])
    service.add_output_test(description, action, lines)
    pattern = create_output_regex_test([re.compile(rb"\d+ done")])
    service.add_output_test(description, action, pattern, test_suffix="pattern")
    launch = LaunchService()
    launch.include_launch_description(description)
    assert service.run(launch) == expected


def test_missing_output_fails_a_legacy_test() -> None:
    action = ExecuteProcess(cmd=[sys.executable, "-u", "-c", "print('ready')"])
    description, service = LaunchDescription(), LaunchTestService()
    service.add_fixture_action(description, action)
    service.add_output_test(description, action, create_output_lines_test([b"done"]))
    launch = LaunchService()
    launch.include_launch_description(description)
    assert service.run(launch) == 1


PYTEST = """
import sys
import launch, launch_pytest, pytest
from launch_pytest import tools

PROGRAM = "print('hello'); input()"

@pytest.fixture
def dut():
    command = [sys.executable, '-u', '-c', PROGRAM]
    return launch.actions.ExecuteProcess(cmd=command, cached_output=True)

@launch_pytest.fixture
def description(dut):
    return launch.LaunchDescription([dut, launch_pytest.actions.ReadyToTest()])

@pytest.mark.launch(fixture=description)
async def test_output(dut, launch_context):
    assert await tools.wait_for_start(launch_context, dut, timeout=20)
    def check(text):
        assert text.splitlines() == ['hello']
    await tools.assert_output(launch_context, dut, check, timeout=20)
    assert not tools.wait_for_output_sync(launch_context, dut, lambda t: False, 0.01)

@pytest.mark.launch(fixture=description)
def test_exit(dut, launch_service):
    yield
    assert dut.return_code not in (None, 0)

@pytest.mark.launch(fixture=description)
def test_yields_twice():
    yield
    yield

@pytest.mark.launch(fixture=description, shutdown=True)
def test_yields_after_the_shutdown():
    yield

@launch_pytest.fixture
def wrong():
    return object()

@pytest.mark.launch(fixture=wrong)
def test_not_a_description():
    pass
"""


def test_launch_pytest_and_launch_test_files(tmp_path: Path) -> None:
    (tmp_path / "test_dut.py").write_text(PYTEST)
    (tmp_path / "test_talker_launch.py").write_text(TALKER)
    plugin = ["-p", "navette.ros2.names.pytest_plugin", "-p", "no:cacheprovider"]
    arguments = ["-q", "--launch-args", "speed:=1", "-c", "/dev/null"]
    done = subprocess.run(
        [sys.executable, "-m", "pytest", *plugin, str(tmp_path), *arguments],
        capture_output=True,
        text=True,
        check=False,
        cwd=tmp_path,
    )
    assert "2 failed, 4 passed, 1 error" in done.stdout, done.stdout + done.stderr
    assert "must stop iteration after yielding once" in done.stdout
    assert "must be either a launch description" in done.stdout


def test_expected_output() -> None:
    assert make_matcher(["a", "c"])("a b c")
    assert not make_matcher(["c", "a"])("a b c")
    assert expect_output(expected_lines=["a", "b"], text="a\nb\n", strict=True)
    assert not expect_output(expected_lines=["b"], text="a\nb\n", strict=True)
    with pytest.raises(ValueError, match="expected text"):
        make_matcher(3)
    checker = SequentialTextChecker("one two")
    assert checker.assertInText("two")


def test_a_function_is_called_after_all_parts_are_ready() -> None:
    calls: list[int] = []
    ready = ReadyAggregator(lambda: calls.append(1), 2)
    ready.ready_fn()
    assert calls == []
    ready.ready_fn()
    ready.ready_fn()
    assert calls == [1]
