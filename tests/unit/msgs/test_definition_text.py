"""The text form of definitions: files, and the schema of bags and Foxglove."""

import pytest

from navette.msgs import definition_text, interface_names, packages
from navette.msgs.definition_text import message_text
from navette.msgs.interface import ActionSpec, MessageSpec, ServiceSpec
from navette.msgs.registry import DEFINITIONS, KINDS, get_spec

SEPARATOR = "=" * 80
BUILT_IN = [
    f"{package}/{kind}/{name}"
    for package in packages()
    if (DEFINITIONS / package).is_dir()
    for kind in KINDS
    for name in interface_names(package, kind)
]


def test_contained_messages_follow_once_each() -> None:
    text = definition_text("geometry_msgs/msg/TwistStamped")
    top, *sections = text.split(SEPARATOR + "\n")
    assert top == "std_msgs/Header header\nTwist twist\n".replace(
        "Twist", "geometry_msgs/Twist"
    )
    assert [section.splitlines()[0] for section in sections] == [
        "MSG: std_msgs/Header",
        "MSG: builtin_interfaces/Time",
        "MSG: geometry_msgs/Twist",
        "MSG: geometry_msgs/Vector3",
    ]


def test_constants_and_defaults() -> None:
    text = definition_text("sensor_msgs/msg/NavSatStatus")
    assert "int8 STATUS_NO_FIX=-1\n" in text
    assert "int8 status -2\n" in text
    assert "byte OK=0\n" in definition_text("diagnostic_msgs/msg/DiagnosticStatus")


def test_services_and_actions_keep_their_parts() -> None:
    assert definition_text("std_srvs/srv/SetBool") == (
        "bool data\n---\nbool success\nstring message\n"
    )
    fibonacci = definition_text("example_interfaces/action/Fibonacci")
    assert fibonacci == "int32 order\n---\nint32[] sequence\n---\nint32[] sequence\n"
    assert definition_text("std_srvs/srv/SetBool_Request") == "bool data\n"


@pytest.mark.parametrize("name", BUILT_IN)
def test_committed_files_contain_no_comments(name: str) -> None:
    """Only fields, defaults and constants."""
    package, kind, stem = name.split("/")
    spec = get_spec(name)
    if isinstance(spec, MessageSpec):
        parts: list[MessageSpec] = [spec]
    elif isinstance(spec, ServiceSpec):
        parts = [spec.request, spec.response]
    else:
        assert isinstance(spec, ActionSpec)
        parts = [spec.goal, spec.result, spec.feedback]
    text = "---\n".join(message_text(part) for part in parts)
    # Types of the same package have a full name there, in files a bare or full one.
    file = (DEFINITIONS / package / kind / f"{stem}.{kind}").read_text("utf-8")
    assert file.replace(f"{package}/", "") == text.replace(f"{package}/", "")
