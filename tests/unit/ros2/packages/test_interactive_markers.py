"""Interactive markers: what clients see, what callbacks receive."""

from collections.abc import Iterator
from typing import Any

import pytest

from navette.msgs.geometry_msgs.msg import Point, Pose
from navette.msgs.std_msgs.msg import Header
from navette.msgs.visualization_msgs.msg import (
    InteractiveMarker,
    InteractiveMarkerFeedback,
    InteractiveMarkerUpdate,
)
from navette.msgs.visualization_msgs.srv import GetInteractiveMarkers
from navette.ros2.packages.interactive_markers import (
    InteractiveMarkerServer,
    MenuHandler,
)
from navette.runtime import Node
from navette.runtime.testing import GraphHarness

AT_2 = Pose(position=Point(x=2.0))


@pytest.fixture
def graph() -> Iterator[GraphHarness]:
    with GraphHarness() as graph:
        yield graph


@pytest.fixture
def server(graph: GraphHarness) -> InteractiveMarkerServer:
    node = graph.add(Node("tool", context=graph.context))
    return InteractiveMarkerServer(node, "tool")


def arrow(name: str = "arrow") -> InteractiveMarker:
    return InteractiveMarker(header=Header(frame_id="odom"), name=name)


def feedback(kind: int, client: str = "rviz", **fields: Any) -> Any:
    fields.setdefault("marker_name", "arrow")
    return InteractiveMarkerFeedback(event_type=kind, client_id=client, **fields)


def test_changes_are_published_together(
    graph: GraphHarness, server: InteractiveMarkerServer
) -> None:
    updates = graph.collect("/tool/update", InteractiveMarkerUpdate)
    server.insert(arrow())
    server.insert(arrow("ring"))
    graph.run_for(0.1)
    assert updates.count == 0
    server.applyChanges()
    server.applyChanges()
    assert server.setPose("arrow", AT_2)
    assert server.erase("ring")
    server.applyChanges()
    graph.run_for(0.1)
    first, second = updates.messages
    assert ([m.name for m in first.markers], first.seq_num) == (["arrow", "ring"], 1)
    moved = second.poses[0]
    assert (moved.name, moved.header.frame_id, moved.pose) == ("arrow", "odom", AT_2)
    assert (second.erases, second.seq_num) == (["ring"], 2)


def test_a_new_client_gets_all_markers(
    graph: GraphHarness, server: InteractiveMarkerServer
) -> None:
    server.insert(arrow())
    server.applyChanges()
    request = GetInteractiveMarkers.Request()
    response = graph.call(
        GetInteractiveMarkers, "/tool/get_interactive_markers", request
    )
    assert [marker.name for marker in response.markers] == ["arrow"]
    assert response.sequence_number == 1


def test_feedback_moves_the_marker_and_calls_back(
    graph: GraphHarness, server: InteractiveMarkerServer
) -> None:
    moves: list[Any] = []
    others: list[Any] = []
    server.insert(arrow(), feedback_callback=others.append)
    server.setCallback("arrow", moves.append, InteractiveMarkerFeedback.POSE_UPDATE)
    server.applyChanges()
    move = feedback(InteractiveMarkerFeedback.POSE_UPDATE, pose=AT_2)
    graph.publish("/tool/feedback", move)
    graph.run_for(0.1)
    graph.publish("/tool/feedback", feedback(InteractiveMarkerFeedback.MOUSE_UP))
    graph.run_for(0.1)
    assert (len(moves), len(others)) == (1, 1)
    marker = server.get("arrow")
    assert marker is not None
    assert marker.pose == AT_2


def test_one_client_moves_a_marker_at_a_time(
    graph: GraphHarness, server: InteractiveMarkerServer
) -> None:
    server.insert(arrow())
    server.applyChanges()
    seen: list[str] = []
    server.setCallback("arrow", lambda each: seen.append(each.client_id))
    for client, pause_s in (("a", 0.5), ("b", 1.1), ("b", 0.1)):
        graph.publish("/tool/feedback", feedback(5, client))
        graph.run_for(pause_s)
    assert seen == ["a", "b"]


def test_unknown_markers() -> None:
    with GraphHarness() as graph:
        node = graph.add(Node("tool", context=graph.context))
        server = InteractiveMarkerServer(node, "tool")
        assert not server.setPose("arrow", AT_2)
        assert not server.erase("arrow")
        assert not server.setCallback("arrow", print)
        assert server.get("arrow") is None
        server.shutdown()
        server.shutdown()


def test_a_menu_has_titles_and_callbacks(
    graph: GraphHarness, server: InteractiveMarkerServer
) -> None:
    chosen: list[str] = []
    menu = MenuHandler()
    speed = menu.insert("speed")
    assert speed is not None
    fast = menu.insert("fast", parent=speed, callback=lambda _: chosen.append("fast"))
    hidden = menu.insert("hidden")
    assert fast is not None
    assert hidden is not None
    assert menu.insert("lost", parent=99) is None
    assert menu.setCheckState(fast, MenuHandler.CHECKED)
    assert menu.setVisible(hidden, False)
    assert (menu.getTitle(fast), menu.getCheckState(fast)) == ("fast", 1)
    assert not menu.apply(server, "arrow")
    server.insert(arrow())
    assert menu.apply(server, "arrow")
    server.applyChanges()
    marker = server.get("arrow")
    assert marker is not None
    entries = [(e.title, e.id, e.parent_id) for e in marker.menu_entries]
    assert entries == [("speed", speed, 0), ("[x] fast", fast, speed)]
    select = feedback(InteractiveMarkerFeedback.MENU_SELECT, menu_entry_id=fast)
    graph.publish("/tool/feedback", select)
    graph.run_for(0.1)
    assert chosen == ["fast"]
    assert menu.setCheckState(fast, MenuHandler.UNCHECKED)
    assert menu.reApply(server)
    marker = server.get("arrow")
    assert marker is not None
    assert marker.menu_entries[1].title == "[ ] fast"
