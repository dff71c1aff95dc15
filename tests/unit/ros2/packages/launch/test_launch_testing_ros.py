"""launch_testing_ros: waits for topics, republished messages, a spinning thread."""

from collections.abc import Iterator

import pytest

from free_ports import free_endpoint
from navette.msgs.std_msgs.msg import String
from navette.ros2.packages.launch_testing_ros import (
    DataRepublisher,
    MessagePump,
    WaitForTopics,
)
from navette.ros2.packages.launch_testing_ros.tools import basic_output_filter
from navette.runtime import Context, Node


@pytest.fixture(autouse=True)
def _network(monkeypatch: pytest.MonkeyPatch) -> None:
    # The waiting node has a context of its own: it meets the others on the network.
    monkeypatch.setenv("NAVETTE_TRANSPORT", "zenoh")
    monkeypatch.setenv("NAVETTE_ROUTER", free_endpoint())


@pytest.fixture
def node() -> Iterator[Node]:
    with Context() as context:
        yield Node("talker", context=context)


def test_messages_of_all_topics_are_awaited(node: Node) -> None:
    publisher = node.create_publisher(String, "chatter", 10)
    node.create_timer(0.02, lambda: publisher.publish(String(data="one")))
    DataRepublisher(
        node, "chatter", "upper", String, lambda m: String(data=m.data.upper())
    )
    pump = MessagePump(node, node.context)
    pump.start()
    with WaitForTopics([("chatter", String), ("upper", String)], 20.0) as topics:
        assert topics.topics_received() == {"chatter", "upper"}
        assert topics.topics_not_received() == set()
        assert topics.received_messages("upper")[0].data == "ONE"
        with pytest.raises(KeyError, match="other"):
            topics.received_messages("other")
    pump.stop()


def test_topics_without_messages_are_named() -> None:
    topics = WaitForTopics([("silence", String)], timeout=0.01)
    with pytest.raises(RuntimeError, match="on these topics: silence"), topics:
        pass


def test_lines_are_removed_by_their_start() -> None:
    remove = basic_output_filter(filtered_rmw_implementation="rmw_zenoh_cpp")
    assert remove("pid 3\nready\n") == "ready\n"
