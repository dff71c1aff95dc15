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

    def compiled(progress: preparing.Preparation, show: object) -> bool:
        (empty_cache / "a.kernel").touch()
        progress.count()
        assert b"preparing" in get(port, "/")
        seen.append(json.loads(get(port, "/status.json")))
        return True

    monkeypatch.setattr(preparing, "_compile", compiled)
    lines: list[str] = []
    preparing.prepare(options(port), lines.append, lines.append)
    assert seen[0]["state"] == "preparing"
    assert seen[0]["kernels"] == 1
    assert f"http://127.0.0.1:{port}" in lines[0]
    assert lines[-1].startswith("1 kernels compiled")
    with pytest.raises(OSError):  # noqa: PT011 - the port is free again
        get(port, "/")
    preparing.prepare(options(port), lines.append, lines.append)
    assert len(seen) == 1, "the second start compiles nothing"


def test_processes_end_with_the_preparation(monkeypatch: pytest.MonkeyPatch) -> None:
    started: list[subprocess.Popen[bytes]] = []
    real = subprocess.Popen

    def start(arguments: list[str], **kwargs: object) -> subprocess.Popen[bytes]:
        text = "import time; time.sleep(60)"
        started.append(real([sys.executable, "-c", text]))
        return started[-1]

    monkeypatch.setattr(subprocess, "Popen", start)

    def interrupted(text: str) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        preparing._compile(preparing.Preparation(), interrupted)
    assert len(started) == 3
    assert all(process.poll() is not None for process in started)
