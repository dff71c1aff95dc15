"""The doctor's checks, each on a made-up snapshot: what is printed, and how loudly."""

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import pytest

from navette.cli.doctor.findings import Diagnosis, Rating, listed, plural
from navette.cli.doctor.graph_checks import check_nodes, check_services, check_topics
from navette.cli.doctor.machine import is_navette, left_running, stopped
from navette.cli.doctor.network import Network, Router, check_network
from navette.cli.doctor.processes import Process
from navette.cli.doctor.report import report_lines, summary
from navette.cli.doctor.router_diagnosis import PortProbe, Refusal
from navette.cli.doctor.snapshot import Snapshot, StageStatus
from navette.cli.doctor.state_checks import check_stages, check_time
from navette.cli.doctor.up_checks import check_supervised
from navette.files.runs import RunInfo
from navette.msgs import type_hash
from navette.transports import (
    DurabilityPolicy,
    Endpoint,
    EndpointKind,
    EndpointQos,
    ReliabilityPolicy,
)

SCAN = "sensor_msgs/msg/LaserScan"
BEST_EFFORT = EndpointQos(reliability=ReliabilityPolicy.BEST_EFFORT)
LATCHED = EndpointQos(durability=DurabilityPolicy.TRANSIENT_LOCAL)


def end(
    kind: EndpointKind,
    topic: str,
    node: str,
    type_name: str = SCAN,
    qos: EndpointQos | None = None,
) -> Endpoint:
    return Endpoint(kind, topic, type_name, qos or EndpointQos(), node, "/", bytes(16))


def pub(topic: str, node: str, *rest: object) -> Endpoint:
    return end(EndpointKind.PUBLISHER, topic, node, *rest)  # type: ignore[arg-type]


def sub(topic: str, node: str, *rest: object) -> Endpoint:
    return end(EndpointKind.SUBSCRIPTION, topic, node, *rest)  # type: ignore[arg-type]


def of(findings: Iterable[Diagnosis], what: str) -> Diagnosis:
    (found,) = [finding for finding in findings if finding.what == what]
    return found


def test_healthy_nodes() -> None:
    seen = Snapshot(nodes=("/a", "/b"), sim_time={"/a": False, "/b": False})
    (finding,) = check_nodes(seen)
    assert (finding.level, finding.text) == (
        Rating.GOOD,
        "2 nodes with unique names; all respond",
    )
    (finding,) = check_nodes(Snapshot(nodes=("/a",), sim_time={"/a": False}))
    assert finding.text == "1 node; it responds"


def test_no_nodes_give_a_note_with_advice() -> None:
    (finding,) = check_nodes(Snapshot())
    assert finding.level is Rating.NOTE
    assert "ROS_DOMAIN_ID" in finding.advice


def test_nodes_of_one_name() -> None:
    finding = of(check_nodes(Snapshot(nodes=("/a", "/b", "/a"))), "/a")
    assert (finding.level, finding.text) == (
        Rating.PROBLEM,
        "2 nodes have this name",
    )
    assert "__node:=" in finding.advice


def test_a_node_that_does_not_respond() -> None:
    seen = Snapshot(nodes=("/a",), sim_time={"/a": None}, unreached=("/b",))
    findings = list(check_nodes(seen))
    assert of(findings, "/a").text == "does not respond"
    assert of(findings, "/b").text == "is listed by the router, but cannot be reached"
    assert {finding.level for finding in findings} == {Rating.PROBLEM}


def test_an_unreachable_node_explains_missing_topics() -> None:
    seen = Snapshot(
        nodes=("/planner", "/sim"),
        endpoints=(pub("/path", "planner"), sub("/cmd_vel_nav", "arbiter")),
        unreached=("/control",),
        unreached_topics={"/control": ("/cmd_vel_nav", "/control/status")},
        speed_mps=0.0,
    )
    finding = of(check_nodes(seen), "/control")
    assert finding.text == (
        "is listed by the router, but cannot be reached; the robot is stopped"
    )
    assert finding.data["publishes"] == ["/cmd_vel_nav", "/control/status"]
    whats = [each.what for each in (*check_nodes(seen), *check_topics(seen))]
    assert whats == ["/control", "nodes", "unread"]


