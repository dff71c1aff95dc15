"""The switch between sources of the pose."""

import math
from pathlib import Path

import numpy as np
import pytest

from navette.errors import ParameterError
from navette.geometry import Pose2
from navette.geometry.map_files import OccupancyMap, write_occupancy_map
from navette.navigation.stack.options import RunOptions
from navette.navigation.stack.simulation import Simulation
from navette.sim import World

NODES = {
    "truth": {"localizer"},
    "odometry": {"localizer"},
    "odometry+imu": {"ekf", "localizer"},
    "slam": {"ekf", "slam"},
    "slam+imu": {"ekf", "slam"},
    "slam+wheels": {"slam"},
    "amcl": {"ekf", "amcl"},
    "amcl+wheels": {"amcl"},
}


def simulation(localization: str, **options: object) -> Simulation:
    given: dict[str, object] = {"methods": {"localization": localization}, **options}
    return Simulation(RunOptions(world="course", headless=True, **given))  # type: ignore[arg-type]


@pytest.mark.parametrize("localization", NODES)
def test_each_source_starts_its_node_with_the_frames_of_the_robot(
    localization: str, tmp_path: Path
) -> None:
    known = OccupancyMap(np.zeros((4, 4), np.int8), 1.0, Pose2(0.0, 0.0, 0.0))
    file = write_occupancy_map(tmp_path / "known", known)
    is_amcl = "amcl" in localization
    run = simulation(localization, known_map=file if is_amcl else None)
    try:
        names = {node.get_name() for node in run.context.nodes}
        assert names & {"localizer", "slam", "amcl", "ekf"} == NODES[localization]
        node = run.stack.localization[-1]
        frame = node.get_parameter("global_frame_id" if is_amcl else "map_frame")
        assert frame.value == "sim_world"
        assert run.sim.params.odometry_frame == (
            "odom" if localization[:4] in ("slam", "amcl") else "sim_world"
        )
        assert run.sim.params.wheel_stddev_m == (
            0.0 if localization == "truth" else 0.01
        )
    finally:
        run.close()


def test_the_parameter_is_the_same_switch() -> None:
    run = simulation("truth", parameters={"sim": {"localization": "slam"}})
    try:
        assert [node.get_name() for node in run.stack.localization] == ["ekf", "slam"]
    finally:
        run.close()


def test_an_unknown_source_is_refused_with_the_known_ones() -> None:
    with pytest.raises(ParameterError, match=r"truth, odometry, .* slam, "):
        simulation("gps")


@pytest.mark.parametrize("goals", [(), ((1.0, 0.0),)])
def test_amcl_without_a_map_is_refused_before_the_drive(
    goals: tuple[tuple[float, float], ...],
) -> None:
    """It would wait for the map until the time limit, or until it is interrupted."""
    with pytest.raises(ParameterError, match="needs a map; give one with --map"):
        simulation("amcl", goals=goals)


@pytest.mark.parametrize(("shift_m", "fits"), [(0.0, True), (2.0, False)])
def test_a_pose_on_a_map_in_another_frame_has_no_error(
    tmp_path: Path, shift_m: float, fits: bool
) -> None:
    """The origin of a map from a recording is the pose at which the drive began."""
    scene = World("box").add_box((3.0, 0.0), (0.2, 6.0)).add_box((0, 3), (6, 0.2))
    cells = np.zeros((160, 160), np.int8)
    cells[20:140, 138:142] = cells[138:142, 20:140] = 100
    known = OccupancyMap(cells, 0.05, Pose2(-4.0 + shift_m, -4.0, 0.0))
    options = RunOptions(
        world="empty",
        robot="jackal",
        headless=True,
        speed=math.inf,
        known_map=write_occupancy_map(tmp_path / "box", known),
        methods={"localization": "amcl"},
        max_time_s=1.0,
    )
    run = Simulation(options, scene=scene.scene())
    try:
        run.run()
        error = run.summary().pose_error_m
        assert error.map_fits_world is fits
        assert (error.final is not None) is fits
    finally:
        run.close()


def test_zones_have_the_frames_of_the_robot(tmp_path: Path) -> None:
    mask = OccupancyMap(np.zeros((4, 4), np.int8), 1.0, Pose2(0.0, 0.0, 0.0))
    run = simulation("truth", keepout=write_occupancy_map(tmp_path / "mask", mask))
    try:
        (zones,) = (node for node in run.context.nodes if node.get_name() == "zones")
        assert zones.get_parameter("map_frame").value == "sim_world"
    finally:
        run.close()


def test_gnss_is_fused_if_the_robot_has_a_receiver() -> None:
    with pytest.raises(ParameterError, match="has no GNSS receiver"):
        simulation("odometry+gnss")
    run = simulation("odometry+imu+gnss", robot="jackal")
    try:
        ekf = run.stack.localization[0]
        assert ekf.get_parameter("gps0").value == "/fix"
        assert list(ekf.get_parameter("gps0_datum_deg").value) == [0.0, 0.0]
    finally:
        run.close()
