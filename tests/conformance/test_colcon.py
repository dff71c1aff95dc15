"""ROS 2's own tools accept the packages of ``navette pkg create``."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from catkin_pkg.package import parse_package

from navette.cli import main


def create(monkeypatch: pytest.MonkeyPatch, folder: Path, *words: str) -> Path:
    folder.mkdir(exist_ok=True)
    monkeypatch.chdir(folder)
    monkeypatch.setattr(sys, "argv", ["navette", "pkg", "create", *words])
    with pytest.raises(SystemExit) as ended:
        main()
    assert not ended.value.code
    return folder / words[0]


@pytest.mark.slow
def test_colcon_builds_a_created_package(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    create(monkeypatch, tmp_path / "src", "my_robot", "--node", "driver")
    done = subprocess.run(
        [sys.executable, "-m", "colcon", "build"],
        cwd=tmp_path,
        env={**os.environ, "COLCON_HOME": str(tmp_path / "home")},
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    installed = tmp_path / "install" / "my_robot"
    assert (installed / "lib" / "my_robot" / "driver").is_file()
    assert (installed / "share" / "my_robot" / "config" / "params.yaml").is_file()
    assert (installed / "share" / "my_robot" / "launch").is_dir()


def test_ros_reads_the_manifests(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    words = ("my_pkg", "--msgs", "--dependencies", "geometry_msgs")
    folder = create(monkeypatch, tmp_path, *words)
    program = parse_package(str(folder))
    messages = parse_package(str(folder.with_name("my_pkg_msgs")))
    assert (program.name, program.get_build_type()) == ("my_pkg", "ament_python")
    assert (messages.name, messages.get_build_type()) == ("my_pkg_msgs", "ament_cmake")
    needed = {depend.name for depend in program.exec_depends}
    assert {"geometry_msgs", "my_pkg_msgs"} <= needed
    groups = [group.name for group in messages.member_of_groups]
    assert groups == ["rosidl_interface_packages"]