def test_a_stage_that_is_missing_between_others() -> None:
    wheels = (sub("/cmd_vel_nav", "arbiter"), pub("/cmd_vel", "arbiter"))
    seen = Snapshot(
        nodes=("/planner", "/arbiter", "/sim"),
        endpoints=(pub("/path", "planner"), *wheels, sub("/cmd_vel", "sim")),
        speed_mps=0.42,
    )
    finding = of(check_nodes(seen), "control")
    assert finding.level is Rating.PROBLEM
    assert finding.text == (
        "is missing: no node turns /path into /cmd_vel_nav; the robot drives at 0.4 m/s"
    )
    assert "navette run navette control" in finding.advice
    assert "/cmd_vel_nav" not in [each.what for each in check_topics(seen)]
    # Driven by hand, without a planner: no stage is missing.
    by_hand = Snapshot(nodes=("/sim",), endpoints=(sub("/cmd_vel", "sim"),))
    assert [each.what for each in check_nodes(by_hand)] == ["nodes"]


def test_a_missing_arbiter() -> None:
    seen = Snapshot(
        nodes=("/control", "/sim"),
        endpoints=(pub("/cmd_vel_nav", "control"), sub("/cmd_vel", "sim")),
    )
    finding = of(check_nodes(seen), "arbiter")
    assert "no node turns /cmd_vel_nav into /cmd_vel" in finding.text


def test_two_definitions_of_a_type() -> None:
    ours, theirs = (
        replace(end, type_hash=f"RIHS01_{digit * 64}")
        for end, digit in ((pub("/scan", "lidar"), "a"), (sub("/scan", "old"), "b"))
    )
    finding = of(check_topics(Snapshot(endpoints=(ours, theirs))), "/scan")
    assert finding.level is Rating.PROBLEM
    assert finding.text == (
        f"{SCAN} has 2 definitions: "
        "/lidar (of no known distribution, hash aaaaaaaa…) | "
        "/old (of no known distribution, hash bbbbbbbb…)"
    )
    jazzy = replace(ours, type_hash=type_hash(SCAN))
    finding = of(check_topics(Snapshot(endpoints=(jazzy, theirs))), "/scan")
    assert "/lidar (humble, jazzy, kilted, lyrical, rolling, hash " in finding.text
    unhashed = replace(theirs, type_hash="TypeHashNotSupported")
    (finding,) = check_topics(Snapshot(endpoints=(ours, unhashed)))
    assert finding.level is Rating.GOOD


def test_matching_topics() -> None:
    seen = Snapshot(endpoints=(pub("/scan", "lidar"), sub("/scan", "costmap")))
    (finding,) = check_topics(seen)
    assert (finding.level, finding.text) == (
        Rating.GOOD,
        "1 topic connected, types and QoS match",
    )


def test_two_types_on_a_topic() -> None:
    seen = Snapshot(
        endpoints=(pub("/scan", "lidar"), sub("/scan", "odd", "std_msgs/msg/String"))
    )
    finding = of(check_topics(seen), "/scan")
    assert finding.level is Rating.PROBLEM
    assert finding.text == (f"has 2 types: {SCAN}: /lidar; std_msgs/msg/String: /odd")


TWIST, STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"


def test_a_node_may_use_several_types_on_a_topic() -> None:
    both = (sub("/cmd_vel", "sim", TWIST), sub("/cmd_vel", "sim", STAMPED))
    mine = pub("/cmd_vel", "arbiter", TWIST)
    (finding,) = check_topics(Snapshot(endpoints=(*both, mine)))
    assert finding.level is Rating.GOOD
    # A publisher of one type and a subscriber of the other, though a third has both.
    other = sub("/cmd_vel", "recorder", STAMPED)
    finding = of(check_topics(Snapshot(endpoints=(*both, mine, other))), "/cmd_vel")
    assert finding.level is Rating.PROBLEM
    assert finding.text == (
        f"has 2 types: {TWIST}: /arbiter, /sim; {STAMPED}: /recorder, /sim"
    )


