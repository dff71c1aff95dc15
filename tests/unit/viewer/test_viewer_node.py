"""The live view end to end, on a real socket, with a protocol client."""

import json
import threading
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from viewer_harness import PATIENCE_S, Client, NonReadingClient, Program
from websockets.exceptions import ConnectionClosed, InvalidStatus

from navette.errors import InvalidValueError
from navette.msgs import deserialize, serialize
from navette.msgs.geometry_msgs.msg import Point, PointStamped
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.msgs.rcl_interfaces.msg import ParameterEvent
from navette.msgs.sensor_msgs.msg import Image
from navette.msgs.std_msgs.msg import Header, String
from navette.runtime import Context, Node, Parameter, Stopwatch, VirtualClock
from navette.runtime.qos import QoSDurabilityPolicy, QoSProfile
from navette.viewer.node import ViewerNode

LATCHED = QoSProfile(depth=1, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)


class Talker(Node):
    """Publishes a chatter, a latched map and a camera; receives goals."""

    def __init__(self, context: Context) -> None:
        super().__init__("talker", context=context)
        self.declare_parameter("speed_mps", 1.0)
        self.declare_parameter("names", ["a", "b"])
        self.declare_parameter("depth", 3)
        self.goals: list[PointStamped] = []
        self.got_goal = threading.Event()
        self.chatter = self.create_publisher(String, "/chatter", 10)
        self.map = self.create_publisher(OccupancyGrid, "/map", LATCHED)
        self.camera = self.create_publisher(Image, "/camera", 10)
        self.create_subscription(PointStamped, "/goal_point", self.on_goal, 10)
        self.map.publish(OccupancyGrid(data=np.array([7, -1], np.int8)))
        self.create_timer(0.01, self.on_timer)

    def on_timer(self) -> None:
        self.chatter.publish(String(data="hello"))

    def on_goal(self, goal: PointStamped) -> None:
        self.goals.append(goal)
        self.got_goal.set()


@pytest.fixture
def program() -> Iterator[Program]:
    with Program(Talker) as running:
        yield running


@pytest.fixture
def talker(program: Program) -> Talker:
    node = program.nodes[0]
    assert isinstance(node, Talker)
    return node


@pytest.fixture
def client(program: Program) -> Iterator[Client]:
    with Client(program.address) as connected:
        yield connected


@pytest.mark.parametrize("name", ["foxglove.sdk.v1", "foxglove.websocket.v1"])
def test_both_subprotocols_are_accepted(program: Program, name: str) -> None:
    with Client(program.address, name) as client:
        assert client.socket.subprotocol == name
        assert client.info["metadata"]["ROS_DISTRO"] == "jazzy"


def test_messages_arrive_with_stamp_and_definition(client: Client) -> None:
    channel = client.subscribe("/chatter", 7)
    assert channel["schemaName"] == "std_msgs/msg/String"
    assert channel["schemaEncoding"] == "ros2msg"
    assert channel["schema"].strip() == "string data"
    stamp, payload = client.message(7)
    assert stamp > 10**18
    assert deserialize(payload, String).data == "hello"


def test_every_new_client_receives_the_latched_map(program: Program) -> None:
    for _ in range(3):
        with Client(program.address) as client:
            client.subscribe("/map", 1)
            _, payload = client.message(1)
            assert deserialize(payload, OccupancyGrid).data.tolist() == [7, -1]


def test_a_camera_without_clients_has_no_subscriber(
    program: Program, client: Client, talker: Talker
) -> None:
    def watchers() -> int:
        return program.do(talker.camera.get_subscription_count)

    client.wait_for_topic("/camera")
    client.subscribe("/chatter", 1)
    client.get_parameters()
    assert watchers() == 0
    client.subscribe("/camera", 2)
    client.get_parameters()
    assert watchers() == 1
    client.send(op="unsubscribe", subscriptionIds=[2])
    client.get_parameters()
    assert watchers() == 0


