"""Each distribution of ROS 2: its tokens and keys, on the Zenoh version that it ships.

A process with that version of zenoh-python, and nothing of Navette, plays a node: it
declares the tokens below, written down from rmw_zenoh's liveliness tokens, and
exchanges small messages, images, clouds, markers, a latched map and service calls with
Navette in both directions. ``.ci/zenoh_versions`` installs the versions.
"""

import base64
import json
import os
import subprocess
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from free_ports import free_endpoint
from navette.msgs import deserialize, get_interface, serialize
from navette.msgs.classes import get_message_class
from navette.msgs.registry import DISTRO_VARIABLE
from navette.runtime.clock import Stopwatch, VirtualClock
from navette.transports import (
    DurabilityPolicy,
    Encoded,
    Endpoint,
    EndpointKind,
    EndpointQos,
    Item,
    Reply,
    Request,
)
from navette.transports.zenoh import Settings, ZenohTransport
from navette.transports.zenoh.attachment import Attachment
from navette.transports.zenoh.tokens import gid_of

FOLDER = Path(
    os.environ.get("NAVETTE_ZENOH_PEERS")
    or Path(__file__).parents[2] / ".venv-zenoh"
)  # fmt: skip
PROGRAM = Path(__file__).parent / "peers" / "zenoh_peer.py"
LIMIT_S = 60.0
DOMAIN = 7
ZID = "ab" * 16
NO_HASH = "TypeHashNotSupported"

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(os.name == "nt", reason="paths of POSIX environments"),
]


class Kind(NamedTuple):
    """A type as rmw_zenoh writes it into keys; ``has_octets``: unbounded uint8[]."""

    name: str
    dds: str
    hash: str
    has_octets: bool = False


