"""navette topic list, info, type, find: exact text, in process."""

import json
from collections.abc import Iterator

import pytest
from topic_world import navette, program, shared_graph

from navette.msgs import type_hash
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.msgs.std_msgs.msg import String
from navette.runtime import (
    DurabilityPolicy,
    Node,
    QoSProfile,
    ReliabilityPolicy,
    qos_profile_sensor_data,
)

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@pytest.fixture
def talker() -> Iterator[Node]:
    with shared_graph(), program("talker") as node:
        node.create_publisher(String, "chatter", 10)
        node.create_publisher(OccupancyGrid, "map", LATCHED)
        node.create_publisher(String, "_hidden", 10)
        yield node


def test_list(talker: Node) -> None:
    shown = navette("topic", "list")
    assert shown.exit_code == 0
    assert shown.stdout == "/chatter\n/map\n/parameter_events\n/rosout\n"


def test_list_with_hidden_topics_and_types(talker: Node) -> None:
    shown = navette("topic", "list", "-t", "--include-hidden-topics")
    assert shown.stdout.splitlines() == [
        "/_hidden [std_msgs/msg/String]",
        "/chatter [std_msgs/msg/String]",
        "/map [nav_msgs/msg/OccupancyGrid]",
        "/parameter_events [rcl_interfaces/msg/ParameterEvent]",
        "/rosout [rcl_interfaces/msg/Log]",
    ]


def test_list_verbose_as_ros2_prints_it(talker: Node) -> None:
    talker.create_subscription(String, "chatter", print, 10)
    talker.create_subscription(String, "chatter", print, 10)
    assert navette("topic", "list", "-v").stdout == (
        "Published topics:\n"
        " * /chatter [std_msgs/msg/String] 1 publisher\n"
        " * /map [nav_msgs/msg/OccupancyGrid] 1 publisher\n"
        " * /parameter_events [rcl_interfaces/msg/ParameterEvent] 1 publisher\n"
        " * /rosout [rcl_interfaces/msg/Log] 1 publisher\n"
        "\n"
        "Subscribed topics:\n"
        " * /chatter [std_msgs/msg/String] 2 subscribers\n"
        "\n"
    )


def test_list_counts(talker: Node) -> None:
    assert navette("topic", "list", "--count").stdout == "4\n"