def test_subscribers_of_different_types_without_a_publisher() -> None:
    one, other = sub("/cmd", "a", TWIST), sub("/cmd", "b", STAMPED)
    levels = [each.level for each in check_topics(Snapshot(endpoints=(one, other)))]
    assert levels == [Rating.PROBLEM, Rating.WARNING]  # of the types, no publisher


def test_definitions_are_compared_for_each_type() -> None:
    ends = [
        replace(end, type_hash=f"RIHS01_{digit * 64}")
        for end, digit in (
            (pub("/cmd_vel", "arbiter", TWIST), "a"),
            (sub("/cmd_vel", "sim", TWIST), "a"),
            (sub("/cmd_vel", "sim", STAMPED), "b"),
        )
    ]
    (finding,) = check_topics(Snapshot(endpoints=tuple(ends)))
    assert finding.level is Rating.GOOD


@pytest.mark.parametrize(
    ("offered", "wanted", "policy"),
    [
        (BEST_EFFORT, EndpointQos(), "reliability"),
        (EndpointQos(), LATCHED, "durability"),
        (EndpointQos(), EndpointQos(deadline_ns=10**9), "deadline"),
        (EndpointQos(), EndpointQos(lease_ns=10**9), "liveliness lease duration"),
    ],
)
def test_incompatible_qos(
    offered: EndpointQos, wanted: EndpointQos, policy: str
) -> None:
    seen = Snapshot(
        endpoints=(
            pub("/scan", "lidar", SCAN, offered),
            sub("/scan", "costmap", SCAN, wanted),
        )
    )
    finding = of(check_topics(seen), "/scan")
    assert finding.level is Rating.PROBLEM
    assert finding.text == (
        f"/costmap receives nothing from /lidar: incompatible {policy}"
    )
    assert finding.advice


def test_a_topic_without_publisher_and_a_topic_of_the_same_type() -> None:
    seen = Snapshot(endpoints=(pub("/lidar", "lidar"), sub("/scan", "costmap")))
    findings = list(check_topics(seen))
    finding = of(findings, "/scan")
    assert finding.level is Rating.WARNING
    assert finding.text == "has no publisher; /costmap waits for it"
    assert finding.advice == (
        "/lidar has the same type and no subscription; to use it:"
        " --ros-args -r /scan:=/lidar"
    )
    assert of(findings, "unread").level is Rating.NOTE


def test_topics_published_by_hand_and_standard_topics_are_not_reported() -> None:
    seen = Snapshot(
        endpoints=(
            sub("/goal_point", "planner"),
            pub("/rosout", "planner"),
            sub("/do/_action/feedback", "client"),
        )
    )
    assert list(check_topics(seen)) == []


def test_a_misspelled_topic_that_is_published_by_hand_is_reported() -> None:
    bool_type = "std_msgs/msg/Bool"
    wanted = sub("/emergency_stop", "arbiter", bool_type)
    unrelated = pub("/lights", "mine", bool_type)
    findings = list(check_topics(Snapshot(endpoints=(wanted, unrelated))))
    assert [each.what for each in findings] == ["unread"]
    misspelled = pub("/emergancy_stop", "mine", bool_type)
    finding = of(
        check_topics(Snapshot(endpoints=(wanted, misspelled))), "/emergency_stop"
    )
    assert finding.level is Rating.WARNING
    assert finding.data["published_instead"] == ["/emergancy_stop"]