def test_a_disconnected_client_leaves_no_subscription(
    program: Program, talker: Talker
) -> None:
    client = Client(program.address)
    client.subscribe("/camera", 2)
    client.advertise(1, "/goal_point", "json", "geometry_msgs/msg/PointStamped")
    client.get_parameters()
    client.socket.socket.close()
    with Client(program.address) as other:
        while program.viewer.client_count > 1:
            other.get_parameters()
        other.get_parameters()
        assert program.do(talker.camera.get_subscription_count) == 0
        assert program.do(lambda: talker.count_publishers("/goal_point")) == 0


@pytest.mark.parametrize(
    "type_name", ["geometry_msgs/msg/PointStamped", "PointStamped"]
)
def test_goals_are_received_as_json(
    client: Client, talker: Talker, type_name: str
) -> None:
    name = type_name if "/" in type_name else f"geometry_msgs/{type_name}"
    client.advertise(3, "/goal_point", "json", name)
    goal = {
        "header": {"stamp": {"sec": 1, "nsec": 2}, "frame_id": "map"},
        "point": {"x": 6, "y": -12.5},
    }
    client.publish(3, json.dumps(goal).encode())
    assert talker.got_goal.wait(PATIENCE_S)
    (got,) = talker.goals
    assert (got.point.x, got.point.y, got.header.frame_id) == (6.0, -12.5, "map")
    assert got.header.stamp.nanosec == 2


def test_goals_are_received_as_cdr(client: Client, talker: Talker) -> None:
    goal = PointStamped(header=Header(frame_id="map"), point=Point(x=1.0, y=2.0))
    client.advertise(3, "/goal_point", "cdr", "geometry_msgs/msg/PointStamped")
    client.publish(3, serialize(goal))
    assert talker.got_goal.wait(PATIENCE_S)
    assert talker.goals == [goal]


@pytest.mark.parametrize(
    ("encoding", "type_name", "topic", "data", "complaint"),
    [
        ("json", "geometry_msgs/msg/PointStamped", "/goal_point", b"{", "not JSON"),
        ("json", "geometry_msgs/msg/PointStamped", "/goal_point", b"[]", "object"),
        (
            "json",
            "geometry_msgs/msg/PointStamped",
            "/goal_point",
            b'{"poind": 1}',
            "poind",
        ),
        (
            "json",
            "geometry_msgs/msg/PointStamped",
            "/goal_point",
            b'{"point": {"x": "far"}}',
            "x",
        ),
        ("cdr", "geometry_msgs/msg/PointStamped", "/goal_point", b"\0\1\0\0", ""),
        ("cdr", "geometry_msgs/msg/Nothing", "/goal_point", b"", "Nothing"),
        ("cdr", "std_msgs/msg/String", "/goal_point", b"", "has the type"),
        ("cdr", "std_msgs/msg/String", "no good", b"", "no good"),
        ("protobuf", "std_msgs/msg/String", "/x", b"", "known: cdr, json"),
    ],
)
def test_a_publish_error_is_reported_to_its_client(
    client: Client,
    talker: Talker,
    encoding: str,
    type_name: str,
    topic: str,
    data: bytes,
    complaint: str,
) -> None:
    client.advertise(1, topic, encoding, type_name)
    if data:
        client.publish(1, data)
    status = client.wait_for_op("status")
    assert status["level"] == 2
    assert complaint in status["message"]
    assert client.get_parameters("/talker.depth") == {"/talker.depth": 3}
    assert talker.goals == []


def test_parameters_of_all_nodes_are_listed(client: Client) -> None:
    values = client.get_parameters()
    assert values["/talker.speed_mps"] == 1.0
    assert values["/talker.names"] == ["a", "b"]
    assert values["/viewer.port"] == 0
    assert client.get_parameters("talker.depth", "/absent.x") == {"/talker.depth": 3}


def test_parameters_are_set_and_reported_to_subscribers(
    program: Program, client: Client
) -> None:
    with Client(program.address) as watcher:
        watcher.send(op="subscribeParameterUpdates", parameterNames=[])
        watcher.get_parameters()
        # An integer, as JavaScript writes 2.0.
        wire = {"name": "/talker.speed_mps", "value": 2}
        client.send(op="setParameters", parameters=[wire], id="set")
        answer = client.wait_for_op("parameterValues")
        assert answer["id"] == "set"
        assert answer["parameters"] == [
            {"name": "/talker.speed_mps", "value": 2.0, "type": "float64"}
        ]
        update = watcher.wait_for_op("parameterValues")
        assert update["parameters"] == answer["parameters"]
        assert "id" not in update