def test_list_for_a_person_is_a_table(
    talker: Node, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("navette.cli.topic.listing.is_terminal", lambda: True)
    monkeypatch.setenv("COLUMNS", "100")
    lines = navette("topic", "list", "-v").stdout.splitlines()
    assert lines[0].split() == ["TOPIC", "TYPE", "PUB", "SUB", "QOS", "OF", "THE",
                                "PUBLISHERS"]  # fmt: skip
    assert lines[2].split(maxsplit=4) == [
        "/map", "nav_msgs/msg/OccupancyGrid", "1", "0",
        "reliable, transient_local, last 1",
    ]  # fmt: skip


def test_list_as_json(talker: Node) -> None:
    found = json.loads(navette("topic", "list", "--json").stdout)
    assert [each["name"] for each in found][:2] == ["/chatter", "/map"]
    publisher = found[1]["publishers"][0]
    assert publisher["node"] == "/talker"
    assert publisher["hash"] == type_hash("nav_msgs/msg/OccupancyGrid")
    assert publisher["qos"]["durability"] == "transient_local"
    assert publisher["qos"]["deadline_ns"] is None


def test_an_empty_domain_is_reported_on_standard_error() -> None:
    with shared_graph():
        shown = navette("topic", "list")
    assert shown.exit_code == 0
    assert shown.stdout == ""
    assert shown.stderr.startswith("no topics: no nodes run in domain ")


def test_info(talker: Node) -> None:
    assert navette("topic", "info", "chatter").stdout == (
        "Type: std_msgs/msg/String\nPublisher count: 1\nSubscription count: 0\n"
    )


def test_info_on_a_terminal_names_the_nodes(
    talker: Node, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("navette.cli.topic.listing.is_terminal", lambda: True)
    lines = navette("topic", "info", "chatter").stdout.splitlines()
    assert lines[1:] == ["Publisher count: 1  /talker", "Subscription count: 0"]


def test_info_verbose_names_endpoints_with_hash_gid_and_qos(talker: Node) -> None:
    lines = navette("topic", "info", "/map", "--verbose").stdout.splitlines()
    assert lines[0] == "Type: nav_msgs/msg/OccupancyGrid"
    assert "Node name: talker" in lines
    hash_ = type_hash("nav_msgs/msg/OccupancyGrid")
    assert f"Topic type hash: {hash_}" in lines
    assert any(line.startswith("GID: ") for line in lines)
    assert "  Durability: TRANSIENT_LOCAL" in lines
    assert "  History (Depth): KEEP_LAST (1)" in lines


@pytest.mark.filterwarnings("ignore")
def test_info_lists_mismatches_with_the_reason(talker: Node) -> None:
    talker.create_publisher(String, "scan", qos_profile_sensor_data)
    with program("listener") as listener:
        reliable = QoSProfile(
            depth=5,
            reliability=ReliabilityPolicy.RELIABLE,
            durability=DurabilityPolicy.TRANSIENT_LOCAL,
        )
        listener.create_subscription(String, "scan", print, reliable)
        shown = navette("topic", "info", "/scan").stdout
    assert shown.splitlines()[-1] == (
        "Mismatch: /talker → /listener: "
        "reliability reliable requested, best_effort offered, "
        "durability transient_local requested, volatile offered"
    )


@pytest.mark.filterwarnings("ignore")
def test_a_node_that_accepts_two_types_has_no_mismatch(talker: Node) -> None:
    with program("base") as base, program("other") as other:
        both = [String, OccupancyGrid]
        for kind in both:
            base.create_subscription(kind, "command", print, 10, other_types=both)
        talker.create_publisher(String, "command", 10, other_types=both)
        assert "Mismatch" not in navette("topic", "info", "/command").stdout
        other.create_subscription(
            OccupancyGrid, "command", print, 10, other_types=[String]
        )
        shown = navette("topic", "info", "/command").stdout
    assert shown.splitlines()[-1] == (
        "Mismatch: /talker → /other: "
        "std_msgs/msg/String is not nav_msgs/msg/OccupancyGrid"
    )


@pytest.mark.parametrize("verb", ["info", "type"])
def test_an_unknown_topic_suggests_similar_names(talker: Node, verb: str) -> None:
    shown = navette("topic", verb, "/chater")
    assert shown.exit_code == 1
    assert shown.stdout == ""
    assert shown.stderr == (
        "navette: no publishers or subscriptions on /chater; did you mean /chatter?\n"
    )


def test_type(talker: Node) -> None:
    assert navette("topic", "type", "/map").stdout == "nav_msgs/msg/OccupancyGrid\n"


def test_find(talker: Node) -> None:
    talker.create_subscription(String, "other", print, 10)
    assert navette("topic", "find", "std_msgs/msg/String").stdout == (
        "/chatter\n/other\n"
    )
    assert navette("topic", "find", "std_msgs/String", "-c").stdout == "2\n"


def test_find_without_a_result(talker: Node) -> None:
    shown = navette("topic", "find", "std_msgs/msg/Bool")
    assert (shown.exit_code, shown.stdout) == (1, "")
    assert shown.stderr == "navette: no topic has type std_msgs/msg/Bool\n"
    shown = navette("topic", "find", "std_msgs/Strin")
    assert "; did you mean std_msgs/msg/String?" in shown.stderr


def test_the_domain_as_an_option(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "0")  # put back afterwards
    with shared_graph():
        shown = navette("--domain-id", "57", "topic", "list")
    assert shown.stderr == "no topics: no nodes run in domain 57 (ROS_DOMAIN_ID)\n"
    assert navette("--domain-id", "233", "topic", "list").exit_code == 2
