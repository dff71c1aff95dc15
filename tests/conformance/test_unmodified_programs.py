"""Unmodified rclpy programs with ``navette run`` in a real process."""

from pathlib import Path

import pytest
from program_run import ProgramRun, run_until_printed

PROGRAMS = Path(__file__).parent / "programs"
TALKER = str(PROGRAMS / "talker.py")
LISTENER = str(PROGRAMS / "listener.py")
LISTENER_NODE = f"{PROGRAMS / 'listener_node.py'}:Listener"
ADDER = str(PROGRAMS / "adder.py")
COUNTING = str(PROGRAMS / "counting.py")
MANAGED = str(PROGRAMS / "managed.py")
SURFACE = str(PROGRAMS / "surface.py")

pytestmark = pytest.mark.slow


def printed(words: list[str], *expected: str, own_end_s: float = 0.3) -> ProgramRun:
    """Run a program; it gets Ctrl-C after ``own_end_s``."""
    run = run_until_printed(words, expected, timeout_s=60.0, own_end_s=own_end_s)
    assert run.is_good, f"{run.faults()}\n{run.output}"
    return run


def test_a_program_alone_ends_on_ctrl_c() -> None:
    run = printed([TALKER], r"\[INFO\] \[\d+\.\d{9}\] \[talker\]: Publishing: .* 3")
    assert run.interrupted
    assert run.exit_code == 0  # it caught KeyboardInterrupt itself


def test_two_programs_communicate_and_end_on_ctrl_c() -> None:
    run = printed([TALKER, "--with", LISTENER_NODE], r"I heard: \[message \d+\]")
    assert run.interrupted
    assert run.exit_code == 0


def test_programs_that_end_without_ctrl_c() -> None:
    run = printed(
        [TALKER, "--ros-args", "-p", "count:=50", "--with", LISTENER, "2"],
        "I heard: message 0",
        "I heard: message 1",
        "Publishing: .message 49",
        own_end_s=60.0,
    )
    assert not run.interrupted


def test_remapping_and_parameters_from_a_file(tmp_path: Path) -> None:
    file = tmp_path / "params.yaml"
    file.write_text("/far/quick:\n  ros__parameters:\n    count: 3\n")
    printed(
        [
            TALKER, "--ros-args", "--params-file", str(file), "-r", "chatter:=/radio",
            "-r", "__ns:=/far", "-r", "__node:=quick", "--log-level", "info",
            "--with", LISTENER, "1", "--ros-args", "-r", "chatter:=/radio",
        ],
        r'\[far\.quick\]: Publishing: "message 0"',
        "I heard: message 0",
    )  # fmt: skip


@pytest.mark.parametrize(
    ("way", "answer"),
    [
        ("future", "future: 3"),
        ("coroutine", "coroutine: 7"),
        ("callback", "blocking: 11"),
        ("thread", "thread: 15"),
    ],
)
def test_services(way: str, answer: str) -> None:
    run = printed([ADDER, "serve", "--with", ADDER, way], r"adding \d and \d", answer)
    assert "the adder ends" in run.output


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (
            ["5", "0"],
            [
                "accepted True",
                r"feedback \[0, 1, 1\]",
                r"feedback \[0, 1, 1, 2, 3, 5\]",
                r"succeeded \[0, 1, 1, 2, 3, 5\]",
            ],
        ),
        (["40", "3"], ["accepted True", r"canceled \[0, 1, 1, 2, 3[ ,\d]*\]"]),
        (["50", "0"], ["accepted False"]),
    ],
)
def test_actions(words: list[str], expected: list[str]) -> None:
    printed([COUNTING, "serve", "--with", COUNTING, *words], *expected)


def test_a_managed_node() -> None:
    run = printed(
        [MANAGED, "talk", "--with", MANAGED, "drive"],
        "True inactive",
        "True active",
        "active True",
        "True inactive",
        "True unconfigured",
    )
    assert "configured, was unconfigured" in run.output


def test_nodes_of_other_files_in_one_executor() -> None:
    run = printed([str(PROGRAMS / "composed.py")], r"I heard: \[message 2\]")
    assert "interrupted, received True" in run.output


def test_events_of_quality_of_service() -> None:
    program = str(PROGRAMS / "events.py")
    run = printed([program], r"\+1, now 1", "-1, now 0", own_end_s=60.0)
    assert not run.interrupted


def test_corner_cases_of_the_api() -> None:
    run = printed(
        [SURFACE],
        r"sequence array\('i', \[0, 1, 1\]\) 1 False",
        r"MultiArrayLayout\(dim=\[\], data_offset=0\), data=\[0, 1, 1\]\)",
        r"filtered \[2, 3\]",
        "caught KeyError 'of the callback'",
        "ran for pooled",
        "asyncio 7",
        "no node without init",
        own_end_s=60.0,
    )
    assert not run.interrupted
    assert "[surface]: before init" in run.output


def test_missing_modules_are_named(tmp_path: Path) -> None:
    program = tmp_path / "program.py"
    program.write_text("from rclpy.qos import QoSWormhole\n")
    run = run_until_printed([str(program)], ["has no rclpy.qos.QoSWormhole"], 60.0)
    assert run.exit_code == 1
    assert not run.missing
