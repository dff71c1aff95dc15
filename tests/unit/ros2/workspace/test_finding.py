"""Search for packages: workspaces, overlays, prefixes, manifests, executables."""

import sys
from pathlib import Path

import pytest

from navette import msgs
from navette.errors import FileFormatError, InvalidNameError, UnknownNameError
from navette.ros2.workspace import (
    Origin,
    PackageNotFoundError,
    activate,
    find_package,
    find_packages,
    search_roots,
)
from navette.ros2.workspace import finding as finding_module


@pytest.fixture(autouse=True)
def plain_environment(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Remove ROS, NAVETTE_PATH and the prefix of this Python."""
    monkeypatch.delenv("NAVETTE_PATH", raising=False)
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    monkeypatch.setattr(sys, "prefix", str(tmp_path / "no_prefix"))


def make(folder: Path, name: str | None = None, *, more: str = "") -> Path:
    folder.mkdir(parents=True)
    (folder / "package.xml").write_text(
        f"<package format='3'><name>{name or folder.name}</name>"
        f"<version>1.2.3</version>{more}</package>"
    )
    return folder


def sources(start: Path) -> dict[str, Path]:
    return {
        name: package.share
        for name, package in find_packages(start).items()
        if package.origin is Origin.SOURCE
    }


def test_a_workspace_is_found_from_all_its_folders(tmp_path: Path) -> None:
    src = tmp_path / "ws" / "src"
    robot = make(src / "robot")
    arm = make(src / "group" / "repository" / "arm")
    launch = robot / "launch"
    launch.mkdir()
    for start in (tmp_path / "ws", src, robot, launch, arm):
        assert sources(start) == {"arm": arm, "robot": robot}, start
    assert list(find_packages(src)) == sorted(find_packages(src))


def test_packages_beside_each_other_without_src(tmp_path: Path) -> None:
    a, b = make(tmp_path / "a_pkg"), make(tmp_path / "b_pkg")
    assert sources(a) == {"a_pkg": a, "b_pkg": b}
    make(tmp_path / "elsewhere" / "c_pkg")
    assert sources(a / "launch") == {"a_pkg": a, "b_pkg": b}
    assert sources(tmp_path) == {"a_pkg": a, "b_pkg": b}


def test_folders_that_are_not_searched(tmp_path: Path) -> None:
    src = tmp_path / "src"
    kept = make(src / "kept")
    make(kept / "nested")
    for name in ("build", "install", "log", ".git"):
        make(src / name / "copy")
    ignored = make(src / "ignored")
    (ignored / "COLCON_IGNORE").touch()
    make(src / "1" / "2" / "3" / "4" / "too_deep")
    assert sources(tmp_path) == {"kept": kept}


def test_an_overlay_takes_precedence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mine = make(tmp_path / "mine" / "src" / "robot")
    theirs = make(tmp_path / "theirs" / "robot")
    tools = make(tmp_path / "theirs" / "tools")
    monkeypatch.setenv("NAVETTE_PATH", str(tmp_path / "theirs"))
    assert sources(tmp_path / "mine") == {"robot": mine, "tools": tools}
    (tmp_path / "empty").mkdir()
    assert sources(tmp_path / "empty") == {"robot": theirs, "tools": tools}
    assert search_roots(mine) == (mine.parent, tmp_path / "theirs")
    monkeypatch.setenv("NAVETTE_PATH", str(tmp_path / "gone"))
    with pytest.raises(
        FileFormatError, match=r"gone: no such folder, .* in NAVETTE_PATH"
    ):
        find_packages(tmp_path)


def test_a_folder_of_navette_path_is_a_workspace_as_working_directory_too(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    deep = make(tmp_path / "repository" / "group" / "robot")
    assert sources(tmp_path) == {}
    monkeypatch.setenv("NAVETTE_PATH", str(tmp_path))
    assert sources(tmp_path) == {"robot": deep}


def test_two_packages_with_one_name_are_an_error(tmp_path: Path) -> None:
    make(tmp_path / "src" / "a", "robot")
    make(tmp_path / "src" / "b", "robot")
    with pytest.raises(InvalidNameError, match=r"two packages are named 'robot'.*b;"):
        find_packages(tmp_path)


def test_installed_packages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    prefix = tmp_path / "install"
    index = prefix / "share" / "ament_index" / "resource_index" / "packages"
    index.mkdir(parents=True)
    (index / "built").touch()
    programs = prefix / "lib" / "built"
    programs.mkdir(parents=True)
    (programs / "driver").write_text("#!/usr/bin/env python3\n")
    (programs / "driver").chmod(0o755)
    (programs / "notes.txt").touch()
    monkeypatch.setenv("AMENT_PREFIX_PATH", f"{tmp_path / 'gone'}:{prefix}")
    package = find_package("built", tmp_path)
    assert package.origin is Origin.INSTALLED
    assert package.prefix == prefix
    assert package.share == prefix / "share" / "built"
    assert [e.name for e in package.executables()] == ["driver"]
    assert package.executable("driver").path == programs / "driver"


def test_built_in_packages(tmp_path: Path) -> None:
    package = find_package("std_msgs", tmp_path)
    assert package.origin is Origin.BUILT_IN
    assert (package.share / "msg" / "String.msg").is_file()
    assert package.prefix == package.share
    assert (find_package("navette", tmp_path).share / "sim" / "data").is_dir()


def test_unknown_and_invalid_names(tmp_path: Path) -> None:
    with pytest.raises(PackageNotFoundError) as caught:
        find_package("nowhere", tmp_path)
    assert isinstance(caught.value, KeyError)
    assert isinstance(caught.value, UnknownNameError)
    assert str(caught.value).startswith("package 'nowhere' not found, searching: ")
    assert str(tmp_path) in str(caught.value)
    with pytest.raises(InvalidNameError, match="not a valid package name"):
        find_package("_no", tmp_path)


def test_manifest(tmp_path: Path) -> None:
    folder = make(
        tmp_path / "robot",
        more="<description> Two\n  lines </description><depend>rclpy</depend>"
        "<exec_depend>launch</exec_depend><build_depend>rclpy</build_depend>"
        "<test_depend>pytest</test_depend>"
        "<export><build_type>ament_python</build_type></export>",
    )
    manifest = find_package("robot", folder).manifest()
    assert (manifest.version, manifest.build_type) == ("1.2.3", "ament_python")
    assert manifest.description == "Two lines"
    assert manifest.dependencies == ("rclpy", "launch")


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("<package", "not XML"),
        ("<!DOCTYPE x [<!ENTITY a 'b'>]><package><name>ab</name></package>", "XML"),
        ("<robot/>", "<robot>: expected <package>"),
        (
            "<package><name>no name</name></package>",
            "'no name' is not a valid",
        ),
    ],
)
def test_the_error_of_an_invalid_manifest_names_the_file(
    tmp_path: Path, text: str, reason: str
) -> None:
    path = tmp_path / "src" / "robot" / "package.xml"
    path.parent.mkdir(parents=True)
    path.write_text(text)
    with pytest.raises(FileFormatError, match=reason) as caught:
        find_packages(tmp_path)
    assert caught.value.path == path


SETUP_PY = """
from setuptools import setup
package_name = 'robot'
prefix = package_name + '.nodes'
setup(name=package_name, entry_points={
    'console_scripts': [
        'plain = robot.plain:main',
        f'{package_name}_node = {prefix}.node:run',
        'sum = ' + prefix + '.sum:main',
        'computed = ' + str(1) + ':main',
    ],
    'other': ['hidden = robot.hidden:main'],
})
"""


def test_entry_points_are_read_without_running_setup_py(tmp_path: Path) -> None:
    folder = make(tmp_path / "robot")
    (folder / "setup.py").write_text(SETUP_PY)
    (folder / "setup.cfg").write_text(
        "[options.entry_points]\nconsole_scripts =\n    cfg = robot.cfg:main\n"
    )
    (folder / "pyproject.toml").write_text(
        '[project.scripts]\nmodern = "robot.modern:main"\n'
    )
    found = {e.name: (e.module, e.attribute) for e in _robot(folder).executables()}
    assert found == {
        "cfg": ("robot.cfg", "main"),
        "modern": ("robot.modern", "main"),
        "plain": ("robot.plain", "main"),
        "robot_node": ("robot.nodes.node", "run"),
        "sum": ("robot.nodes.sum", "main"),
    }
    assert list(found) == sorted(found)
    with pytest.raises(UnknownNameError, match="executable of robot 'x'; known: cfg"):
        _robot(folder).executable("x")


def test_programs_that_cmake_installs(tmp_path: Path) -> None:
    folder = make(tmp_path / "robot")
    (folder / "scripts").mkdir()
    (folder / "scripts" / "drive.py").touch()
    (folder / "CMakeLists.txt").write_text(
        "# install(PROGRAMS scripts/old.py DESTINATION lib)\n"
        "install(PROGRAMS\n  scripts/drive.py\n  scripts/gone.py\n"
        "  DESTINATION lib/${PROJECT_NAME})\n"
    )
    (executable,) = _robot(folder).executables()
    assert (executable.name, executable.path) == (
        "drive.py",
        folder / "scripts" / "drive.py",
    )


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("setup.py", "setup("),
        ("setup.cfg", "no section"),
        ("pyproject.toml", "= 3"),
    ],
)
def test_the_error_of_an_invalid_build_file_names_the_file(
    tmp_path: Path, name: str, text: str
) -> None:
    folder = make(tmp_path / "robot")
    (folder / name).write_text(text)
    with pytest.raises(FileFormatError, match=name):
        _robot(folder).executables()


def _robot(folder: Path) -> "finding_module.Package":
    return find_package("robot", folder)


def test_activate_makes_modules_and_interfaces_importable(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "path", list(sys.path))
    src = tmp_path / "src"
    first = make(src / "aa_overlay_msgs")  # uses a type of a package that comes later
    second = make(src / "zz_folder", "zz_overlay_msgs")
    for folder, name, text in (
        (first, "Pair", "zz_overlay_msgs/Single left\nzz_overlay_msgs/Single right"),
        (second, "Single", "float64 x"),
    ):
        (folder / "msg").mkdir()
        (folder / "msg" / f"{name}.msg").write_text(text)
    assert activate(tmp_path) == (first, second)
    assert activate(tmp_path) == ()
    assert sys.path[-2:] == [str(first), str(second)]
    pair = msgs.get_interface("aa_overlay_msgs/msg/Pair")()
    assert pair.left.x == 0.0


def test_programs_of_a_package_in_cpp_are_replaced(tmp_path: Path) -> None:
    make(tmp_path / "ws" / "src" / "turtlesim")
    package = find_package("turtlesim", tmp_path / "ws")
    assert package.origin is Origin.SOURCE
    assert "turtlesim_node" in {each.name for each in package.executables()}
    assert package.executable("turtlesim_node").module == "navette.cli.turtlesim"


def test_windows_of_ros_are_the_live_view(tmp_path: Path) -> None:
    for name in ("rviz2", "rqt_graph", "rqt_console"):
        executable = find_package(name, tmp_path).executable(name)
        assert (executable.module, executable.attribute) == (
            "navette.cli.live_view",
            "main",
        )
