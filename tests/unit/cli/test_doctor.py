"""``navette doctor`` on nodes that run: what it sees, its exit code, its JSON."""

import json
from collections.abc import Iterator
from typing import Any
from unittest.mock import patch

import pytest
from verb_world import World, world

from navette.cli.doctor.network import Network
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus
from navette.msgs.rosgraph_msgs.msg import Clock
from navette.msgs.std_msgs.msg import String
from navette.runtime import DurabilityPolicy, Node, QoSProfile, ReliabilityPolicy


@pytest.fixture
def here() -> Iterator[World]:
    """The network itself is looked at by tests/scenarios."""
    with (
        world() as here,
        patch("navette.cli.doctor.network.look_at_network", lambda: Network(nodes={})),
    ):
        yield here


def node(here: World, name: str) -> Node:
    return here.graph.add(Node(name, context=here.context))


def findings(here: World) -> dict[str, dict[str, Any]]:
    done = here.run("doctor", "--json")
    report = json.loads(done.out)
    assert done.code == (1 if report["problems"] else 0)
    return {each["what"]: each for each in report["findings"]}


def test_a_healthy_graph(here: World) -> None:
    talker = node(here, "talker")
    talker.create_publisher(String, "chatter", 10)
    node(here, "listener").create_subscription(String, "chatter", lambda _: None, 10)
    found = findings(here)
    assert found["nodes"]["data"] == {"nodes": ["/listener", "/talker"]}
    assert found["topics"]["text"] == "1 topic connected, types and QoS match"
    assert found["clock"]["text"] == "system time"
    assert found["versions"]["level"] == "good"


def test_troubles_are_problems(here: World) -> None:
    node(here, "twin")
    node(here, "twin")
    hanging = node(here, "hanging")
    here.graph.executor.remove_node(hanging)
    reader = node(here, "reader")
    reader.create_subscription(String, "chatter", lambda _: None, 10)
    offer = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    node(here, "writer").create_publisher(String, "chatter", offer)
    found = findings(here)
    levels = {what: found[what]["level"] for what in ("/twin", "/hanging", "/chatter")}
    assert set(levels.values()) == {"problem"}
    done = here.run("doctor", "-q")
    assert done.code == 1
    assert "  ✗ /hanging" in done.out
    assert "✓" not in done.out
    assert done.out.splitlines()[-1].startswith("3 problems")


def test_sim_time_without_a_clock(here: World) -> None:
    waiting = node(here, "waiting")
    here.read("param", "set", "waiting", "use_sim_time", "true")
    assert findings(here)["/clock"]["level"] == "problem"
    clock = waiting.create_publisher(Clock, "/clock", 10)
    waiting.create_timer(0.01, lambda: clock.publish(Clock()))
    assert findings(here)["clock"]["text"] == "simulated, by /waiting"


def test_heartbeats(here: World) -> None:
    planner = node(here, "planner")
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    status = planner.create_publisher(DiagnosticStatus, "/planner/status", latched)
    status.publish(DiagnosticStatus(message="following"))
    here.graph.run_for(3.0)
    found = findings(here)["/planner/status"]
    assert found["level"] == "problem"
    assert found["text"] == "no status for 4.2 s, last state following"
    planner.create_timer(
        0.5, lambda: status.publish(DiagnosticStatus(message="reached"))
    )
    here.graph.run_for(1.0)
    found = findings(here)["/planner/status"]
    assert (found["level"], found["text"]) == ("good", "reached")
