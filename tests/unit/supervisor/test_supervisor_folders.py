"""Folders of the supervisor: state, log and socket, also without write access."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from mounts import needs_mounts, read_only, small
from navette.supervisor import project
from navette.supervisor.project import SupervisorError, socket_path, state_root

pytestmark = [
    pytest.mark.skipif(os.name != "posix", reason="supervisors are for POSIX"),
    pytest.mark.long,
]

SERVICES = """
services:
  greeter:
    nodes:
      - command: "echo hello; exec sleep 600"
        shell: true
"""
# One shell, so that the namespace lasts as long as the supervisor.
SESSION = "$0 -m navette up && $0 -m navette logs && $0 -m navette down"


@pytest.fixture
def folders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[Path, Path]:
    """A home and a folder for temporary files, in a project."""
    home, temporary = tmp_path / "home", tmp_path / "t"
    for each in (home, temporary):
        each.mkdir()
    for name in ("NAVETTE_STATE_DIR", "XDG_STATE_HOME", "XDG_RUNTIME_DIR"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("HOME", str(home))
    monkeypatch.setenv("TMPDIR", str(temporary))
    monkeypatch.setattr("tempfile.tempdir", None)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "navette.yaml").write_text(SERVICES)
    return home, temporary


@needs_mounts
@pytest.mark.slow
def test_services_start_with_a_read_only_home(folders: tuple[Path, Path]) -> None:
    home, temporary = folders
    command = read_only([home], ["sh", "-c", SESSION, sys.executable])
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "hello" in done.stdout
    assert (temporary / f"navette-{os.getuid()}" / "state").is_dir()
    assert not any(home.iterdir())


@needs_mounts
@pytest.mark.slow
def test_without_a_writable_folder_one_line_names_the_variables(
    folders: tuple[Path, Path],
) -> None:
    existing = [f for f in (Path("/tmp"), Path("/var/tmp")) if f.is_dir()]
    start = [sys.executable, "-m", "navette", "up"]
    done = subprocess.run(
        read_only([*folders, *existing, Path.cwd()], start),
        capture_output=True,
        text=True,
    )
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1
    assert "set NAVETTE_STATE_DIR and XDG_RUNTIME_DIR" in done.stderr


LOUD = """
services:
  loud:
    nodes:
      - command: "yes lines of output | head -n 20000; exec sleep 600"
        shell: true
"""
FILLING = """
set -e
$0 -m navette up
while ! $0 -m navette ps 2>&1 | tee seen | grep incomplete; do :; done
grep -c running seen
$0 -m navette logs -n 1
$0 -m navette down
"""
FULL_FROM_THE_START = """
dd if=/dev/zero of=state/rest bs=1k 2> /dev/null || true
set -e
$0 -m navette up
while ! $0 -m navette ps 2>&1 | grep incomplete; do :; done
$0 -m navette down
"""


@needs_mounts
@pytest.mark.slow
def test_services_continue_on_a_full_disk(
    folders: tuple[Path, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NAVETTE_STATE_DIR", str(tmp_path / "state"))
    (tmp_path / "state").mkdir()
    (tmp_path / "navette.yaml").write_text(LOUD)
    script = ["sh", "-c", FILLING, sys.executable]
    done = subprocess.run(
        small(tmp_path / "state", "200k", script), capture_output=True, text=True
    )
    assert "the log in" in done.stdout
    assert "is incomplete: No space left on device" in done.stdout
    assert "\n1\n" in done.stdout
    assert "lines of output" in done.stdout
    assert done.returncode == 0, done.stdout + done.stderr
    script = ["sh", "-c", FULL_FROM_THE_START, sys.executable]
    done = subprocess.run(
        small(tmp_path / "state", "200k", script), capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "is incomplete: No space left on device" in done.stdout


def test_folders_of_other_users_are_refused(folders: tuple[Path, Path]) -> None:
    _, temporary = folders
    (temporary / f"navette-{os.getuid()}").mkdir()
    (temporary / f"navette-{os.getuid()}").chmod(0o777)
    with pytest.raises(SupervisorError, match="other users can write"):
        socket_path(Path("state"))


def test_the_runtime_folder_comes_first(
    folders: tuple[Path, Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    runtime = folders[0] / "run"
    runtime.mkdir()
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(runtime))
    monkeypatch.setattr(project, "_MAX_SOCKET_PATH", 1000)
    assert socket_path(Path("state")).is_relative_to(runtime)
    monkeypatch.setattr(project, "_MAX_SOCKET_PATH", 40)
    assert socket_path(Path("state")).is_relative_to("/tmp")


def test_the_state_is_in_the_home(folders: tuple[Path, Path]) -> None:
    assert state_root() == folders[0] / ".local" / "state" / "navette"
    assert not any(folders[0].iterdir())
