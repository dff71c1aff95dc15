"""Creation of packages: names, contents, and the tests that they contain."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

import navette
from navette.errors import FileFormatError, InvalidNameError
from navette.ros2.workspace import find_package, read_manifest
from navette.ros2.workspace.create import (
    PackageAbout,
    create_bare_package,
    create_package,
)

SOURCE = Path(navette.__file__).parent.parent


def run_tests(folder: Path) -> str:
    """Run pytest in the folder and return the last line of its output."""
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider"],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(SOURCE), "PYTHONDONTWRITEBYTECODE": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout.splitlines()[-1]


def test_contents_of_a_package(tmp_path: Path) -> None:
    (made,) = create_package(
        "my_robot",
        tmp_path,
        node="averager",
        dependencies=["geometry_msgs", "std_msgs", "tf2_ros"],
    )
    files = {str(p.relative_to(made)) for p in made.rglob("*") if p.is_file()}
    assert files == {
        "README.md",
        "config/params.yaml",
        "conftest.py",
        "launch/my_robot.launch.py",
        "my_robot/__init__.py",
        "my_robot/averager_node.py",
        "my_robot/moving_average.py",
        "package.xml",
        "pyproject.toml",
        "resource/my_robot",
        "setup.cfg",
        "setup.py",
        "test/test_averager_node.py",
        "test/test_my_robot_average.py",
    }
    manifest = read_manifest(made / "package.xml")
    assert manifest.build_type == "ament_python"
    assert manifest.dependencies[:4] == (
        "rclpy",
        "std_msgs",
        "geometry_msgs",
        "tf2_ros",
    )
    (executable,) = find_package("my_robot", made).executables()
    assert (executable.name, executable.module) == (
        "averager",
        "my_robot.averager_node",
    )
    parameters = yaml.safe_load((made / "config" / "params.yaml").read_text())
    assert parameters == {"averager": {"ros__parameters": {"window": 10}}}
    assert "$base/lib/my_robot" in (made / "setup.cfg").read_text()
    for path in made.rglob("*.py"):
        compile(path.read_text(), str(path), "exec")


def test_a_bare_python_package_has_the_build_files_of_ros(tmp_path: Path) -> None:
    about = PackageAbout(description="A & B", license="Apache-2.0", email="a@b.c")
    made = create_bare_package(
        "my_package",
        tmp_path,
        "ament_python",
        node="my_node",
        dependencies=["rclpy", "std_msgs"],
        about=about,
    )
    files = {str(p.relative_to(made)) for p in made.rglob("*") if p.is_file()}
    assert files == {
        "package.xml",
        "setup.cfg",
        "setup.py",
        "resource/my_package",
        "my_package/__init__.py",
        "my_package/my_node.py",
    }
    manifest = read_manifest(made / "package.xml")
    assert manifest.build_type == "ament_python"
    assert manifest.dependencies[:2] == ("rclpy", "std_msgs")
    assert "<description>A &amp; B</description>" in (made / "package.xml").read_text()
    assert "description='A & B'," in (made / "setup.py").read_text()
    (executable,) = find_package("my_package", made).executables()
    assert (executable.name, executable.module) == ("my_node", "my_package.my_node")


def test_a_bare_cmake_package(tmp_path: Path) -> None:
    made = create_bare_package("cpp", tmp_path, "ament_cmake", node="my_node")
    assert read_manifest(made / "package.xml").build_type == "ament_cmake"
    assert "add_executable(my_node" in (made / "CMakeLists.txt").read_text()
    assert (made / "src" / "my_node.cpp").is_file()
    bare = create_bare_package("own_interfaces", tmp_path, "ament_cmake")
    names = {path.name for path in bare.rglob("*")}
    assert names == {"package.xml", "CMakeLists.txt"}
    with pytest.raises(InvalidNameError, match="'cmake' is not a build type"):
        create_bare_package("other", tmp_path, "cmake")


@pytest.mark.parametrize(
    ("node", "module", "cls"),
    [
        ("drive", "drive_node", "DriveNode"),
        ("drive_node", "drive_node", "DriveNode"),
        ("pathFollower", "path_follower_node", "PathFollowerNode"),
        (None, "my_robot_node", "MyRobotNode"),
    ],
)
def test_names_of_module_and_class(
    tmp_path: Path, node: str | None, module: str, cls: str
) -> None:
    (made,) = create_package("my_robot", tmp_path, node=node)
    assert f"class {cls}(Node):" in (made / "my_robot" / f"{module}.py").read_text()


@pytest.mark.slow
def test_the_tests_of_a_new_package_pass(tmp_path: Path) -> None:
    robot, messages = create_package("my_robot", tmp_path, messages=True)
    assert messages.name == "my_robot_msgs"
    assert "my_robot_msgs" in read_manifest(robot / "package.xml").dependencies
    assert "my_robot_msgs" in find_package("my_robot_msgs", robot).manifest().name
    create_package("other_robot", tmp_path, node="other", messages=True)
    assert "12 passed" in run_tests(tmp_path)  # in the workspace: no duplicate names


@pytest.mark.slow
def test_a_package_with_messages_only(tmp_path: Path) -> None:
    (made,) = create_package("own_msgs", tmp_path, dependencies=["geometry_msgs"])
    cmake = (made / "CMakeLists.txt").read_text()
    assert "find_package(geometry_msgs REQUIRED)" in cmake
    assert "DEPENDENCIES std_msgs geometry_msgs" in cmake
    assert "rosidl_generate_interfaces(${PROJECT_NAME}" in cmake
    assert find_package("own_msgs", made).has_interfaces
    assert "3 passed" in run_tests(made)


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        ({"name": "MyRobot"}, "'MyRobot' is not a valid package name"),
        ({"name": "my__robot"}, "single underscores"),
        ({"name": "my-robot"}, "not a valid package name"),
        ({"name": "r"}, "not a valid package name"),
        ({"name": "robot", "node": "2d"}, "'2d' is not a valid node name"),
        ({"name": "robot", "dependencies": ["a b"]}, "'a b' is not a valid package"),
        ({"name": "own_msgs", "node": "x"}, "package of messages"),
    ],
)
def test_bad_names(tmp_path: Path, arguments: dict[str, object], reason: str) -> None:
    with pytest.raises(InvalidNameError, match=reason):
        create_package(folder=tmp_path, **arguments)  # type: ignore[arg-type]
    assert list(tmp_path.iterdir()) == []


def test_nothing_is_overwritten(tmp_path: Path) -> None:
    (tmp_path / "robot_msgs").mkdir()
    with pytest.raises(
        FileFormatError, match="robot_msgs: this file or folder exists already"
    ):
        create_package("robot", tmp_path, messages=True)
    assert not (tmp_path / "robot").exists()
    create_package("robot", tmp_path)
    with pytest.raises(FileFormatError, match="robot: this package exists already"):
        create_package("robot", tmp_path)
