"""Definitions out of what a node answers, with and without the texts it was made of."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import click
import pytest

from navette.cli.message_types import interface_class
from navette.cli.peer_definitions import definition_of, described_by_peers
from navette.cli.session import connect, endpoints, service_endpoints
from navette.errors import InvalidNameError
from navette.msgs import get_interface, interface_names, packages
from navette.msgs.definition_sections import messages_of, read_definition
from navette.msgs.registry import get_spec
from navette.msgs.std_srvs.srv import SetBool, Trigger
from navette.msgs.type_description_interfaces.srv import GetTypeDescription
from navette.runtime import Context, Executor, Node, VirtualClock
from navette.runtime.type_description_service import describe

EVERY_TYPE = [
    f"{package}/{kind}/{name}"
    for package in packages()
    for kind in ("msg", "srv", "action")
    for name in interface_names(package, kind)
]


def answer(name: str, *, with_sources: bool) -> Any:
    request = GetTypeDescription.Request(
        type_name=name, include_type_sources=with_sources
    )
    return describe(request, GetTypeDescription.Response())


def on_the_wire(spec: Any) -> list[Any]:
    return [
        (part.name, [(field.name, field.type) for field in part.fields])
        for part in messages_of(spec)
    ]


@pytest.mark.parametrize("with_sources", [True, False])
def test_every_type_round_trips(*, with_sources: bool) -> None:
    for name in EVERY_TYPE:
        text = definition_of(name, answer(name, with_sources=with_sources))
        top, *contained = read_definition(name, text)
        # char and uint8 are one type on the wire.
        assert str(on_the_wire(top)).replace("'char'", "'uint8'") == str(
            on_the_wire(get_spec(name))
        ).replace("'char'", "'uint8'"), name
        assert all(get_spec(each.name) for each in contained)


def test_sources_keep_constants_and_defaults() -> None:
    name = "sensor_msgs/msg/BatteryState"
    text = definition_of(name, answer(name, with_sources=True))
    assert "POWER_SUPPLY_STATUS_FULL" in text
    text = definition_of(name, answer(name, with_sources=False))
    assert "POWER_SUPPLY_STATUS_FULL" not in text


def test_an_unknown_type_number_gives_no_definition() -> None:
    response = answer("std_msgs/msg/Int32", with_sources=False)
    response.type_description.type_description.fields[0].type.type_id = 200
    text = definition_of("std_msgs/msg/Int32", response)
    with pytest.raises(ValueError, match="unknown_type_200"):
        read_definition("std_msgs/msg/Int32", text)


@pytest.fixture
def server() -> Iterator[Node]:
    with Context(clock=VirtualClock()) as context:
        node = Node("server", context=context, start_parameter_services=False)
        Executor(context=context).add_node(node)
        node.create_service(SetBool, "switch", lambda _, response: response)
        yield node


def test_the_definition_is_requested_from_a_user_of_the_type(server: Node) -> None:
    with connect(server.context) as node:
        every = [*endpoints(node), *service_endpoints(node)]
        found = described_by_peers(node, "std_srvs/srv/SetBool", every)
        assert found.text is not None
        assert found.text.startswith("bool data\n---\nbool success\n")
        other = described_by_peers(node, "std_srvs/srv/Trigger", every)
        assert other.text is None


def test_nodes_without_a_definition_are_named(
    server: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    with connect(server.context) as node:
        mute = Node(
            "mute", context=server.context, start_parameter_services=False,
            cli_args=["-p", "start_type_description_service:=false"],
        )  # fmt: skip
        mute.create_service(Trigger, "other", lambda _, response: response)
        found = described_by_peers(
            node, "std_srvs/srv/Trigger", service_endpoints(node, "/other")
        )
        assert found.reason == "/mute: describes no types"
        # A node on another topic has the definition.
        mute.create_service(SetBool, "like_switch", lambda _, response: response)
        (end,) = service_endpoints(node, "/like_switch")
        found = described_by_peers(node, "std_srvs/srv/SetBool", [end])
        assert found.text is not None
        other = replace(end, type_hash="RIHS01_" + "0" * 64)
        assert described_by_peers(node, "std_srvs/srv/SetBool", [other]).text is None


def test_an_unknown_type_ends_the_command(
    server: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    with connect(server.context) as node, pytest.raises(click.exceptions.Exit):
        interface_class(node, "nowhere_msgs/Thing", endpoints(node), kind="msg")
    assert "type nowhere_msgs/msg/Thing is not installed" in capsys.readouterr().err


def test_a_type_of_another_kind_is_refused(server: Node) -> None:
    with connect(server.context) as node:
        assert interface_class(node, "std_srvs/SetBool", [], kind="srv") is SetBool
        with pytest.raises(InvalidNameError, match="is not package/srv/Name"):
            interface_class(node, "std_msgs/msg/Bool", [], kind="srv")
        with pytest.raises(InvalidNameError):
            interface_class(node, "no/such/form/of/name", [])
    assert get_interface("std_srvs/srv/SetBool") is SetBool


def test_a_different_definition_is_reported(
    server: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    with connect(server.context) as node:
        (end,) = service_endpoints(node, "/switch")
        other = replace(end, type_hash="RIHS01_" + "0" * 64)
        assert interface_class(node, "std_srvs/srv/SetBool", [other]) is SetBool
    printed = capsys.readouterr().err
    assert printed.startswith(
        "/server has another definition of std_srvs/srv/SetBool (RIHS01_0000000000…"
    )
    assert "messages cannot be exchanged with it" in printed
