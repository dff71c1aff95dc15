"""Share directories of packages that install files under other paths."""

import os
from pathlib import Path

import pytest

from navette.errors import FileFormatError
from navette.ros2.packages import ament_index_python
from navette.ros2.workspace import find_package
from navette.ros2.workspace.share import share_directory

SETUP = """
import os
from glob import glob
from setuptools import setup
package_name = 'robot'
setup(
    name=package_name,
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml', 'robot/parameters/params.yaml']),
        (os.path.join('share', package_name, 'launch'), glob('launch/*.py')),
        (f'share/{package_name}/config', glob(os.path.join('setups', '*.yaml')) + []),
        ('lib/' + package_name, ['scripts/run']),
        (computed(), ['x']),
        ('share/' + package_name + '/maps/big', ['worlds/map.pgm', 'worlds/none.pgm']),
    ],
)
"""


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    folder = tmp_path / "src" / "robot_sources"
    files = {
        "package.xml": "<package format='3'><name>robot</name>"
        "<version>1.0.0</version></package>",
        "setup.py": SETUP,
        "robot/parameters/params.yaml": "a: 1",
        "launch/one.launch.py": "",
        "config/own.yaml": "own",
        "setups/moved.yaml": "moved",
        "worlds/map.pgm": "P5",
        "scripts/run": "",
    }
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return folder


def listed(folder: Path) -> set[str]:
    found = set()
    for root, _, names in os.walk(folder, followlinks=True):
        found |= {str((Path(root) / name).relative_to(folder)) for name in names}
    return found


def test_files_have_the_paths_of_an_installation(
    package: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(package)
    share = Path(ament_index_python.get_package_share_directory("robot"))
    assert (share / "params.yaml").read_text() == "a: 1"
    assert (share / "config" / "moved.yaml").read_text() == "moved"
    assert (share / "config" / "own.yaml").read_text() == "own"
    assert (share / "maps" / "big" / "map.pgm").read_text() == "P5"
    # All files of the source folder exist too.
    assert listed(package) <= listed(share)
    (package / "robot" / "parameters" / "params.yaml").write_text("a: 2")
    assert (share / "params.yaml").read_text() == "a: 2"
    assert find_package("robot").prefix == find_package("robot").folder == package
    assert not (package / "params.yaml").exists()


def test_the_folder_of_links_is_created_again_when_the_package_changes(
    package: Path,
) -> None:
    share = share_directory("robot", package)
    assert share_directory("robot", package) == share
    (package / "more").mkdir()
    assert share_directory("robot", package) != share
    assert len(list(share.parent.parent.iterdir())) == 2


def test_files_are_copied_where_links_are_not_allowed(
    package: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise OSError("links are not allowed")

    monkeypatch.setattr(Path, "symlink_to", refuse)
    share = share_directory("robot", package)
    assert (share / "config" / "moved.yaml").read_text() == "moved"
    assert listed(package) <= listed(share)


def test_the_source_folder_is_the_share_directory_if_no_file_moves(
    package: Path,
) -> None:
    (package / "setup.py").write_text(
        "from setuptools import setup\nsetup(data_files=[('share/robot', "
        "['package.xml']), ('share/robot/launch', ['launch/one.launch.py'])])"
    )
    assert share_directory("robot", package) == package
    (package / "setup.py").unlink()
    assert share_directory("robot", package) == package


def test_the_error_of_an_invalid_setup_py_names_the_line(package: Path) -> None:
    (package / "setup.py").write_text("setup(\n")
    with pytest.raises(FileFormatError, match=r"setup\.py:1"):
        share_directory("robot", package)
