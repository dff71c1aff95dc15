"""Definitions by distribution of ROS 2, and those of a workspace."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from navette.cli.doctor.distributions import distros_by_hash
from navette.msgs import type_hash
from navette.msgs.registry import DISTROS, distro
from navette.transports.zenoh.keys import wire_hash

GOAL = "nav2_msgs/action/NavigateThroughPoses"


def hash_in(program_environment: dict[str, str], name: str) -> str:
    """Return the hash that a process with these variables computes."""
    program = f"from navette.msgs import type_hash; print(type_hash({name!r}))"
    done = subprocess.run(
        [sys.executable, "-c", program],
        env={**os.environ, **program_environment},
        capture_output=True,
        text=True,
        check=False,
    )
    return done.stdout.strip() or done.stderr.splitlines()[-1]


def test_jazzy_is_the_default(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("NAVETTE_DISTRO", raising=False)
    assert distro() == "jazzy"


def test_types_differ_between_distributions() -> None:
    by_hash = distros_by_hash(GOAL)
    assert sorted(by_hash.values()) == [
        ["humble"],
        ["jazzy"],
        ["kilted"],
        ["lyrical", "rolling"],
    ]
    assert by_hash[type_hash(GOAL)] == ["jazzy"]
    assert [*distros_by_hash("std_msgs/msg/String").values()] == [list(DISTROS)]


def test_unknown_distributions_are_named() -> None:
    error = hash_in({"NAVETTE_DISTRO": "jazy"}, "std_msgs/msg/String")
    assert "unknown NAVETTE_DISTRO 'jazy'; known: humble, jazzy, kilted" in error


@pytest.mark.parametrize("names_package", [True, False])
def test_definitions_of_the_user_precede_navettes(
    tmp_path: Path, names_package: bool
) -> None:
    (tmp_path / "std_msgs" / "msg").mkdir(parents=True)
    (tmp_path / "std_msgs" / "msg" / "String.msg").write_text("string data\nint8 x\n")
    folder = tmp_path / "std_msgs" if names_package else tmp_path
    environment = {"NAVETTE_INTERFACE_PATH": str(folder)}
    changed = hash_in(environment, "std_msgs/msg/String")
    assert changed.startswith("RIHS01_")
    assert changed != type_hash("std_msgs/msg/String")
    # Types that the folder does not have are Navette's.
    assert hash_in(environment, "std_msgs/msg/Bool") == type_hash("std_msgs/msg/Bool")


def test_humble_has_no_hashes_on_the_wire(monkeypatch: pytest.MonkeyPatch) -> None:
    assert wire_hash("std_msgs/msg/String") == type_hash("std_msgs/msg/String")
    monkeypatch.setenv("NAVETTE_DISTRO", "humble")
    assert wire_hash("std_msgs/msg/String") == "TypeHashNotSupported"
