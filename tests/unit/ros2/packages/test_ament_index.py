"""ament_index_python over source folders, prefixes and Navette's own packages."""

import sys
from pathlib import Path

import pytest

from navette.ros2.packages import ament_index_python as index
from navette.ros2.packages.ament_index_python.packages import PackageNotFoundError
from navette.ros2.workspace.create import create_package


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A package robot and robot_msgs in src, one prefix with a plugin."""
    create_package("robot", tmp_path / "src", messages=True)
    prefix = tmp_path / "prefix"
    for kind, name, content in (
        ("packages", "built", ""),
        ("plugins", "built", "a\nb"),
        ("plugins", ".hidden", ""),
    ):
        folder = prefix / index.RESOURCE_INDEX_SUBFOLDER / kind
        folder.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(content)
    monkeypatch.delenv("NAVETTE_PATH", raising=False)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(prefix))
    monkeypatch.setattr(sys, "prefix", str(tmp_path / "no_prefix"))
    monkeypatch.chdir(tmp_path / "src" / "robot" / "launch")
    return tmp_path


def test_share_and_prefix(workspace: Path) -> None:
    robot = workspace / "src" / "robot"
    assert index.get_package_share_directory("robot") == str(robot)
    assert index.get_package_share_path("robot") == robot
    assert index.get_package_prefix("robot") == str(robot)
    assert (index.get_package_share_path("robot") / "config/params.yaml").is_file()
    prefixes = index.get_packages_with_prefixes()
    assert prefixes["built"] == str(workspace / "prefix")
    assert {"robot", "robot_msgs", "std_msgs", "navette"} <= set(prefixes)
    assert index.get_search_paths() == [
        str(workspace / "src"),
        str(workspace / "prefix"),
    ]


def test_an_installed_package_without_files_warns(workspace: Path) -> None:
    with pytest.warns(UserWarning, match="Share directory for built"):
        index.get_package_share_directory("built")
    expected = workspace / "prefix" / "share" / "built"
    assert index.get_package_share_path("built", print_warning=False) == expected


def test_unknown_packages(workspace: Path) -> None:
    with pytest.raises(KeyError):
        index.get_package_prefix("nowhere")
    with pytest.raises(PackageNotFoundError, match="'nowhere' not found, searching"):
        index.get_package_share_directory("nowhere")
    with pytest.raises(ValueError, match="not a valid package name"):
        index.get_package_prefix("_/x")


def test_resources(workspace: Path) -> None:
    prefix, src = str(workspace / "prefix"), workspace / "src"
    assert index.get_resource("plugins", "built") == ("a\nb", prefix)
    assert index.get_resources("plugins") == {"built": prefix}
    assert index.has_resource("plugins", "built") == prefix
    assert index.has_resource("plugins", "other") is False
    assert index.get_resource_types() == {"packages", "plugins", "rosidl_interfaces"}
    content, where = index.get_resource("rosidl_interfaces", "robot_msgs")
    assert where == str(src / "robot_msgs")
    assert content.split() == [
        "msg/Average.msg",
        "srv/SetWindow.srv",
        "action/Collect.action",
    ]
    assert index.get_resource("packages", "robot") == ("", str(src / "robot"))
    assert "robot" not in index.get_resources("rosidl_interfaces")
    with pytest.raises(LookupError, match="'x'; known: built"):
        index.get_resource("plugins", "x")
    with pytest.raises(index.InvalidResourceTypeNameError):
        index.get_resources("a/b")
    with pytest.raises(index.InvalidResourceNameError):
        index.has_resource("plugins", "a/b")
