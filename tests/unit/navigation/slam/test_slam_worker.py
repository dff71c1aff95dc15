"""The node ``slam`` while its worker searches the whole map, with the system clock."""

import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from test_slam_node import STEPS, feed, publish_step, start

from navette.geometry import Pose2
from navette.msgs.geometry_msgs.msg import PoseWithCovarianceStamped
from navette.msgs.slam_toolbox.srv import SerializePoseGraph
from navette.navigation.slam import relocation
from navette.runtime.clock import SystemClock
from navette.runtime.stage.path_messages import pose_of
from navette.runtime.testing import GraphHarness
from slam_office import Step

WAIT_S = 30.0


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a map that the node wrote."""
    path = tmp_path_factory.mktemp("maps") / "office.slam"
    with GraphHarness() as graph:
        start(graph, start_x_m=1.5, start_y_m=1.5)
        feed(graph, STEPS)
        request = SerializePoseGraph.Request(filename=str(path))
        graph.call(SerializePoseGraph, "slam_toolbox/serialize_map", request)
    return path


@pytest.fixture
def graph() -> Iterator[GraphHarness]:
    with GraphHarness(clock=SystemClock()) as harness:
        yield harness


class LongSearch:
    """The first search of the map takes until ``meanwhile`` has run in the loop."""

    def __init__(
        self,
        graph: GraphHarness,
        monkeypatch: pytest.MonkeyPatch,
        meanwhile: Callable[[], object] = lambda: None,
    ) -> None:
        self.searches = 0
        self.held_the_loop = False
        usual = relocation.locate

        def locate(*args: Any) -> Any:
            self.searches += 1
            if self.searches == 1:
                ran = threading.Event()

                def run() -> None:
                    meanwhile()
                    ran.set()

                graph.context.loop.call_soon_threadsafe(run)
                self.held_the_loop = not ran.wait(WAIT_S)
            return usual(*args)

        monkeypatch.setattr("navette.navigation.slam.place_search.locate", locate)


def wait_for(graph: GraphHarness, value: Callable[[], int], wanted: int) -> None:
    assert graph.run_until(lambda: value() == wanted)


def locate_at_each(graph: GraphHarness, steps: list[Step]) -> Pose2:
    """Return the pose of the last step; each waits for that of the one before."""
    found = graph.collect("/pose", PoseWithCovarianceStamped)
    for count, step in enumerate(steps, 1):
        publish_step(graph, step)
        wait_for(graph, lambda: found.count, count)
    return pose_of(found.last.pose.pose)


def test_other_callbacks_run_while_a_lost_robot_is_searched_for(
    graph: GraphHarness, monkeypatch: pytest.MonkeyPatch, saved: Path
) -> None:
    search = LongSearch(graph, monkeypatch)
    start(graph, known_map=str(saved), searches_start=True)
    last = locate_at_each(graph, STEPS[30:40])
    assert search.searches
    assert not search.held_the_loop
    assert last.distance_to(STEPS[39].truth) < 0.1


def test_a_map_that_begins_meanwhile_drops_the_search(
    graph: GraphHarness, monkeypatch: pytest.MonkeyPatch, saved: Path
) -> None:
    node = start(graph, known_map=str(saved), searches_start=True)
    dropped = graph.collect("/pose", PoseWithCovarianceStamped)
    search = LongSearch(graph, monkeypatch, meanwhile=node.restart)
    publish_step(graph, STEPS[30])
    wait_for(graph, lambda: search.searches, 1)
    wait_for(graph, lambda: node._matcher.is_busy, False)
    assert not search.held_the_loop
    locate_at_each(graph, STEPS[31:36])
    assert dropped.count == 5
    assert search.searches > 1
