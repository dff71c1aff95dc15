"""navette interface: definitions as ros2 prints them, lists, prototypes."""

import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from topic_world import navette, shared_graph

READING = """\
# Output of the sensor.

std_msgs/Header header   # stamped
string UNIT="C # not F"  # always
Extra[<=2] extras
"""
EXTRA = """\
# Beside it.
int32 number 5 # five
"""
ASK = """\
# ask
Extra what
---
bool ok # answer
"""


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Current folder with a package of messages that is not installed."""
    package = tmp_path / "verbs_msgs"
    (package / "msg").mkdir(parents=True)
    (package / "srv").mkdir()
    (package / "msg" / "Reading.msg").write_text(READING)
    (package / "msg" / "Extra.msg").write_text(EXTRA)
    (package / "srv" / "Ask.srv").write_text(ASK)
    (package / "package.xml").write_text(
        '<?xml version="1.0"?><package format="3"><name>verbs_msgs</name>'
        "<version>0.1.0</version><description>d</description>"
        '<maintainer email="a@b.c">a</maintainer><license>MIT</license></package>'
    )
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture(autouse=True)
def alone() -> Iterator[None]:
    with shared_graph():
        yield


def test_show_with_comments_and_nested_types(workspace: Path) -> None:
    assert navette("interface", "show", "verbs_msgs/msg/Reading").stdout == (
        "# Output of the sensor.\n"
        "\n"
        "std_msgs/Header header   # stamped\n"
        "\tbuiltin_interfaces/Time stamp\n"
        "\t\tint32 sec\n"
        "\t\tuint32 nanosec\n"
        "\tstring frame_id\n"
        'string UNIT="C # not F"  # always\n'
        "Extra[<=2] extras\n"
        "\tint32 number 5\n"
    )


def test_show_the_definition_that_precedes_navettes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "std_msgs" / "msg").mkdir(parents=True)
    (tmp_path / "std_msgs" / "msg" / "String.msg").write_text(
        "string data\nint8 tone\n"
    )
    monkeypatch.setenv("NAVETTE_INTERFACE_PATH", str(tmp_path / "std_msgs"))
    assert navette("interface", "show", "std_msgs/String").stdout == (
        "string data\nint8 tone\n"
    )


def test_show_without_comments(workspace: Path) -> None:
    shown = navette("interface", "show", "verbs_msgs/Ask", "--no-comments").stdout
    assert shown == "Extra what\n\tint32 number 5\n---\nbool ok\n"


def test_show_with_all_comments(workspace: Path) -> None:
    shown = navette("interface", "show", "verbs_msgs/srv/Ask", "--all-comments").stdout
    assert shown == (
        "# ask\nExtra what\n\t# Beside it.\n\tint32 number 5 # five\n"
        "---\nbool ok # answer\n"
    )


def test_show_for_a_person_is_indented_by_four(
    workspace: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("navette.cli.interface.definitions.is_terminal", lambda: True)
    shown = navette("interface", "show", "geometry_msgs/PointStamped").stdout
    assert shown.splitlines()[:3] == [
        "std_msgs/Header header",
        "    builtin_interfaces/Time stamp",
        "        int32 sec",
    ]


def test_show_an_action() -> None:
    shown = navette("interface", "show", "example_interfaces/action/Fibonacci").stdout
    assert shown.count("---\n") == 2


def test_the_type_from_standard_input() -> None:
    from click.testing import CliRunner

    from navette.cli.app import app

    shown = CliRunner().invoke(
        app, ["interface", "show", "-"], input="geometry_msgs/msg/Point\n"
    )
    assert shown.stdout == "float64 x\nfloat64 y\nfloat64 z\n"


@pytest.mark.parametrize("verb", ["show", "proto"])
def test_an_unknown_type_fails(verb: str) -> None:
    shown = navette("interface", verb, "std_msgs/msg/Strin")
    assert shown.exit_code == 1
    assert shown.stdout == ""
    assert "std_msgs/msg/Strin" in shown.stderr


def test_an_unknown_type_suggests_similar_names() -> None:
    shown = navette("interface", "show", "std_msgs/msg/Strin")
    assert "did you mean std_msgs/msg/String" in shown.stderr
    for name in ("Twist", "Twst", "geometry_msg/msg/Twist", "geometry_msgs/Twst"):
        shown = navette("interface", "show", name)
        assert shown.exit_code == 1
        assert "did you mean geometry_msgs/msg/Twist?" in shown.stderr


def test_list_by_kind(workspace: Path) -> None:
    lines = navette("interface", "list", "-s").stdout.splitlines()
    assert lines[0] == "Services:"
    assert "    std_srvs/srv/SetBool" in lines
    assert "    verbs_msgs/srv/Ask" in lines
    assert not [line for line in lines if "/msg/" in line]


def test_list_all_is_in_three_parts() -> None:
    lines = navette("interface", "list").stdout.splitlines()
    heads = [line for line in lines if not line.startswith(" ")]
    assert heads == ["Messages:", "Services:", "Actions:"]


def test_list_as_json() -> None:
    found = json.loads(navette("interface", "list", "--json", "-m", "-a").stdout)
    assert set(found) == {"msg", "action"}
    assert "sensor_msgs/msg/LaserScan" in found["msg"]


def test_package(workspace: Path) -> None:
    assert navette("interface", "package", "verbs_msgs").stdout == (
        "verbs_msgs/msg/Extra\nverbs_msgs/msg/Reading\nverbs_msgs/srv/Ask\n"
    )
    assert navette("interface", "package", "verbs_msgs", "-s").stdout == (
        "verbs_msgs/srv/Ask\n"
    )


def test_an_unknown_package_fails() -> None:
    shown = navette("interface", "package", "sensor_msg")
    assert shown.exit_code == 1
    assert "no package sensor_msg; did you mean sensor_msgs" in shown.stderr


def test_packages(workspace: Path) -> None:
    every = navette("interface", "packages").stdout.splitlines()
    assert {"std_msgs", "std_srvs", "verbs_msgs"} <= set(every)
    assert every == sorted(every)
    with_actions = navette("interface", "packages", "-a").stdout.splitlines()
    assert "nav2_msgs" in with_actions
    assert "std_msgs" not in with_actions


@pytest.mark.parametrize(
    ("name", "yaml"),
    [
        ("geometry_msgs/Point", "x: 0.0\ny: 0.0\nz: 0.0\n"),
        ("std_srvs/srv/SetBool", "data: false\n"),
        ("example_interfaces/action/Fibonacci", "order: 0\n"),
    ],
)
def test_prototypes(name: str, yaml: str) -> None:
    assert navette("interface", "proto", name).stdout == f'"{yaml}"\n'
    assert navette("interface", "proto", name, "--no-quotes").stdout == f"{yaml}\n"


def test_a_prototype_of_the_workspace(workspace: Path) -> None:
    shown = navette("interface", "proto", "verbs_msgs/srv/Ask", "--no-quotes")
    assert shown.stdout == "what:\n  number: 5\n\n"