def test_a_client_without_a_server() -> None:
    client = end(EndpointKind.CLIENT, "/gone/get_parameters", "viewer", "a/srv/Get")
    assert list(check_services(Snapshot(services=(client,)))) == []
    client = end(EndpointKind.CLIENT, "/add", "asker", "a/srv/Add")
    finding = of(check_services(Snapshot(services=(client,))), "/add")
    assert finding.text == "has no server; /asker may wait for it"
    server = end(EndpointKind.SERVICE, "/add", "adder", "a/srv/Add")
    assert list(check_services(Snapshot(services=(client, server)))) == []
    odd = replace(server, type_name="b/srv/Add")
    (finding,) = check_services(Snapshot(services=(client, odd)))
    assert finding.level is Rating.PROBLEM


def test_simulated_time_without_a_clock() -> None:
    seen = Snapshot(nodes=("/a", "/b"), sim_time={"/a": True, "/b": False})
    (finding,) = check_time(seen)
    assert finding.level is Rating.PROBLEM
    assert "1 node with use_sim_time (/a)" in finding.text
    assert "navette param set /a use_sim_time false" in finding.advice


def test_clocks() -> None:
    one = Snapshot(
        nodes=("/a", "/sim"),
        endpoints=(pub("/clock", "sim"),),
        sim_time={"/a": True},
        clock_ticks=True,
    )
    (finding,) = check_time(one)
    assert (finding.level, finding.text) == (Rating.GOOD, "simulated, by /sim")
    (finding,) = check_time(replace(one, clock_ticks=False))
    assert finding.level is Rating.WARNING
    two = replace(one, endpoints=(*one.endpoints, pub("/clock", "player")))
    assert next(iter(check_time(two))).level is Rating.PROBLEM


@pytest.mark.parametrize(
    ("beat", "level", "text"),
    [
        (
            StageStatus("/planner/status", "following", 0, 0.1),
            Rating.GOOD,
            "following",
        ),
        (
            StageStatus("/planner/status", "no_path", 1, 0.1),
            Rating.WARNING,
            "no_path",
        ),
        (
            StageStatus("/planner/status", "canceled", 1, 0.1),
            Rating.WARNING,
            "cancelled",
        ),
        (
            StageStatus("/planner/status", "following", 0, 7.0),
            Rating.PROBLEM,
            "no status for 7.0 s, last state following",
        ),
        (
            StageStatus("/planner/status"),
            Rating.PROBLEM,
            "no status, last state unknown",
        ),
    ],
)
def test_heartbeats(beat: StageStatus, level: Rating, text: str) -> None:
    seen = Snapshot(endpoints=(pub(beat.topic, "planner"),), heartbeats=(beat,))
    (finding,) = check_stages(seen)
    assert (finding.level, finding.text) == (level, text)


def test_a_stage_without_a_clock_is_not_reported_as_hanging() -> None:
    beat = StageStatus("/planner/status", "following", level=0, age_s=7.0)
    ends = (pub(beat.topic, "planner"),)
    seen = Snapshot(endpoints=ends, heartbeats=(beat,), sim_time={"/planner": True})
    (found,) = check_stages(seen)
    assert found.advice.startswith("/planner waits for /clock")


def test_the_motion_of_the_robot() -> None:
    stale = StageStatus("/control/status", "stale_path", 1, 0.1)
    seen = Snapshot(heartbeats=(stale,), speed_mps=0.0)
    status, robot = check_stages(seen)
    assert status.level is Rating.WARNING
    assert status.text == "stale_path: this input is too old; the robot is stopped"
    assert (robot.what, robot.text) == ("robot", "the robot is stopped")


HERE = "tcp/127.0.0.1:7447"


def test_a_command_line_is_quoted_for_a_shell() -> None:
    words = ("python", "-u", "/bin/navette", "sim", "--robot", "", "--sensor=")
    assert Process(1, 0, words).command == "navette sim --robot '' --sensor="
    assert Process(1, 0, ("nginx: worker process",)).command == "nginx: worker process"
    assert Process(1, 0, ()).command == "?"