@pytest.mark.parametrize(
    ("name", "value", "complaint"),
    [
        ("/talker.depth", "deep", "depth"),
        ("/talker.nothing", 1, "no node has this parameter"),
        ("/viewer.port", 80, "can be set at the start only"),
        ("depth", 1, "the name must be /node.parameter"),
        ("/talker.names", [1, "a"], "names"),
        ("/talker.names", {"a": 1}, "not a ROS 2 parameter type"),
    ],
)
def test_parameters_that_cannot_be_set_are_named(
    client: Client, name: str, value: object, complaint: str
) -> None:
    client.send(op="setParameters", parameters=[{"name": name, "value": value}])
    assert complaint in client.wait_for_op("status")["message"]
    assert client.get_parameters("/talker.depth") == {"/talker.depth": 3}


def test_the_graph_names_nodes(program: Program, client: Client) -> None:
    client.send(op="subscribeConnectionGraph")
    update = client.wait_for_op("connectionGraphUpdate")
    published = {t["name"]: t["publisherIds"] for t in update["publishedTopics"]}
    assert published["/chatter"] == ["/talker"]
    subscribed = {t["name"]: t["subscriberIds"] for t in update["subscribedTopics"]}
    assert subscribed["/goal_point"] == ["/talker"]


def test_topics_that_appear_late_are_advertised_and_withdrawn(
    program: Program, client: Client, talker: Talker
) -> None:
    late = program.do(lambda: talker.create_publisher(String, "/late", 10))
    client.subscribe("/late", 5)
    client.get_parameters()
    program.do(lambda: late.publish(String(data="here")))
    assert deserialize(client.message(5)[1], String).data == "here"
    program.do(late.destroy)
    while "/late" in client.channels:
        client.receive()
    client.get_parameters()  # behind the end of the subscription
    assert "/late" not in dict(program.do(talker.get_topic_names_and_types))


def test_clients_receive_the_time(client: Client) -> None:
    first = client.wait_for(lambda f: isinstance(f, tuple) and f[0] == 2)
    second = client.wait_for(lambda f: isinstance(f, tuple) and f[0] == 2)
    assert second[1] > first[1]


@pytest.mark.parametrize(
    "frame",
    ["{", "[]", '{"op": "dance"}', '{"op": 1}', "[" * 50_000, b"", b"\x07", b"\x01"],
)
def test_hostile_frames_do_not_affect_other_clients(
    program: Program, client: Client, frame: str | bytes
) -> None:
    with Client(program.address) as other:
        client.socket.send(frame)
        assert client.wait_for_op("status")["level"] == 2
        assert client.get_parameters("/talker.depth") == {"/talker.depth": 3}
        assert other.get_parameters("/talker.depth") == {"/talker.depth": 3}
        assert other.statuses == []


def test_a_huge_frame_ends_its_own_connection_only(
    program: Program, client: Client
) -> None:
    with Client(program.address) as other:
        with suppress(ConnectionClosed):
            client.socket.send(b"\x01" * (17 * 2**20))
        client.read_to_the_end()
        assert other.get_parameters("/talker.depth") == {"/talker.depth": 3}


def test_a_client_that_never_reads_loses_frames_and_does_not_slow_the_robot(
    program: Program, talker: Talker
) -> None:
    with Client(program.address) as slow, Client(program.address) as other:
        slow.subscribe("/camera", 1)
        slow.get_parameters()
        frames = 60

        def send_all() -> None:
            for number in range(frames):
                data = np.zeros(3_000_000, np.uint8)
                talker.camera.publish(Image(height=number, data=data))

        program.do(send_all)
        assert other.get_parameters("/talker.depth") == {"/talker.depth": 3}
        got = []
        while not got or got[-1] != frames - 1:
            got.append(deserialize(slow.message(1)[1], Image).height)
        assert len(got) < frames
        assert got == sorted(got)