STRING = Kind(
    "std_msgs/msg/String",
    "std_msgs::msg::dds_::String_",
    "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18",
)
KINDS = {
    "chatter": STRING,
    "image": Kind(
        "sensor_msgs/msg/Image",
        "sensor_msgs::msg::dds_::Image_",
        "RIHS01_d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47",
        has_octets=True,
    ),
    "cloud": Kind(
        "sensor_msgs/msg/PointCloud2",
        "sensor_msgs::msg::dds_::PointCloud2_",
        "RIHS01_9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5",
        has_octets=True,
    ),
    "marker": Kind(
        "visualization_msgs/msg/Marker",
        "visualization_msgs::msg::dds_::Marker_",
        "RIHS01_45b13ccf791f225962bf74e746f9644518855d783a6f42ba0cc14fde2b4f3ce0",
        has_octets=True,
    ),
    "map": Kind(
        "nav_msgs/msg/OccupancyGrid",
        "nav_msgs::msg::dds_::OccupancyGrid_",
        "RIHS01_8d348150c12913a31ee0ec170fbf25089e4745d17035792a1ba94d6f0bc0cfc7",
    ),
}
ADD = Kind(
    "example_interfaces/srv/AddTwoInts",
    "example_interfaces::srv::dds_::AddTwoInts_",
    "RIHS01_e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a",
)
# Reliable volatile keep_last 10; reliable transient_local keep_last 1; a service's.
QOS, LATCHED_QOS, SERVICE_QOS = "::,10:,:,:,,", ":1:,1:,:,:,,", "::,10:,:,:,,"
LATCHED = EndpointQos(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Distribution(NamedTuple):
    """A distribution of ROS 2 and a version of Zenoh that its rmw_zenoh contains."""

    name: str
    rmw_zenoh: str
    zenoh: str
    backends: str = ""


# zenoh-python has no 1.8.0, which rmw_zenoh 0.2.10 and 0.10.5 contain: 1.7.2 and 1.9.0
# are the versions around it.
DISTRIBUTIONS = [
    Distribution("humble", "0.1.8", "1.6.2"),
    Distribution("jazzy", "0.2.9", "1.6.2"),
    Distribution("jazzy", "0.2.10", "1.7.2"),
    Distribution("kilted", "0.6.6", "1.6.2"),
    Distribution("lyrical", "0.10.5", "1.9.0", "/backends:cpu:"),
    Distribution("rolling", "0.14.0", "1.10.1", "/backends:cpu:"),
]


def text_of(data: bytes) -> str:
    return base64.b64encode(data).decode()


def a_message(topic: str) -> Any:
    """Return a message of a topic with some data in each array."""
    message = get_message_class(KINDS[topic].name)()
    if topic == "chatter":
        message.data = "hello"
    elif topic == "marker":
        message.ns, message.points = (
            "n",
            [get_message_class("geometry_msgs/msg/Point")()],
        )
    else:
        message.header.frame_id = "map"
        message.data = list(range(100))
    return message


class Peer:
    """The process that plays a node of the distribution."""

    def __init__(self, of: Distribution, python: Path, router: str) -> None:
        self._of = of
        self._tokens = [f"@ros2_lv/{DOMAIN}/{ZID}/0/0/NN/%/%/peer"]
        publish, subscribe = [], []
        for topic, kind in KINDS.items():
            latched = topic == "map"
            qos = LATCHED_QOS if latched else QOS
            gid = self._endpoint("MP", f"from_peer/{topic}", kind, qos)
            self._endpoint("MS", f"to_peer/{topic}", kind, qos)
            publish.append(
                {
                    "key": self.key(f"from_peer/{topic}", kind),
                    "latched": latched,
                    "data": text_of(serialize(a_message(topic))),
                    "attachment": text_of(Attachment(1, 0, gid).encode()),
                }
            )
            key = self.key(f"to_peer/{topic}", kind)
            subscribe.append({"key": key, "latched": latched})
        self._endpoint("SS", "peers_add", ADD, SERVICE_QOS)
        client = self._endpoint("SC", "add", ADD, SERVICE_QOS)
        add = get_interface(ADD.name)
        order = {
            "router": router,
            "tokens": self._tokens,
            "publish": publish,
            "subscribe": subscribe,
            "serve": [
                {
                    "key": self.key("peers_add", ADD),
                    "data": text_of(serialize(add.Response(sum=5))),
                }
            ],
            "call": [
                {
                    "key": self.key("add", ADD),
                    "data": text_of(serialize(add.Request(a=4, b=3))),
                    "attachment": text_of(Attachment(1, 0, client).encode()),
                }
            ],
        }
        self.lines: list[list[str]] = []
        self._process = subprocess.Popen(
            [str(python), str(PROGRAM)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()
        self.command(json.dumps(order))

    def key(self, name: str, kind: Kind) -> str:
        return f"{DOMAIN}/{name}/{kind.dds}/{self._hash(kind)}"

    def _hash(self, kind: Kind) -> str:
        return NO_HASH if self._of.name == "humble" else kind.hash

    def _endpoint(self, entity: str, name: str, kind: Kind, qos: str) -> bytes:
        mangled = "%" + name.replace("/", "%")
        token = (
            f"@ros2_lv/{DOMAIN}/{ZID}/0/{len(self._tokens)}/{entity}/%/%/peer/"
            f"{mangled}/{kind.dds}/{self._hash(kind)}/{qos}"
            f"{self._of.backends if kind.has_octets else ''}"
        )
        self._tokens.append(token)
        return gid_of(token)

    def command(self, line: str) -> None:
        assert self._process.stdin is not None
        self._process.stdin.write(line + "\n")
        self._process.stdin.flush()

    def publish_until(self, condition: Callable[[], bool]) -> None:
        """Publish again and again: the peer may not have discovered everything yet."""

        def check() -> bool:
            self.command("publish")
            return condition()

        until(check, "the samples here")

    def got(self, what: str, key: str) -> bytes | None:
        """Return the payload of the newest line of that kind and key."""
        found = [line[2] for line in self.lines if line[:2] == [what, key]]
        return base64.b64decode(found[-1]) if found else None

    def close(self) -> None:
        self._process.kill()
        self._process.communicate()
        self._reader.join()

    def _read(self) -> None:
        assert self._process.stdout is not None
        self.lines.extend(line.split() for line in self._process.stdout)


def python_of(version: str) -> Path:
    """Return the interpreter of the environment with a version of Zenoh."""
    python = FOLDER / version / "bin" / "python"
    if not python.exists():
        text = f"Zenoh {version} is not installed: bash .ci/zenoh_versions"
        if os.environ.get("NAVETTE_REQUIRE_ALL"):
            pytest.fail(text)
        pytest.skip(text)
    return python


def until(condition: Any, what: str) -> None:
    watch, pause = Stopwatch(), threading.Event()
    while not condition():
        assert watch.elapsed_s < LIMIT_S, f"{what} was not reached"
        pause.wait(0.01)


@pytest.fixture
def here(request: pytest.FixtureRequest) -> Iterator[ZenohTransport]:
    settings = Settings(router=(free_endpoint(),))
    transport = ZenohTransport(DOMAIN, VirtualClock(5), settings)
    yield transport
    transport.close()


def endpoint(kind: EndpointKind, name: str, type_name: str) -> Endpoint:
    qos = LATCHED if name.endswith("map") else EndpointQos(depth=10)
    return Endpoint(kind, f"/{name}", type_name, qos, "here", "/", b"")


def decoded(item: Item) -> Any:
    return item[0].decode() if isinstance(item[0], Encoded) else item[0]


@pytest.mark.parametrize(
    "of", DISTRIBUTIONS, ids=lambda of: f"{of.name}-{of.rmw_zenoh}-zenoh-{of.zenoh}"
)
def test_a_node_of_the_distribution_exchanges_everything(
    of: Distribution, here: ZenohTransport, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(DISTRO_VARIABLE, of.name)
    python = python_of(of.zenoh)
    publishers = {}
    for topic, kind in KINDS.items():
        ours = endpoint(EndpointKind.PUBLISHER, f"to_peer/{topic}", kind.name)
        publishers[topic] = here.advertise(ours, get_message_class(kind.name))
    # The map is sent before the peer exists: it must come with the history.
    publishers["map"].send(a_message("map"), 0, 1)
    requests: list[Request] = []
    server = here.serve(
        endpoint(EndpointKind.SERVICE, "add", ADD.name), requests.append
    )
    replies: list[Reply] = []
    client = here.connect(
        endpoint(EndpointKind.CLIENT, "peers_add", ADD.name), replies.append
    )
    peer = Peer(of, python, here.session.settings.router[0])
    try:
        until(lambda: ["ready"] in peer.lines, "the peer")
        _check_topics(peer, here, publishers)
        _check_services(peer, client, replies, server, requests)
    finally:
        peer.close()


def _check_topics(peer: Peer, here: ZenohTransport, publishers: dict[str, Any]) -> None:
    items: dict[str, list[Item]] = {topic: [] for topic in KINDS}

    def subscribe(topic: str) -> Any:
        kind = KINDS[topic]
        ours = endpoint(EndpointKind.SUBSCRIPTION, f"from_peer/{topic}", kind.name)
        cls = get_message_class(kind.name)
        return here.subscribe(ours, cls, items[topic].append, shared=False)

    subscriptions = [subscribe(topic) for topic in KINDS if topic != "map"]
    until(lambda: all(s.matched_count == 1 for s in subscriptions), "their publishers")
    until(
        lambda: all(p.matched_count == 1 for p in publishers.values()),
        "their subscriptions",
    )
    for number, topic in enumerate(KINDS, 2):
        key = peer.key(f"to_peer/{topic}", KINDS[topic])
        if topic != "map":
            publishers[topic].send(a_message(topic), 0, number)
        until(lambda key=key: peer.got("sample", key) is not None, f"{topic} there")
        cls: Any = get_message_class(KINDS[topic].name)
        assert deserialize(peer.got("sample", key) or b"", cls) == a_message(topic)
    peer.publish_until(lambda: all(items[t] for t in KINDS if t != "map"))
    subscribe("map")  # late: the peer published before
    until(lambda: bool(items["map"]), "the latched map here")
    for topic, received in items.items():
        assert [decoded(item) for item in received] == [a_message(topic)]


def _check_services(
    peer: Peer, client: Any, replies: list[Reply], server: Any, requests: list[Request]
) -> None:
    add = get_interface(ADD.name)
    until(lambda: client.server_count == 1, "the peer's server")
    client.request(add.Request(a=2, b=3), 0, 1)
    until(lambda: bool(replies), "the reply here")
    assert replies[0].message == add.Response(sum=5)
    asked = peer.got("request", peer.key("peers_add", ADD))
    assert deserialize(asked or b"", add.Request) == add.Request(a=2, b=3)

    peer.command("call")
    until(lambda: bool(requests), "the request here")
    assert requests[0].message == add.Request(a=4, b=3)
    server.reply(requests[0].id, add.Response(sum=7))
    key = peer.key("add", ADD)
    until(lambda: peer.got("reply", key) is not None, "the reply there")
    assert deserialize(peer.got("reply", key) or b"", add.Response).sum == 7
