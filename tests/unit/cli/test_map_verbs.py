"""``navette map``: save the map of a running robot, show and convert files."""

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from verb_world import World, world

from navette.cli.map import drawing
from navette.geometry import Pose2
from navette.geometry.map_files import (
    OccupancyMap,
    read_description,
    read_occupancy_map,
    write_occupancy_map,
)
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.navigation.mapping.node import MapMemoryNode
from navette.navigation.slam.node import SlamNode
from navette.runtime import Node, Parameter

# Row 0 at the bottom: a wall below, an unknown margin on the left.
CELLS = np.array(
    [
        [-1, 100, 100, 100],
        [-1, 0, 0, 100],
        [-1, 0, 0, 0],
        [-1, -1, 0, 0],
    ],
    np.int8,
)


@pytest.fixture
def here() -> Iterator[World]:
    with world() as made:
        yield made


@pytest.fixture
def file(tmp_path: Path) -> Path:
    occupancy = OccupancyMap(CELLS, 0.05, Pose2(-1.0, 2.0, 0.0))
    return write_occupancy_map(tmp_path / "office", occupancy)


def test_the_map_of_a_robot_is_saved(here: World, file: Path, tmp_path: Path) -> None:
    known = Parameter("map_file", value=str(file))
    here.graph.add(MapMemoryNode(context=here.context, parameter_overrides=[known]))
    to = tmp_path / "again.yaml"
    assert here.read("map", "save", str(to)) == f"saved {to}\n"
    again = read_occupancy_map(to)
    assert again.origin == Pose2(-1.0, 2.0, 0.0)
    np.testing.assert_array_equal(again.cells, CELLS)


def test_the_map_of_slam_is_saved_first(here: World, tmp_path: Path) -> None:
    """SLAM's map with its scans; with a topic that of map_memory."""
    here.graph.add(MapMemoryNode(context=here.context))
    here.graph.add(SlamNode(context=here.context))
    to = tmp_path / "office"
    scan = LaserScan(angle_min=-3.0, angle_increment=0.1, range_max=9.0)
    scan.header.frame_id, scan.ranges = "base_link", np.full(60, 3.0, np.float32)
    lidar = Node("lidar", context=here.context).create_publisher(LaserScan, "/lidar", 1)
    for second in range(1, 4):
        scan.header.stamp.sec = second
        lidar.publish(scan)
        here.graph.run_for(0.1)
    printed = here.read("map", "save", str(to))
    assert printed == f"saved {to}.yaml and {to}.slam\n"
    assert to.with_suffix(".slam").stat().st_size > 0
    other = tmp_path / "other"
    printed = here.read("map", "save", str(other), "--topic", "/map")
    assert printed == f"saved {other}.yaml\n"


def test_a_map_without_a_name_is_refused(here: World, file: Path) -> None:
    for words in (["save", ""], ["save", "."], ["convert", str(file), "."]):
        refused = here.run("map", *words)
        assert (refused.code, "name the map" in refused.err) == (2, True), words


def test_saving_without_a_robot_fails(here: World, tmp_path: Path) -> None:
    failed = here.run("map", "save", str(tmp_path / "x"))
    assert failed.code == 1
    assert "no node has the service map_saver/save_map" in failed.err


def test_a_map_that_cannot_be_written_fails(here: World, tmp_path: Path) -> None:
    here.graph.add(MapMemoryNode(context=here.context))
    failed = here.run("map", "save", str(tmp_path / "missing" / "x"))
    assert failed.code == 1
    assert "the log of /map_saver/save_map has the reason" in failed.err


def test_a_file_is_shown(here: World, file: Path) -> None:
    shown = here.read("map", "show", str(file)).splitlines()
    assert shown[0] == (
        f"{file}: 4 x 4 cells of 0.05 m, 0.2 x 0.2 m, corner at (-1, 2), 0 rad, trinary"
    )
    assert shown[1] == "occupied 25.0%, free 43.8%, unknown 31.2%"
    assert shown[2:] == ["", "▄▄█"]
    values = json.loads(here.read("map", "show", str(file), "--json"))
    assert values["resolution_m"] == 0.05
    assert values["occupied"] == 0.25


def test_a_file_is_converted(here: World, file: Path, tmp_path: Path) -> None:
    to = tmp_path / "scaled"
    here.read("map", "convert", str(file), str(to), "--mode", "scale")
    written = to.with_suffix(".yaml")
    assert read_description(written).mode == "scale"
    np.testing.assert_array_equal(read_occupancy_map(written).cells, CELLS)
    again = here.run("map", "convert", str(file), str(to))
    assert (again.code, "--overwrite replaces it" in again.err) == (2, True)
    here.read("map", "convert", str(file), str(to), "--overwrite", "--image", "png")
    assert read_description(written).mode == "trinary"


def test_a_map_in_a_missing_folder_is_refused(
    here: World, file: Path, tmp_path: Path
) -> None:
    to = tmp_path / "missing" / "m.yaml"
    failed = here.run("map", "convert", str(file), str(to))
    reason = "cannot be written: No such file or directory"
    assert (failed.code, failed.err) == (2, f"navette: {to}: {reason}\n")


def test_an_unknown_mode_is_refused(here: World, file: Path, tmp_path: Path) -> None:
    failed = here.run(
        "map", "convert", str(file), str(tmp_path / "x"), "--mode", "grey"
    )
    assert failed.code == 2
    assert "mode 'grey'; known: trinary, scale, raw" in failed.err


@pytest.mark.parametrize("columns", [1, 7, 40])
def test_a_drawing_fits_into_its_columns(columns: int) -> None:
    cells = np.zeros((90, 61), np.int8)
    cells[:, -1] = 100
    lines = drawing(cells, columns)
    assert max(map(len, lines)) <= columns
    assert all(line.endswith(("█", "▄")) for line in lines)


def test_a_drawing_of_an_unknown_map() -> None:
    assert drawing(np.full((2, 3), -1, np.int8), 80) == ["░░░"]
