"""The very first start: what the page and the terminal show while kernels compile."""

import json
import subprocess
import sys
import urllib.request
from pathlib import Path

import pytest

from free_ports import free_port
from navette.cli import preparing
from navette.files import kernels
from navette.navigation.stack.kernel_part import mark_of
from navette.navigation.stack.options import RunOptions


@pytest.fixture
def empty_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(kernels, "_folder", lambda: tmp_path)
    monkeypatch.setattr(kernels, "package_archive", lambda: None)
    return tmp_path


def options(port: int) -> RunOptions:
    return RunOptions(world="arena", port=port)


def get(port: int, path: str) -> bytes:
    with urllib.request.urlopen(f"http://127.0.0.1:{port}{path}", timeout=5) as answer:
        content: bytes = answer.read()
    return content


def test_prepared_kernels_are_noted_for_the_version(empty_cache: Path) -> None:
    assert not kernels.are_prepared("1.0")
    kernels.note_prepared("1.0")
    assert kernels.are_prepared("1.0")
    assert not kernels.are_prepared("1.1")


def test_the_page_and_its_status_are_served_until_the_simulation_takes_the_port(
    empty_cache: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    port = free_port()
    seen: list[dict[str, object]] = []

    def compiled(
        parts: list[str], progress: preparing.Preparation, show: object
    ) -> None:
        (empty_cache / "a.kernel").touch()
        progress.update(parts)
        assert b"preparing" in get(port, "/")
        seen.append(json.loads(get(port, "/status.json")))
        for part in parts:
            kernels.note_prepared(mark_of(part))

    monkeypatch.setattr(preparing, "_compile", compiled)
    lines: list[str] = []
    preparing.prepare(options(port), lines.append, lines.append)
    assert seen[0]["state"] == "preparing"
    assert seen[0]["what"] == "compiling kernels of planner and drive, once"
    assert seen[0]["kernels"] == 1
    assert f"http://127.0.0.1:{port}" in lines[0]
    assert lines[-1].startswith("1 kernels compiled")
    with pytest.raises(OSError):  # noqa: PT011 - the port is free again
        get(port, "/")
    preparing.prepare(options(port), lines.append, lines.append)
    assert len(seen) == 1, "the second start compiles nothing"


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, ...]]:
    """Record the parts that are started, each as a process that ends at once."""
    parts: list[tuple[str, ...]] = []
    real = subprocess.Popen

    def start(arguments: list[str], **kwargs: object) -> subprocess.Popen[bytes]:
        part, *rest = arguments[3:]
        parts.append((part, *rest))
        if not rest:
            kernels.note_prepared(mark_of(part))
        return real([sys.executable, "-c", ""])

    monkeypatch.setattr(subprocess, "Popen", start)
    return parts


def headless(**chosen: str) -> RunOptions:
    return RunOptions(world="arena", headless=True, methods=chosen)


def test_a_start_with_slam_waits_for_its_kernels_and_names_them(
    empty_cache: Path, started: list[tuple[str, ...]]
) -> None:
    announced: list[str] = []
    shown: list[str] = []
    slam = headless(localization="slam+wheels")
    preparing.prepare(slam, announced.append, shown.append)
    assert started == [("planning",), ("driving",), ("locating",)]
    assert "compiling kernels of planner, drive and SLAM, " in announced[0]
    assert shown[0].startswith("compiling kernels of planner, drive and SLAM: 0 done, ")


def test_a_start_by_the_true_pose_leaves_slam_to_the_background(
    empty_cache: Path, started: list[tuple[str, ...]]
) -> None:
    announced: list[str] = []
    preparing.prepare(headless(), announced.append, announced.append)
    assert started == [("locating", "later"), ("planning",), ("driving",)]
    assert "SLAM" not in announced[0]

    # A later start that needs SLAM prepares only what is missing.
    started.clear()
    announced.clear()
    preparing.prepare(headless(localization="slam"), announced.append, announced.append)
    assert started == [("locating",)]
    assert (
        announced[0] == "first start: compiling kernels of SLAM, up to a minute, once"
    )


def test_processes_end_with_the_preparation(
    empty_cache: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    started: list[subprocess.Popen[bytes]] = []
    real = subprocess.Popen

    def start(arguments: list[str], **kwargs: object) -> subprocess.Popen[bytes]:
        text = "import time; time.sleep(60)"
        started.append(real([sys.executable, "-c", text]))
        return started[-1]

    monkeypatch.setattr(subprocess, "Popen", start)

    def interrupted(text: str) -> None:
        raise KeyboardInterrupt

    parts = ["planning", "driving"]
    with pytest.raises(KeyboardInterrupt):
        preparing._compile(parts, preparing.Preparation(parts), interrupted)
    assert len(started) == 3
    assert all(process.poll() is not None for process in started)
