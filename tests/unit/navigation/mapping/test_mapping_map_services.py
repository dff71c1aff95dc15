"""Nav2's services that load, return and save the map."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from navette.errors import FileFormatError
from navette.geometry import Pose2
from navette.geometry.map_files import (
    OccupancyMap,
    read_occupancy_map,
    write_occupancy_map,
)
from navette.msgs.nav2_msgs.srv import LoadMap, SaveMap
from navette.msgs.nav_msgs.msg import OccupancyGrid, Odometry
from navette.msgs.nav_msgs.srv import GetMap
from navette.navigation.grids import GridSpec, grid_from_message, grid_to_message
from navette.navigation.mapping.node import MapMemoryNode
from navette.runtime import Parameter
from navette.runtime.stage.path_messages import pose_message
from navette.runtime.testing import GraphHarness
from navette.runtime.time import ns_to_stamp

CELLS = np.full((40, 60), -1, np.int8)
CELLS[2:38, 2:58] = 0
CELLS[2, 2:58] = 100
LOADED = OccupancyMap(CELLS, 0.05, Pose2(-1.0, -1.0, 0.0))


@pytest.fixture
def graph() -> Iterator[GraphHarness]:
    with GraphHarness() as harness:
        parameters = [Parameter("size_m", value=10.0)]
        harness.add(
            MapMemoryNode(context=harness.context, parameter_overrides=parameters)
        )
        harness.node.create_timer(0.1, lambda: stand(harness))
        harness.run_for(0.3)
        yield harness


def stand(graph: GraphHarness) -> None:
    msg = Odometry(child_frame_id="base_link")
    msg.header.frame_id = "map"
    msg.header.stamp = ns_to_stamp(graph.now_ns)
    msg.pose.pose = pose_message(Pose2(0.5, 0.0, 0.0))
    graph.publish("/odom/filtered", msg)


def load(graph: GraphHarness, url: object) -> Any:
    request = LoadMap.Request(map_url=str(url))
    return graph.call(LoadMap, "/map_server/load_map", request)


def save(graph: GraphHarness, url: object, **fields: Any) -> bool:
    request = SaveMap.Request(map_url=str(url), **fields)
    return bool(graph.call(SaveMap, "/map_saver/save_map", request).result)


def test_a_loaded_map_replaces_the_map(graph: GraphHarness, tmp_path: Path) -> None:
    path = write_occupancy_map(tmp_path / "hall", LOADED)
    maps = graph.collect("/map", OccupancyGrid, latched=True)
    response = load(graph, path)
    assert response.result == LoadMap.Response.RESULT_SUCCESS
    graph.run_for(0.1)
    assert response.map == maps.last
    cells, spec = grid_from_message(maps.last)
    assert (cells == CELLS).all()
    assert spec == GridSpec(0.05, 60, 40, LOADED.origin)
    assert maps.last.header.frame_id == "map"
    found = graph.call(GetMap, "/map_server/map", GetMap.Request())
    assert found.map == maps.last
    assert load(graph, f"file://{path}").result == LoadMap.Response.RESULT_SUCCESS


def test_a_map_file_is_the_map_from_the_start(tmp_path: Path) -> None:
    path = write_occupancy_map(tmp_path / "hall", LOADED)
    with GraphHarness() as graph:
        maps = graph.collect("/map", OccupancyGrid, latched=True)
        known = [Parameter("map_file", value=str(path))]
        node = graph.add(
            MapMemoryNode(context=graph.context, parameter_overrides=known)
        )
        graph.run_for(0.1)
        assert (grid_from_message(maps.last)[0] == CELLS).all()
        # A file that cannot be read changes nothing.
        node.set_parameters([Parameter("map_file", value=str(tmp_path / "none"))])
        graph.run_for(0.1)
        assert (grid_from_message(maps.last)[0] == CELLS).all()


def test_a_missing_map_file_is_an_error(tmp_path: Path) -> None:
    known = [Parameter("map_file", value=str(tmp_path / "none.yaml"))]
    with GraphHarness() as graph, pytest.raises(FileFormatError, match=r"none\.yaml"):
        MapMemoryNode(context=graph.context, parameter_overrides=known)


def test_scans_continue_a_loaded_map(graph: GraphHarness, tmp_path: Path) -> None:
    load(graph, write_occupancy_map(tmp_path / "hall", LOADED))
    maps = graph.collect("/map", OccupancyGrid, latched=True)
    seen = np.zeros((60, 60), np.int8)
    seen[40, 40] = 100
    spec = GridSpec(0.1, 60, 60, Pose2(-3.0, -3.0, 0.0))
    graph.publish("/costmap", grid_to_message(seen, spec, "base_link", graph.now_ns))
    graph.run_for(1.5)
    cells, spec = grid_from_message(maps.last)
    assert spec.resolution == 0.05
    assert cells[spec.cell_of(0.5 + 1.05, 1.05)] == 100
    assert cells[spec.cell_of(-1.5, -2.0)] == 0
    assert spec.width > 60


def test_failures_to_load_have_their_codes(graph: GraphHarness, tmp_path: Path) -> None:
    codes = LoadMap.Response
    for url in ("", tmp_path / "missing.yaml", "a" * 5000, "\0"):
        assert load(graph, url).result == codes.RESULT_MAP_DOES_NOT_EXIST
    invalid = tmp_path / "invalid.yaml"
    invalid.write_text("image: [")
    assert load(graph, invalid).result == codes.RESULT_INVALID_MAP_METADATA
    assert load(graph, tmp_path).result == codes.RESULT_INVALID_MAP_METADATA
    path = write_occupancy_map(tmp_path / "hall", LOADED)
    (tmp_path / "hall.pgm").write_bytes(b"P5 no pixels")
    assert load(graph, path).result == codes.RESULT_INVALID_MAP_DATA
    found = graph.call(GetMap, "/map_server/map", GetMap.Request())
    assert found.map.info.width == 100  # the map did not change


def test_a_saved_map_can_be_loaded(graph: GraphHarness, tmp_path: Path) -> None:
    load(graph, write_occupancy_map(tmp_path / "hall", LOADED))
    for name, fields in (
        ("a", {}),
        ("b", {"map_topic": "map", "image_format": "png", "map_mode": "trinary"}),
        ("c", {"map_mode": "scale"}),
        ("d", {"map_mode": "raw", "image_format": "bmp"}),
        ("e", {"map_topic": "/global_costmap/costmap", "free_thresh": 0.1}),
    ):
        assert save(graph, tmp_path / name, **fields)
        found = read_occupancy_map(tmp_path / f"{name}.yaml")
        assert (found.cells == CELLS).all()
        assert (found.resolution, found.origin) == (0.05, LOADED.origin)


def test_inflation_is_not_saved_as_obstacles(
    graph: GraphHarness, tmp_path: Path
) -> None:
    seen = np.zeros((60, 60), np.int8)
    seen[40, 39:42] = 90, 100, 90
    spec = GridSpec(0.1, 60, 60, Pose2(-3.0, -3.0, 0.0))
    graph.publish("/costmap", grid_to_message(seen, spec, "base_link", graph.now_ns))
    graph.run_for(1.5)
    assert save(graph, tmp_path / "m")
    found = read_occupancy_map(tmp_path / "m.yaml")
    assert (found.cells == 100).sum() == 1


def test_another_topic_can_be_saved(graph: GraphHarness, tmp_path: Path) -> None:
    cells = np.array([[0, 100], [-1, 0]], np.int8)
    grid = grid_to_message(cells, GridSpec(0.2, 2, 2), "map", 0)
    graph.publish("/slam/map", grid, latched=True)
    assert save(graph, tmp_path / "m", map_topic="slam/map")
    assert read_occupancy_map(tmp_path / "m.yaml").cells.tolist() == cells.tolist()
    before = graph.now_ns
    assert not save(graph, tmp_path / "n", map_topic="nothing/there")
    assert graph.now_ns - before == pytest.approx(6e9, abs=0.2e9)


def test_a_map_that_cannot_be_saved(graph: GraphHarness, tmp_path: Path) -> None:
    assert not save(graph, "")
    assert not save(graph, tmp_path / "m", map_mode="grey")
    assert not save(graph, tmp_path / "m", map_topic="no topic")
    assert not save(graph, tmp_path / "missing" / "m")
    assert not save(graph, tmp_path / "m", image_format="gif")
    assert not save(graph, tmp_path / "m", occupied_thresh=0.1)
    (tmp_path / "file").write_text("")
    assert not save(graph, tmp_path / "file" / "m")
    assert [each.name for each in tmp_path.iterdir()] == ["file"]