DEMO = Process(12, 11, ("python", "/bin/navette", "demo"))


@pytest.mark.parametrize(
    ("network", "level", "text"),
    [
        (
            Network(routers=(Router(HERE, PortProbe.OPEN, DEMO),), nodes={}),
            Rating.GOOD,
            f"{HERE}, served by navette demo (process 12)",
        ),
        (
            Network(routers=(Router(HERE, PortProbe.REFUSED),), nodes=None),
            Rating.NOTE,
            f"{HERE} is free: the first program becomes the router",
        ),
        (
            Network(
                routers=(
                    Router(HERE, PortProbe.OPEN, None, Refusal("requires TLS", "")),
                ),
                nodes=None,
            ),
            Rating.PROBLEM,
            f"{HERE} is open, but requires TLS",
        ),
        (
            Network(
                routers=(Router(HERE, PortProbe.OPEN, DEMO._replace(is_stopped=True)),)
            ),
            Rating.PROBLEM,
            f"{HERE} belongs to navette demo (process 12), which is stopped: no"
            " program can connect",
        ),
        (
            Network(
                routers=(Router("tcp/10.0.0.2:7447", PortProbe.TIMED_OUT),), nodes=None
            ),
            Rating.PROBLEM,
            "tcp/10.0.0.2:7447 does not respond",
        ),
        (
            Network(routers=(Router("quic/10.0.0.2:7447"),), nodes={}),
            Rating.NOTE,
            "quic/10.0.0.2:7447, whose protocol cannot be probed",
        ),
    ],
)
def test_routers(network: Network, level: Rating, text: str) -> None:
    finding = of(check_network(network, 0), "router")
    assert (finding.level, finding.text) == (level, text)


def test_nodes_of_another_domain() -> None:
    finding = of(check_network(Network(nodes={42: ["/a", "/b"]}), 0), "domain")
    assert finding.level is Rating.WARNING
    assert finding.text == "0 (ROS_DOMAIN_ID) is empty; 2 nodes in 42"
    assert finding.advice == "to see them: export ROS_DOMAIN_ID=42"
    both = Network(nodes={0: ["/c"], 42: ["/a"]})
    assert of(check_network(both, 0), "domain").level is Rating.NOTE


def test_settings_that_keep_one_alone() -> None:
    network = Network(transport="inprocess", middleware="rmw_fastrtps_cpp")
    findings = list(check_network(network, 0))
    assert of(findings, "transport").level is Rating.PROBLEM
    assert "rmw_zenoh_cpp" in of(findings, "ROS 2").advice


def test_supervised_services() -> None:
    calm = {"label": "sim", "state": "running", "restarts": 0, "reason": ""}
    restless = {**calm, "label": "planner", "restarts": 3, "reason": "exit code 1"}
    dead = {**calm, "label": "control", "state": "failed", "reason": "no such file"}
    services = [
        {"service": "sim", "processes": [calm]},
        {"service": "robot", "processes": [restless, dead]},
    ]
    assert list(check_supervised([])) == []
    (finding,) = check_supervised(services[:1])
    assert (finding.level, finding.text) == (Rating.GOOD, "1 service up: sim")
    found = list(check_supervised(services))
    assert [(each.what, each.level, each.text) for each in found] == [
        ("planner", Rating.WARNING, "restarted 3 times: exit code 1"),
        ("control", Rating.PROBLEM, "not running: no such file"),
    ]
    assert found[0].advice == "navette logs robot"


def test_programs_that_are_stopped(monkeypatch: pytest.MonkeyPatch) -> None:
    control = Process(20, 1, ("python", "-u", "/bin/navette", "run"), is_stopped=True)
    every = [control, control._replace(pid=21, is_stopped=False)]
    # Whether it has nodes is seen in /proc, of processes that there are.
    assert list(stopped(every, here=14)) == []
    monkeypatch.setattr("navette.cli.doctor.machine.has_nodes", lambda _: True)
    (finding,) = stopped(every, here=14)
    assert (finding.what, finding.level) == ("process 20", Rating.PROBLEM)
    assert finding.text.startswith("navette run is stopped (Ctrl-Z, SIGSTOP)")
    assert "kill -CONT 20" in finding.advice


