"""Graph queries of a node and graph callbacks."""

import pytest

from navette.errors import UnknownNameError
from navette.msgs.std_msgs.msg import Float64, String
from navette.msgs.std_srvs.srv import SetBool
from navette.runtime import Context, Node, QoSProfile, ReliabilityPolicy, VirtualClock
from navette.runtime.topic_endpoint_info import (
    EndpointTypeEnum,
    ServiceEndpointInfo,
    TopicEndpointInfo,
    TopicEndpointTypeEnum,
)
from navette.transports import EndpointKind


@pytest.fixture
def context() -> Context:
    return Context(clock=VirtualClock())


def make(context: Context, name: str, namespace: str = "") -> Node:
    return Node(name, context=context, namespace=namespace, enable_rosout=False)


def test_nodes(context: Context) -> None:
    a, b = make(context, "a"), make(context, "b", "/ns")
    assert a.get_node_names() == ["a", "b"]
    assert a.get_fully_qualified_node_names() == ["/a", "/ns/b"]
    assert a.get_node_names_and_namespaces() == [("a", "/"), ("b", "/ns")]
    assert a.get_node_names_and_namespaces_with_enclaves()[1] == ("b", "/ns", "/")
    b.destroy_node()
    assert a.get_node_names() == ["a"]
    assert a.wait_for_node("/a", 0.0)
    assert not a.wait_for_node("b", 1.0)


def test_topics_and_counts(context: Context) -> None:
    a, b = make(context, "a"), make(context, "b", "/ns")
    a.create_publisher(String, "/chatter", 10)
    b.create_subscription(String, "/chatter", lambda m: None, 10)
    b.create_publisher(Float64, "x", 10)
    topics = dict(a.get_topic_names_and_types())
    assert topics["/chatter"] == ["std_msgs/msg/String"]
    assert topics["/ns/x"] == ["std_msgs/msg/Float64"]
    assert (a.count_publishers("chatter"), a.count_subscribers("chatter")) == (1, 1)
    assert b.count_publishers("x") == 1
    assert a.count_publishers("nothing") == 0
    mine = dict(a.get_publisher_names_and_types_by_node("b", "/ns"))
    assert "/ns/x" in mine
    assert "/chatter" not in mine
    received = a.get_subscriber_names_and_types_by_node("b", "ns")
    assert ("/chatter", ["std_msgs/msg/String"]) in received
    with pytest.raises(UnknownNameError, match=r"node '/c'; known: /a, /ns/b"):
        a.get_publisher_names_and_types_by_node("c", "/")


def test_endpoint_infos(context: Context) -> None:
    a = make(context, "a", "/ns")
    qos = QoSProfile(depth=7, reliability=ReliabilityPolicy.BEST_EFFORT)
    a.create_publisher(String, "/t", qos)
    a.create_subscription(String, "/t", lambda m: None, 3)
    (info,) = a.get_publishers_info_by_topic("/t")
    assert (info.node_name, info.node_namespace) == ("a", "/ns")
    assert (info.topic_type, info.endpoint_type) == (
        "std_msgs/msg/String",
        TopicEndpointTypeEnum.PUBLISHER,
    )
    assert info.qos_profile.depth == 7
    assert info.qos_profile.reliability == ReliabilityPolicy.BEST_EFFORT
    assert "node_name='a', node_namespace='/ns'" in repr(info)
    assert str(info.topic_type_hash).startswith("RIHS01_")
    assert info.topic_type_hash.version == 1
    assert len(info.topic_type_hash.value) == 32
    assert "Topic type hash: RIHS01_" in str(info)
    assert "History (Depth): KEEP_LAST (7)" in str(info)
    assert [info] == a.get_publishers_info_by_topic("/t")
    (info,) = a.get_subscriptions_info_by_topic("/t")
    assert info.qos_profile.depth == 3
    assert len(info.endpoint_gid) == 16


def test_infos_of_services(context: Context) -> None:
    a = make(context, "a", "/ns")
    qos = QoSProfile(depth=7)
    a.create_service(SetBool, "go", lambda request, response: response, qos_profile=qos)
    a.create_client(SetBool, "go")
    (server,) = a.get_servers_info_by_service("go")
    (client,) = a.get_clients_info_by_service("/ns/go")
    assert (server.node_name, server.node_namespace) == ("a", "/ns")
    assert server.service_type == client.service_type == "std_srvs/srv/SetBool"
    assert server.service_type_hash.version == 1
    assert server.endpoint_type is EndpointTypeEnum.SERVER
    assert client.endpoint_type is EndpointTypeEnum.CLIENT
    assert (server.endpoint_count, server.qos_profiles[0].depth) == (1, 7)
    assert "Endpoint type: SERVER\nEndpoint count: 1\nGID: 00." in str(server)
    assert a.get_servers_info_by_service("stop") == []


def test_infos_can_be_constructed() -> None:
    assert TopicEndpointInfo(node_name="a").endpoint_type is EndpointTypeEnum.INVALID
    assert "Topic type hash: INVALID" in str(TopicEndpointInfo())
    assert ServiceEndpointInfo(endpoint_count=2) != ServiceEndpointInfo()


def test_change_callback(context: Context) -> None:
    changes: list[list[str]] = []
    graph = context.graph
    undo = graph.on_change(
        lambda: changes.append([t for t in graph.topics() if t == "/t"])
    )
    node = make(context, "a")
    before = len(changes)
    assert before > 0
    publisher = node.create_publisher(String, "/t", 1)
    assert changes[-1] == ["/t"]
    node.destroy_publisher(publisher)
    assert changes[-1] == []
    assert len(changes) == before + 2
    undo()
    node.destroy_node()
    assert len(changes) == before + 2


def test_ids_are_the_same_in_every_run() -> None:
    def ids() -> list[bytes]:
        context = Context(clock=VirtualClock())
        node = make(context, "a")
        node.create_publisher(String, "t", 1)
        return [endpoint.gid for endpoint in context.graph.endpoints()]

    assert ids() == ids()


def test_endpoints_are_filtered(context: Context) -> None:
    a, b = make(context, "a"), make(context, "b")
    for node in (a, b):
        node.create_publisher(String, "t", 1)
    assert len(context.graph.endpoints("/t")) == 2
    assert len(context.graph.endpoints("/t", node="/a")) == 1
    assert context.graph.endpoints("/t", kind=EndpointKind.SUBSCRIPTION) == []
