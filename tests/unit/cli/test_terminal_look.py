"""What people see on a terminal: columns, values, and the usual in the background."""

from collections.abc import Iterator
from contextlib import ExitStack
from unittest.mock import patch

import pytest
from verb_world import World, world

from navette.cli.doctor.findings import Diagnosis, Rating
from navette.cli.doctor.report import report_lines
from navette.cli.message_yaml import yaml_of
from navette.msgs.example_interfaces.action import Fibonacci
from navette.msgs.example_interfaces.srv import AddTwoInts
from navette.msgs.std_msgs.msg import String
from navette.runtime import Node

# The last one after the others are imported: they take what it has.
ASKING = ("node", "param.verbs", "service.listing", "doctor.report", "output")


@pytest.fixture(autouse=True)
def terminal(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A person's, 50 columns wide, without colours."""
    monkeypatch.setenv("NO_COLOR", "1")
    monkeypatch.setenv("COLUMNS", "50")
    with ExitStack() as stack:
        for name in ASKING:
            stack.enter_context(patch(f"navette.cli.{name}.is_terminal", lambda: True))
        yield


@pytest.fixture
def here() -> Iterator[World]:
    with world() as here:
        node = Node("talker", context=here.context)
        node.declare_parameter("speed", 1.5)
        node.declare_parameter("where", "a place whose name is really much too long")
        node.create_publisher(String, "chatter", 10)
        node.create_service(AddTwoInts, "add", lambda request, response: response)
        here.graph.add(node)
        yield here


def test_node_info(here: World) -> None:
    lines = here.read("node", "info", "talker").splitlines()
    assert lines[:3] == ["/talker", "  Subscribers  none", "  Publishers"]
    # Fifty columns are too few for the longest name and its type side by side.
    assert lines[3:5] == ["    /chatter", "        std_msgs/msg/String"]


def test_param_list(here: World) -> None:
    assert here.read("param", "list", "talker", "--filter", "s|w").splitlines() == [
        "  speed                           1.5",
        "  start_type_description_service  true",
        "  where                           a place whose n…",
    ]
    typed = here.read("param", "list", "talker", "--param-type", "--filter", "sp|u")
    assert typed.splitlines() == [
        "  speed         double   1.5",
        "  use_sim_time  boolean  false",
    ]


def test_service_list(here: World) -> None:
    done = here.run("service", "list")
    assert done.out == "/add\n"
    assert done.err == "and 7 that every node has (-a shows them)\n"
    assert len(here.read("service", "list", "-a").splitlines()) == 8
    assert here.read("service", "list", "-t") == (
        "/add  example_interfaces/srv/AddTwoInts\n"
    )


def test_the_lines_of_the_doctor_are_wrapped_and_indented() -> None:
    finding = Diagnosis(
        Rating.PROBLEM,
        "Topics",
        "/scan",
        "/costmap receives nothing from /lidar: incompatible reliability",
        "let the subscription ask for best effort, or the publisher offer reliable",
    )
    assert report_lines([finding], everything=True) == [
        "Topics",
        "  ✗ /scan  /costmap receives nothing from /lidar:",
        "           incompatible reliability",
        "           → let the subscription ask for best",
        "             effort, or the publisher offer",
        "             reliable",
    ]


def test_a_long_label_of_the_doctor_is_above_its_text() -> None:
    findings = [
        Diagnosis(Rating.GOOD, "Stages", "/localization/status", "localized"),
        Diagnosis(Rating.NOTE, "Stages", "/lidar/self_filter/status", "passes"),
    ]
    assert report_lines(findings, everything=True) == [
        "Stages",
        "  ✓ /localization/status  localized",
        "  · /lidar/self_filter/status",
        "                          passes",
    ]
    with ExitStack() as stack:
        for name in ("output", "doctor.report"):
            stack.enter_context(patch(f"navette.cli.{name}.is_terminal", lambda: False))
        assert report_lines(findings, everything=True)[-1] == (
            "  · /lidar/self_filter/status  passes"
        )


def test_received_text_does_not_move_the_cursor() -> None:
    finding = Diagnosis(Rating.NOTE, "Stages", "/s", "calm \x1b[2J")
    assert report_lines([finding], everything=True)[1] == "  · /s  calm \\x1b[2J"


def test_messages_are_indented_and_their_numbers_side_by_side(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("navette.cli.message_yaml.is_terminal", lambda: True)
    message = Fibonacci.Result(sequence=list(range(12)))
    assert yaml_of(message, indent=4) == (
        "    sequence: [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10,\n               11]\n"
    )
