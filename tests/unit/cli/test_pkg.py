"""``navette pkg``."""

from pathlib import Path

import pytest
from click.testing import CliRunner

from navette.cli.app import app
from navette.errors import FileFormatError
from navette.ros2.workspace import PackageNotFoundError


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.delenv("NAVETTE_PATH", raising=False)
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    (tmp_path / "src").mkdir()
    monkeypatch.chdir(tmp_path)
    return tmp_path


def navette(*words: str) -> str:
    done = CliRunner().invoke(app, ["pkg", *words])
    if done.exception is not None and not isinstance(done.exception, SystemExit):
        raise done.exception
    assert done.exit_code == 0, done.output
    return done.output


def test_create_and_find(workspace: Path) -> None:
    printed = navette(
        "create", "my_robot", "--node", "drive", "--dependencies", "tf2_ros", "nav_msgs"
    )
    folder = workspace / "src" / "my_robot"
    assert f"made {folder}" in printed
    assert "my_robot/drive_node.py" in printed
    assert "<depend>nav_msgs</depend>" in (folder / "package.xml").read_text()
    listed = navette("list").splitlines()
    assert {"my_robot", "std_msgs", "navette"} <= set(listed)
    assert f"my_robot\tsource\t{folder}" in navette("list", "--paths").splitlines()
    assert navette("prefix", "my_robot").strip() == str(folder)
    assert navette("prefix", "my_robot", "--share").strip() == str(folder)
    assert navette("executables", "my_robot") == "my_robot drive\n"
    assert "my_robot.drive_node:main" in navette("executables", "--full-path")


def test_create_with_messages_elsewhere(workspace: Path) -> None:
    navette("create", "arm", "--msgs", "--destination-directory", "other")
    assert (workspace / "other" / "arm_msgs" / "msg" / "Average.msg").is_file()


def test_a_folder_that_cannot_be_written_is_named(workspace: Path) -> None:
    (workspace / "file").touch()
    with pytest.raises(FileFormatError, match="cannot be written: Not a dir"):
        navette("create", "arm", "--destination-directory", "file")


def test_unknown_packages(workspace: Path) -> None:
    with pytest.raises(PackageNotFoundError, match="'nowhere' not found"):
        navette("prefix", "nowhere")
