"""Services of slam_toolbox on the node ``slam``: save, continue, localize, pause."""

from pathlib import Path
from typing import Any

import pytest
from test_slam_node import STEPS, feed, start

from navette.geometry import Pose2
from navette.geometry.map_files import read_occupancy_map
from navette.msgs.geometry_msgs.msg import Pose2D, PoseWithCovarianceStamped
from navette.msgs.nav_msgs.srv import GetMap
from navette.msgs.slam_toolbox.srv import (
    DeserializePoseGraph,
    Pause,
    Reset,
    SaveMap,
    SerializePoseGraph,
)
from navette.msgs.std_msgs.msg import String
from navette.navigation.slam.node import SlamNode
from navette.runtime.stage.path_messages import pose_of
from navette.runtime.testing import GraphHarness, Probe
from slam_office import Step

AT = {"start_x_m": 1.5, "start_y_m": 1.5}


def call(graph: GraphHarness, kind: Any, service: str, **fields: Any) -> Any:
    return graph.call(kind, f"slam_toolbox/{service}", kind.Request(**fields))


def last_pose(found: Probe) -> Pose2:
    return pose_of(found.last.pose.pose)


def size_of(node: SlamNode) -> int:
    return len(node._slam.graph)


def later(steps: list[Step], after: list[Step]) -> list[Step]:
    """Return steps with the stamps that follow others."""
    begin = after[-1].stamp_ns - steps[0].stamp_ns + 200_000_000
    return [step._replace(stamp_ns=step.stamp_ns + begin) for step in steps]


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the name of a map that was saved by the service."""
    stem = tmp_path_factory.mktemp("maps") / "office.v2"
    with GraphHarness() as graph:
        start(graph, **AT)
        feed(graph, STEPS)
        answer = call(graph, SerializePoseGraph, "serialize_map", filename=str(stem))
        assert answer.result == SerializePoseGraph.Response.RESULT_SUCCESS
    assert stem.with_name("office.v2.slam").exists()
    return stem


def test_a_map_is_continued_at_a_given_pose_and_at_its_first_scan(saved: Path) -> None:
    kinds = DeserializePoseGraph.Request
    for match_type, steps in (
        (kinds.START_AT_GIVEN_POSE, STEPS[40:]),
        (kinds.START_AT_FIRST_NODE, STEPS[:20]),
    ):
        with GraphHarness() as graph:
            node = start(graph)
            found = graph.collect("/pose", PoseWithCovarianceStamped)
            truth = steps[0].truth
            given = Pose2D(x=truth.x + 0.1, y=truth.y - 0.1, theta=truth.yaw + 0.05)
            fields = {"filename": str(saved), "match_type": match_type}
            if match_type == kinds.START_AT_GIVEN_POSE:
                fields["initial_pose"] = given
            call(graph, DeserializePoseGraph, "deserialize_map", **fields)
            before = size_of(node)
            assert before > 5
            feed(graph, steps)
            assert last_pose(found).distance_to(steps[-1].truth) < 0.04
            assert size_of(node) > before


def test_localization_leaves_the_map_as_it_is(saved: Path) -> None:
    with GraphHarness() as graph:
        node = start(graph)
        found = graph.collect("/pose", PoseWithCovarianceStamped)
        truth = STEPS[40].truth
        call(
            graph,
            DeserializePoseGraph,
            "deserialize_map",
            filename=f"{saved}.slam",
            match_type=DeserializePoseGraph.Request.LOCALIZE_AT_POSE,
            initial_pose=Pose2D(x=truth.x, y=truth.y, theta=truth.yaw),
        )
        before = size_of(node)
        feed(graph, STEPS[40:])
        assert last_pose(found).distance_to(STEPS[-1].truth) < 0.04
        assert size_of(node) == before


def test_what_cannot_be_loaded_or_saved_leaves_the_map(tmp_path: Path) -> None:
    with GraphHarness() as graph:
        node = start(graph, **AT)
        nothing = call(
            graph, SerializePoseGraph, "serialize_map", filename=str(tmp_path / "none")
        )
        assert nothing.result == nothing.RESULT_FAILED_TO_WRITE_FILE
        no_map = call(graph, SaveMap, "save_map", name=String(data="none"))
        assert no_map.result == no_map.RESULT_NO_MAP_RECEIEVD
        feed(graph, STEPS[:20])
        before = size_of(node)
        damaged = tmp_path / "damaged.slam"
        damaged.write_bytes(b"PK nothing")
        for name, match_type in ((damaged, 1), (tmp_path / "missing", 1), ("", 1)):
            call(
                graph,
                DeserializePoseGraph,
                "deserialize_map",
                filename=str(name),
                match_type=match_type,
            )
        call(graph, DeserializePoseGraph, "deserialize_map", filename="x", match_type=0)
        assert size_of(node) == before
        lost = tmp_path / "no" / "office"
        answer = call(graph, SerializePoseGraph, "serialize_map", filename=str(lost))
        assert answer.result == answer.RESULT_FAILED_TO_WRITE_FILE
        refused = call(graph, SaveMap, "save_map", name=String(data=str(lost)))
        assert refused.result == refused.RESULT_UNDEFINED_FAILURE


def test_the_image_is_written_and_the_map_returned(tmp_path: Path) -> None:
    with GraphHarness() as graph:
        start(graph, **AT)
        assert call(graph, GetMap, "dynamic_map").map.info.width == 0
        feed(graph, STEPS[:20])
        name = String(data=str(tmp_path / "office"))
        assert call(graph, SaveMap, "save_map", name=name).result == 0
        cells = read_occupancy_map(tmp_path / "office.yaml").cells
        assert (cells == 100).any()
        info = call(graph, GetMap, "dynamic_map").map.info
        assert (info.height, info.width) == cells.shape


def test_while_paused_the_odometry_continues_the_pose_and_the_map_stays() -> None:
    with GraphHarness() as graph:
        node = start(graph, **AT)
        found = graph.collect("/pose", PoseWithCovarianceStamped)
        status = graph.collect(
            "/localization/status", "diagnostic_msgs/msg/DiagnosticStatus", latched=True
        )
        feed(graph, STEPS[:20])
        before, spread = size_of(node), found.last.pose.covariance[0]
        assert call(graph, Pause, "pause_new_measurements").status
        feed(graph, STEPS[20:40])
        assert found.count == 40
        assert size_of(node) == before
        assert last_pose(found).distance_to(STEPS[39].truth) < 0.3
        assert found.last.pose.covariance[0] > spread
        assert status.last.message == "localized"
        assert call(graph, Pause, "pause_new_measurements").status
        feed(graph, STEPS[40:])
        assert size_of(node) > before
        assert last_pose(found).distance_to(STEPS[-1].truth) < 0.05


def test_reset_begins_a_new_map_where_the_robot_is() -> None:
    with GraphHarness() as graph:
        node = start(graph, **AT)
        found = graph.collect("/pose", PoseWithCovarianceStamped)
        feed(graph, STEPS[:30])
        assert call(graph, Reset, "reset").result == 0
        feed(graph, STEPS[30:33])
        assert size_of(node) == 1
        assert last_pose(found).distance_to(STEPS[32].truth) < 0.05
        assert call(graph, Reset, "reset", pause_new_measurements=True).result == 0
        feed(graph, STEPS[33:35])
        assert size_of(node) == 0
