"""Two independent peers with rmw_zenoh's wire format: zenoh-ros2-sdk, pyzeros."""

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from fleet import until

from free_ports import free_port
from navette.msgs import type_hash
from navette.msgs.std_msgs.msg import String
from navette.msgs.std_srvs.srv import SetBool
from navette.runtime import Context, Executor, Node, QoSProfile
from navette.transports import Endpoint, EndpointKind

pytestmark = pytest.mark.slow

PEERS = Path(__file__).parent / "peers"
HASHES = [type_hash("std_msgs/msg/String"), type_hash("std_srvs/srv/SetBool")]
PROGRAMS = {"zenoh-ros2-sdk": "sdk_peer.py", "pyzeros": "pyzeros_peer.py"}
# pyzeros compiles its codecs if .cydr_cache has none: 9 CPU seconds, and 37 with the
# optimisation that a few messages do not need.
COMPILING_S = 300.0
ENV = {"PYTHONWARNINGS": "ignore", "CFLAGS": "-O0 -g0"}


class Peer:
    """A running peer; its output is in a file."""

    def __init__(self, program: str, port: int, output: Path) -> None:
        self._output = output
        with output.open("wb") as file:
            self._process = subprocess.Popen(
                [sys.executable, str(PEERS / program), str(port), *HASHES],
                stdin=subprocess.PIPE,
                stdout=file,
                stderr=subprocess.STDOUT,
                env={**os.environ, **ENV},
                text=True,
            )

    def send(self, line: str) -> None:
        assert self._process.stdin is not None
        self._process.stdin.write(f"{line}\n")
        self._process.stdin.flush()

    def printed(self, start: str) -> list[str]:
        text = self._output.read_text(encoding="utf-8")
        lines = text[: text.rfind("\n") + 1].splitlines()
        return [line for line in lines if line.startswith(start)]

    def end(self) -> int:
        assert self._process.stdin is not None
        self._process.stdin.close()
        try:
            return self._process.wait(20.0)
        finally:
            self._process.kill()


class Meeting:
    """A peer and a node of Navette on the same network."""

    def __init__(self, peer: Peer, node: Node, executor: Executor) -> None:
        self.peer = peer
        self.node = node
        self._executor = executor

    def until(self, check: Callable[[], bool], what: str) -> None:
        def look() -> bool:
            self._executor.spin_once(timeout_sec=0.0)
            return check()

        until(look, what)


@pytest.fixture(
    params=["zenoh-ros2-sdk", pytest.param("pyzeros", marks=pytest.mark.long)]
)
def meeting(
    request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Meeting]:
    port = free_port()
    monkeypatch.setenv("NAVETTE_ROUTER", f"tcp/127.0.0.1:{port}")
    context = Context(transport="zenoh")
    context.init(args=[], domain_id=7)
    node = Node("ours", context=context)
    executor = Executor(context=context)
    executor.add_node(node)
    peer = Peer(PROGRAMS[request.param], port, tmp_path / "peer")
    try:
        until(lambda: bool(peer.printed("ready")), "the peer", patience_s=COMPILING_S)
        yield Meeting(peer, node, executor)
        assert peer.end() == 0
    finally:
        peer.end()
        context.shutdown()


def test_topics_in_both_directions(meeting: Meeting) -> None:
    received: list[tuple[str, int]] = []

    def receive(message: Any, info: Any) -> None:
        received.append((message.data, info["publication_sequence_number"]))

    node, peer = meeting.node, meeting.peer
    subscription = node.create_subscription(String, "/from_peer", receive, 10)
    publisher = node.create_publisher(String, "/to_peer", 10)
    meeting.until(lambda: subscription.get_publisher_count() == 1, "the publisher")
    meeting.until(lambda: publisher.get_subscription_count() == 1, "the subscription")
    for number in range(3):
        peer.send(f"publish text-{number}")
        publisher.publish(String(data=f"ours-{number}"))
    meeting.until(lambda: len(received) == 3, "the peer's messages")
    meeting.until(lambda: len(peer.printed("received")) == 3, "our messages")
    assert [text for text, _ in received] == ["text-0", "text-1", "text-2"]
    numbers = [number for _, number in received]
    assert numbers == list(range(numbers[0], numbers[0] + 3))
    assert peer.printed("received") == [
        "received ours-0",
        "received ours-1",
        "received ours-2",
    ]


def test_services_in_both_directions(meeting: Meeting) -> None:
    node, peer = meeting.node, meeting.peer

    def switch(request: Any, response: Any) -> Any:
        response.success, response.message = request.data, "by us"
        return response

    node.create_service(SetBool, "/our_switch", switch)
    peer.send("call")
    meeting.until(lambda: bool(peer.printed("reply")), "our reply")
    assert peer.printed("reply") == ["reply True by us"]
    client = node.create_client(SetBool, "/peer_switch")
    meeting.until(client.service_is_ready, "the peer's server")
    future = client.call_async(SetBool.Request(data=True))
    meeting.until(future.done, "the peer's answer")
    assert (future.result().success, future.result().message) == (True, "by the peer")


def test_navette_lists_the_peers_graph(meeting: Meeting) -> None:
    node = meeting.node
    graph = node.context.graph

    def clients() -> list[Endpoint]:
        return graph.service_endpoints("/our_switch", kind=EndpointKind.CLIENT)

    def publishers() -> list[Any]:
        return node.get_publishers_info_by_topic("/from_peer")

    def services() -> dict[str, list[str]]:
        return dict(node.get_service_names_and_types())

    # Tokens arrive in batches, in any order.
    meeting.until(
        lambda: bool(clients() and publishers()) and "/peer_switch" in services(),
        "all that the peer made",
    )
    meeting.until(lambda: "peer" in node.get_node_names(), "the peer itself")
    topics = dict(node.get_topic_names_and_types())
    assert topics["/from_peer"] == ["std_msgs/msg/String"]
    assert services()["/peer_switch"] == ["std_srvs/srv/SetBool"]
    (info,) = publishers()
    assert (info.node_name, info.node_namespace) == ("peer", "/")
    assert str(info.topic_type_hash) == HASHES[0]
    (end,) = clients()
    assert end.type_hash == HASHES[1]


@pytest.mark.parametrize("meeting", ["zenoh-ros2-sdk"], indirect=True)
def test_the_peer_lists_navettes_graph(meeting: Meeting) -> None:
    node, peer = meeting.node, meeting.peer
    node.create_publisher(String, "/ours", QoSProfile(depth=3))
    node.create_service(SetBool, "/our_switch", lambda request, response: response)

    def lists(line: str) -> bool:
        peer.send("topics")  # it queries the network each time
        return line in peer.printed(line.split()[0])

    meeting.until(lambda: lists("topic /ours std_msgs/msg/String"), "our topic")
    meeting.until(
        lambda: lists("service /our_switch std_srvs/srv/SetBool"), "our service"
    )