def test_programs_that_lost_their_parent() -> None:
    demo = Process(10, 1, ("/venv/bin/python", "/venv/bin/navette", "demo"), session=9)
    every = [
        Process(1, 0, ("/sbin/init",)),
        demo,
        Process(11, 1, ("bash",)),
        Process(12, 11, ("/venv/bin/python", "-m", "navette", "sim")),
        Process(14, 1, ("/venv/bin/python", "/venv/bin/navette", "doctor")),
    ]
    findings = list(left_running(every, here=14))
    assert [finding.what for finding in findings] == ["process 10"]
    assert findings[0].text.startswith("navette demo still runs, but the terminal")
    assert findings[0].advice == "if it is not needed: kill 10"
    in_container = [Process(1, 0, ("bash",), session=1), demo._replace(session=1)]
    assert list(left_running(in_container, here=14)) == []
    orphan = [in_container[0], demo]  # its terminal, session 9, has gone
    assert [each.what for each in left_running(orphan, here=14)] == ["process 10"]


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (("/usr/bin/python3", "/opt/venv/bin/navette", "sim"), True),
        (("python3.12", "-m", "navette", "sim"), True),
        (("python3", "-u", "-m", "navette", "run", "a.py"), True),
        (("python3", "-m", "navette.supervisor.daemon"), False),
        (("vim", "navette"), False),
        (("python3", "talker.py"), False),
        ((), False),
    ],
)
def test_which_processes_are_navette(words: tuple[str, ...], expected: bool) -> None:
    assert is_navette(Process(1, 0, words)) == expected


def test_words() -> None:
    assert [plural(n, "node") for n in (0, 1, 2)] == ["no nodes", "1 node", "2 nodes"]
    assert listed("dacb") == "a, b, c, d"
    assert listed("abcdefgh") == "a, b, c, d, e, f and 2 more"


def test_the_report() -> None:
    findings = [
        Diagnosis(Rating.GOOD, "Nodes", "nodes", "2 nodes"),
        Diagnosis(Rating.PROBLEM, "Topics", "/scan", "bad", "mend it"),
        Diagnosis(Rating.WARNING, "Topics", "/map", "odd"),
    ]
    assert report_lines(findings, everything=True) == [
        "Nodes",
        "  ✓ nodes  2 nodes",
        "",
        "Topics",
        "  ✗ /scan  bad",
        "           → mend it",
        "  ! /map   odd",
    ]
    assert report_lines(findings, everything=False)[0] == "Topics"
    assert summary(findings) == "1 problem, 1 warning"
    assert summary(findings[:1]) == "no problems"


def test_the_joined_run_replaces_the_router() -> None:
    run = RunInfo(
        folder=Path("/run/demo"), name="demo", command="navette demo", world="a", pid=7
    )
    router = Router(run.router)
    found = list(check_network(Network(routers=(router,), nodes={}, run=run), 0))
    finding = of(found, "run")
    assert finding.level is Rating.GOOD
    assert "navette demo, world a, process 7; private" in finding.text
    assert "router" not in {each.what for each in found}
    frozen = Network(routers=(router,), nodes=None, run=run)
    finding = of(check_network(frozen, 0), "run")
    assert finding.level is Rating.PROBLEM
    assert "does not respond" in finding.text
    assert "kill -CONT 7" in finding.advice


def test_runs_that_are_not_joined_are_named() -> None:
    finding = of(check_network(Network(nodes={}, other_runs=("a", "b")), 0), "runs")
    assert finding.level is Rating.NOTE
    assert "do not join run a, b" in finding.text
    assert "NAVETTE_RUN=a" in finding.advice
