"""The service ~/get_type_description."""

import re
from collections.abc import Callable
from typing import Any

import pytest

from navette.cli.peer_definitions import definition_of
from navette.msgs import definition_text, register_definition, type_hash
from navette.msgs.type_description_interfaces.msg import FieldType
from navette.msgs.type_description_interfaces.srv import GetTypeDescription
from navette.runtime import Node, Parameter
from navette.runtime.parameter import ParameterType
from navette.runtime.testing import GraphHarness

Ask = Callable[..., Any]


@pytest.fixture
def ask(graph: GraphHarness) -> Ask:
    graph.add(Node("talker", namespace="ns", context=graph.context))
    client = graph.node.create_client(
        GetTypeDescription, "/ns/talker/get_type_description"
    )

    def call(name: str, **fields: Any) -> Any:
        request = GetTypeDescription.Request(type_name=name, **fields)
        return client.call(request, timeout_sec=1.0)

    return call


def test_a_message(ask: Ask) -> None:
    name = "geometry_msgs/msg/PointStamped"
    answer = ask(name, type_hash=type_hash(name))
    assert answer.successful
    assert answer.failure_reason == ""
    description = answer.type_description
    assert description.type_description.type_name == name
    referenced = description.referenced_type_descriptions
    assert [each.type_name for each in referenced] == [
        "builtin_interfaces/msg/Time",
        "geometry_msgs/msg/Point",
        "std_msgs/msg/Header",
    ]
    (x, *_) = referenced[1].fields
    assert (x.name, x.type.type_id) == ("x", FieldType.FIELD_TYPE_DOUBLE)
    assert [(s.type_name, s.encoding) for s in answer.type_sources] == [
        (name, "msg"),
        *((each.type_name, "msg") for each in referenced),
    ]
    point = answer.type_sources[2].raw_file_contents
    assert point == "float64 x\nfloat64 y\nfloat64 z\n"


@pytest.mark.parametrize(
    "name",
    [
        "sensor_msgs/msg/BatteryState",
        "example_interfaces/srv/AddTwoInts",
        "example_interfaces/action/Fibonacci",
        "rcl_interfaces/msg/ParameterDescriptor",
    ],
)
def test_the_response_contains_the_whole_definition(ask: Ask, name: str) -> None:
    answer = ask(name)
    assert definition_of(name, answer).startswith(definition_text(name).split("=")[0])
    parts = {s.type_name: s.encoding for s in answer.type_sources}
    kind = name.split("/")[1]
    assert parts[name] == kind
    implicit = {n for n, encoding in parts.items() if encoding == "implicit"}
    assert implicit == {
        n for n in parts if "_" in n.rpartition("/")[2] and n.split("/")[1] != "msg"
    }


def test_types_registered_at_run_time(ask: Ask) -> None:
    register_definition("described_cases/msg/Odd", "int8 x\n")
    answer = ask("described_cases/msg/Odd", include_type_sources=False)
    assert answer.successful
    assert answer.type_sources == []


@pytest.mark.parametrize(
    ("name", "given", "reported"),
    [
        ("std_msgs/msg/Strung", "", "Strung"),
        ("nonsense", "", "nonsense"),
        ("std_msgs/msg/String", "RIHS01_00", "is RIHS01_.*, not RIHS01_00"),
    ],
)
def test_the_failure_reason(ask: Ask, name: str, given: str, reported: str) -> None:
    answer = ask(name, type_hash=given)
    assert not answer.successful
    assert re.search(reported, answer.failure_reason)


def test_the_service_can_be_disabled(graph: GraphHarness) -> None:
    off = Parameter("start_type_description_service", ParameterType.BOOL, False)
    node = graph.add(Node("quiet", context=graph.context, parameter_overrides=[off]))
    names = [name for name, _ in node.get_service_names_and_types_by_node("quiet", "/")]
    assert "/quiet/get_type_description" not in names
    (result,) = node.set_parameters([Parameter(off.name, value=True)])
    assert not result.successful
    assert "read-only" in result.reason