def test_no_camera_is_rendered_for_a_client_that_never_reads(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("navette.viewer.peer._STALL_S", 0.1)
    image = Image(data=np.zeros(3_000_000, np.uint8))
    with Program(Talker) as program, NonReadingClient(program.address) as deaf:
        talker = program.nodes[0]
        assert isinstance(talker, Talker)
        with Client(program.address) as client:
            camera = client.wait_for_topic("/camera")["id"]
        deaf.send(op="subscribe", subscriptions=[{"id": 1, "channelId": camera}])
        while not program.do(talker.camera.get_subscription_count):
            pass
        while program.do(talker.camera.get_subscription_count):
            program.do(lambda: talker.camera.publish(image))


def test_a_client_that_requests_and_never_reads_affects_no_other(
    tmp_path: Path,
) -> None:
    (tmp_path / "large").write_bytes(bytes(20_000_000))
    with (
        Program(Talker, asset_folders={"navette": tmp_path}) as program,
        Client(program.address) as other,
        NonReadingClient(program.address) as deaf,
    ):
        for request in range(6):
            deaf.send(op="fetchAsset", uri="package://navette/large", requestId=request)
        for _ in range(20):
            assert other.get_parameters("/talker.depth") == {"/talker.depth": 3}


def test_closing_does_not_wait_for_a_client_that_never_reads(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("navette.viewer.server._CLOSE_S", 0.05)
    stopwatch = Stopwatch()
    with Program(Talker) as program, NonReadingClient(program.address) as deaf:
        talker = program.nodes[0]
        assert isinstance(talker, Talker)
        image = Image(data=np.zeros(3_000_000, np.uint8))
        with Client(program.address) as client:
            camera = client.wait_for_topic("/camera")["id"]
        deaf.send(op="subscribe", subscriptions=[{"id": 1, "channelId": camera}])
        while not program.do(talker.camera.get_subscription_count):
            pass
        program.do(lambda: [talker.camera.publish(image) for _ in range(5)])
        program.close()
    assert stopwatch.elapsed_s < 5.0


def test_closing_does_not_wait_for_answers_that_never_come(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A client keeps asking when the executor has stopped already."""
    monkeypatch.setattr("navette.viewer.server._CLOSE_S", 0.05)
    with Program(Talker) as program, Client(program.address) as client:
        program.stop()
        for _ in range(200):
            client.send(op="getParameters", parameterNames=[])
        client.send(op="nonsense")
        for _ in range(2):
            client.wait_for(lambda f: isinstance(f, tuple) and f[0] == 2)
        program.close()
        # Queued behind the unanswered requests.
        client.read_to_the_end()
        assert client.statuses == []


def get(program: Program, path: str, **headers: str) -> tuple[int, str, bytes]:
    request = urllib.request.Request(f"http://{program.address}{path}", headers=headers)
    try:
        with urllib.request.urlopen(request, timeout=PATIENCE_S) as response:
            kind = response.headers["Content-Type"]
            return response.status, kind, response.read()
    except urllib.error.HTTPError as error:
        with error:
            return error.code, error.headers["Content-Type"], error.read()


def test_the_same_port_serves_http(program: Program) -> None:
    status, kind, page = get(program, "/")
    assert (status, kind) == (200, "text/html; charset=utf-8")
    assert page.rstrip().endswith(b"</html>")
    assert json.loads(get(program, "/layout.json")[2])["configById"]
    health = json.loads(get(program, "/health")[2])
    assert health["status"] == "ok"
    assert health["topics"] > 3
    assert get(program, "/nothing")[0] == 404
    assert get(program, "/", Host="evil.example")[0] == 403


def test_the_layout_shows_the_frames_of_the_running_nodes() -> None:
    def planner(context: Context) -> Node:
        node = Node("planner", context=context)
        node.declare_parameter("map_frame", "sim_world")
        return node

    with Program(planner) as program, Client(program.address) as client:
        client.get_parameters()
        layout = json.loads(get(program, "/layout.json")[2])
        assert layout["configById"]["3D!drive"]["followTf"] == "sim_world"
        assert layout["configById"]["3D!follow"]["followTf"] == "base_link"


def test_pages_of_other_origins_cannot_open_the_socket(program: Program) -> None:
    with pytest.raises(InvalidStatus, match="403"):
        Client(program.address, origin="https://evil.example")
    with Client(program.address, origin="https://app.foxglove.dev"):
        pass
    with Client(program.address, origin=f"http://{program.address}"):
        pass


def test_parameters_that_no_message_holds_are_refused(
    program: Program, client: Client
) -> None:
    for value in (2**64, [2**64], "\ud800", {"a": 1}, [[1]], [1, "a"]):
        parameter = {"name": "/talker.depth", "value": value}
        client.send(op="setParameters", parameters=[parameter])
        reason = client.wait_for_op("status")["message"]
        assert reason.startswith("parameter '/talker.depth': ")
    parameter = {"name": "/talker.names", "value": ["\ud800"]}
    client.send(op="setParameters", parameters=[parameter])
    assert "not valid Unicode" in client.wait_for_op("status")["message"]
    assert client.get_parameters("/talker.depth") == {"/talker.depth": 3}


def test_an_unknown_subprotocol_is_refused(program: Program) -> None:
    with pytest.raises(InvalidStatus, match="400"):
        Client(program.address, "foxglove.websocket.v9")


def test_clients_beyond_the_limit_are_refused() -> None:
    with (
        Program(Talker, max_clients=1) as program,
        Client(program.address),
        pytest.raises(InvalidStatus, match="503"),
    ):
        Client(program.address)


def test_assets_come_from_known_folders_only(tmp_path: Path) -> None:
    (tmp_path / "arena.urdf").write_text("<robot/>")
    context = Context(clock=VirtualClock())
    viewer = ViewerNode(
        context=context,
        asset_folders={"navette": tmp_path},
        parameter_overrides=[Parameter("port", value=0)],
    )
    with Client(f"127.0.0.1:{viewer.port}") as client:
        client.send(op="fetchAsset", uri="package://navette/arena.urdf", requestId=1)
        client.send(op="fetchAsset", uri="file:///etc/passwd", requestId=2)
        found, refused = (
            client.wait_for(lambda f: isinstance(f, tuple) and f[0] == 4)
            for _ in range(2)
        )
        assert found == (4, 1, 0, b"", b"<robot/>")
        assert refused[:3] == (4, 2, 1)
    viewer.close()
    context.shutdown()


def test_a_port_in_use_is_named_and_leaves_no_node(program: Program) -> None:
    port = program.viewer.port
    with Context(clock=VirtualClock()) as context:
        with pytest.raises(
            InvalidValueError, match=rf"port {port}: the port is in use"
        ):
            ViewerNode(
                context=context, parameter_overrides=[Parameter("port", value=port)]
            )
        assert context.nodes == []
    # The one that has the port is not bothered.
    with Client(program.address):
        pass


def test_closing_disconnects_clients_and_ends_the_thread() -> None:
    with Program(Talker) as program:
        client = Client(program.address)
        assert program.viewer.url == f"http://{program.address}"
        assert "navette-viewer" in thread_names()
    client.read_to_the_end()
    client.close()
    assert "navette-viewer" not in thread_names()
    program.viewer.close()


def thread_names() -> set[str]:
    return {thread.name for thread in threading.enumerate()}


def test_parameters_of_other_processes_come_from_events() -> None:
    """The node belongs to another process or to a recording."""

    def teller(context: Context) -> Node:
        node = Node("teller", context=context)
        publisher = node.create_publisher(ParameterEvent, "/parameter_events", 10)
        value = Parameter("gain", value=1.5).to_parameter_msg()
        event = ParameterEvent(node="/elsewhere", new_parameters=[value])
        node.create_timer(0.01, lambda: publisher.publish(event))
        return node

    with Program(teller) as program, Client(program.address) as client:
        client.send(op="subscribeParameterUpdates", parameterNames=["/elsewhere.gain"])
        reported = client.wait_for_op("parameterValues")["parameters"]
        assert [(p["name"], p["value"]) for p in reported] == [("/elsewhere.gain", 1.5)]
        assert client.get_parameters("/elsewhere.gain") == {"/elsewhere.gain": 1.5}
