"""The command line in real processes with real sockets."""

import json
import os
import signal
import socket
import subprocess
import sys
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

from free_ports import free_port
from navette import __version__
from navette.cli import app

NAVETTE = [sys.executable, "-c", "from navette.cli import main; main()"]
SUMMARY_KEYS = {
    "goals",
    "contacts",
    "min_clearance_m",
    "sim_time_s",
    "wall_time_s",
    "real_time_factor",
    "seed",
    "pose_error_m",
    "true_goal_distance_m",
    "goal_tolerance_m",
}


Typed = Callable[..., tuple[int, str, str]]
Refusal = Callable[..., str]


@pytest.fixture
def typed(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Typed:
    """Run a command in this process; return exit code, output and errors."""

    def run(*arguments: str) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["navette", *arguments])
        monkeypatch.setattr(app, "end_with", lambda code: None)  # the tests continue
        with pytest.raises(SystemExit) as ended:
            app.main()
        printed = capsys.readouterr()
        return int(ended.value.code or 0), printed.out, printed.err

    return run


@pytest.fixture
def refusal(typed: Typed) -> Refusal:
    """Return the error output of a command that is refused."""

    def refuse(*arguments: str) -> str:
        code, _, errors = typed(*arguments)
        assert code == 2
        return errors

    return refuse


def navette(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [*NAVETTE, *arguments], capture_output=True, text=True, check=False, timeout=120
    )


@pytest.mark.slow
def test_version_and_help() -> None:
    assert navette("--version").stdout == f"navette {__version__}\n"
    shown = navette("sim", "--help")
    assert shown.returncode == 0
    for option in ("--robot", "--start", "--goal", "--headless", "--speed", "--seed",
                   "--record", "--params", "--max-time", "--json"):  # fmt: skip
        assert option in shown.stdout


@pytest.mark.slow
def test_a_time_limit_before_the_last_goal_is_a_failure(typed: Typed) -> None:
    code, printed, _ = typed(
        "sim", "course", "--goal", "6", "-12", "--goal", "12", "0", "--max-time", "2",
        "--headless", "--json",
    )  # fmt: skip
    assert code == 1
    goals = json.loads(printed)["goals"]
    assert [goal["result"] for goal in goals] == ["unfinished", "unfinished"]
    assert goals[0]["time_s"] == pytest.approx(1.9, abs=0.2)
    assert all(goal["distance_left_m"] > 10 for goal in goals)


@pytest.mark.slow
def test_a_drive_prints_one_json_object_and_exits_with_zero() -> None:
    done = navette(
        "sim", "course", "--start", "-6", "0", "-90", "--goal", "-6", "-3.5",
        "--goal", "-10", "-2", "--headless", "--json",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert done.stderr.count("reached") == 3  # each goal, and the total
    summary = json.loads(done.stdout)
    assert set(summary) == SUMMARY_KEYS
    assert [goal["goal"] for goal in summary["goals"]] == [[-6.0, -3.5], [-10.0, -2.0]]
    assert [goal["result"] for goal in summary["goals"]] == ["reached", "reached"]
    assert summary["contacts"] == 0
    assert summary["min_clearance_m"] > 0.1


@pytest.mark.slow
def test_a_goal_that_is_not_reached_gives_another_exit_code(typed: Typed) -> None:
    code, printed, _ = typed(
        "sim", "course", "--goal", "1000", "0", "--headless", "--json"
    )
    assert code == 1
    (goal,) = json.loads(printed)["goals"]
    assert goal["result"] == "goal_outside_map"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["sim", "nowhere"], ["nowhere", "arena", "course"]),
        (["sim", "--robot", "r2d2"], ["r2d2", "husky", "jackal"]),
        (["sim", "--goal", "here", "there"], ["here"]),
        (["sim", "--speed", "fast"], ["--speed", "max"]),
        (["sim", "--params", "missing.yaml", "--headless"], ["missing.yaml"]),
        (["sim", "course", "--start", "0", "0", "0", "--headless"], ["inside"]),
        (["sim", "--record", "no/such/folder/x.mcap", "--headless"], ["x.mcap"]),
    ],
)
def test_a_wrong_argument_is_named_with_what_is_allowed(
    arguments: list[str], words: list[str], refusal: Refusal
) -> None:
    errors = refusal(*arguments)
    for word in words:
        assert word in errors


@pytest.mark.slow
def test_a_broken_world_is_named_with_its_line(
    tmp_path: Path, refusal: Refusal
) -> None:
    world = tmp_path / "broken.sdf"
    world.write_text("<sdf version='1.8'>\n  <world name='x'>\n  <model>\n", "utf-8")
    assert "broken.sdf:" in refusal("sim", str(world), "--headless")


@pytest.mark.slow
def test_a_refusal_is_the_only_output() -> None:
    done = navette("sim", "nowhere")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("navette: ")
    assert "Traceback" not in done.stderr


@contextmanager
def running_demo(port: int) -> Iterator[subprocess.Popen[str]]:
    process = subprocess.Popen(
        [*NAVETTE, "demo", "--port", str(port)], stderr=subprocess.PIPE, text=True
    )
    try:
        yield process
    finally:
        process.kill()
        process.wait()
        assert process.stderr is not None
        process.stderr.close()


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="signals are not delivered on Windows")
@pytest.mark.parametrize("end", [signal.SIGINT, signal.SIGTERM])
def test_the_demo_drives_shows_its_address_and_ends_cleanly(end: int) -> None:
    port = free_port()
    with running_demo(port) as process:
        assert process.stderr is not None
        address = f"http://127.0.0.1:{port}"
        lines = iter(process.stderr.readline, "")
        assert any(address in line for line in lines)
        assert any("→ goal" in line for line in lines)
        with urllib.request.urlopen(f"{address}/health", timeout=60) as answer:
            assert json.load(answer)["status"] == "ok"
        process.send_signal(end)
        rest = list(lines)
        assert process.wait(timeout=60) == 0
        assert "Traceback" not in "".join(rest)
        assert any("goals reached" in line for line in rest)
    with socket.create_server(("127.0.0.1", port)):
        pass  # the port is free again


@pytest.mark.slow
def test_a_port_that_is_taken_is_named(refusal: Refusal) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = str(taken.getsockname()[1])
        assert port in refusal("demo", "--port", port, "--max-time", "1")


@pytest.mark.long
@pytest.mark.skipif(os.name == "nt", reason="signals are not delivered on Windows")
def test_ctrl_c_ends_a_benchmark_and_its_workers(tmp_path: Path) -> None:
    """A terminal interrupts the whole group: the command, fork server and workers."""
    results = tmp_path / "results.jsonl"
    process = subprocess.Popen(
        [*NAVETTE, "bench", "barn-like", "--worlds", "0-99", "--jobs", "2",
         "--results", str(results)],
        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
        start_new_session=True,
    )  # fmt: skip
    try:
        while not results.exists() or not results.read_text():
            with suppress(subprocess.TimeoutExpired):
                process.wait(0.1)
            assert process.returncode is None
        os.killpg(process.pid, signal.SIGINT)
        _, errors = process.communicate(timeout=30)
    finally:
        with suppress(ProcessLookupError):  # all have ended, as they should
            os.killpg(process.pid, signal.SIGKILL)
    assert process.returncode == 130
    assert "interrupted; the same command continues" in errors
    assert "Traceback" not in errors
