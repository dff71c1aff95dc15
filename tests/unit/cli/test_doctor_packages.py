"""The doctor's report of the packages of ROS 2 that programs get from elsewhere."""

import sys
from pathlib import Path

import pytest

from navette.cli.doctor.findings import Rating
from navette.cli.doctor.machine import check_packages


def test_all_packages_are_navettes() -> None:
    finding = check_packages()
    assert finding.level is Rating.GOOD
    assert finding.text == "packages that come with rclpy are Navette's"


def test_an_installed_package_is_named_with_its_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "tf_transformations"
    folder.mkdir()
    (folder / "__init__.py").touch()
    monkeypatch.setattr(sys, "path", [*sys.path, str(tmp_path)])
    finding = check_packages()
    assert finding.level is Rating.NOTE
    assert finding.text.endswith(f"Navette's: tf_transformations in {folder}")
    assert finding.data == {"replaced": {"tf_transformations": str(folder)}}
