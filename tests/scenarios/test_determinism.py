"""Same world, goals and seed: the same bag, byte for byte."""

from pathlib import Path
from typing import Any

import pytest

from navette.msgs.geometry_msgs.msg import Twist
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.msgs.sensor_msgs.msg import LaserScan

from .conftest import MakeSimulation
from .test_amcl import map_file

NOISY = """\
sim:
  ros__parameters:
    lidar_noise_m: 0.01
    lidar_dropout: 0.01
"""


def record(
    simulate: MakeSimulation, folder: Path, name: str, seed: int, **options: Any
) -> bytes:
    params = folder / "noisy.yaml"
    params.write_text(NOISY, encoding="utf-8")
    path = folder / f"{name}.mcap"
    simulation = simulate(
        world="course",
        goals=((-6.0, -3.0),),
        seed=seed,
        record=path,
        params_files=(params,),
        **{"max_time_s": 20.0, **options},
    )
    simulation.run()
    simulation.close()
    return path.read_bytes()


@pytest.mark.slow
def test_two_runs_with_one_seed_record_the_same_bytes(
    simulate: MakeSimulation, tmp_path: Path
) -> None:
    first = record(simulate, tmp_path, "first", seed=7)
    assert len(first) > 100_000
    assert record(simulate, tmp_path, "second", seed=7) == first
    assert record(simulate, tmp_path, "other", seed=8) != first


PARTS_ONLY = """\
map_memory:
  ros__parameters:
    always_send_full_map: false
"""


@pytest.mark.slow
def test_a_drive_is_the_same_if_only_parts_of_the_map_are_sent(
    simulate: MakeSimulation, tmp_path: Path
) -> None:
    params = tmp_path / "parts.yaml"
    params.write_text(PARTS_ONLY, encoding="utf-8")
    commands: list[list[tuple[float, float]]] = []
    maps: list[int] = []
    for files in ((), (params,)):
        simulation = simulate(
            world="course",
            goals=((-6.0, -3.0),),
            max_time_s=20.0,
            params_files=files,
        )
        sent: list[tuple[float, float]] = []
        whole: list[OccupancyGrid] = []

        def note(msg: Twist, sent: list[tuple[float, float]] = sent) -> None:
            sent.append((msg.linear.x, msg.angular.z))

        subscribe = simulation.sim.create_subscription
        subscribe(Twist, "/cmd_vel", note, 10)
        subscribe(OccupancyGrid, "/map", whole.append, 10, shared=True)
        simulation.run()
        commands.append(sent)
        maps.append(len(whole))
    assert len(commands[0]) > 100
    assert commands[1] == commands[0]
    assert maps[1] < maps[0] / 2


@pytest.mark.slow
def test_a_drive_is_the_same_if_somebody_reads_every_scan(
    simulate: MakeSimulation, tmp_path: Path
) -> None:
    """Alone, navigation uses 20 of the Jackal's 50 scans a second."""
    params = tmp_path / "noisy.yaml"
    params.write_text(NOISY, encoding="utf-8")
    commands: list[list[tuple[float, float]]] = []
    readings: list[int] = []
    for reads_all in (False, True):
        simulation = simulate(
            world="arena",
            robot="jackal",
            goals=((4.0, 2.0),),
            max_time_s=6.0,
            params_files=(params,),
        )
        sent: list[tuple[float, float]] = []
        scans: list[LaserScan] = []

        def note(msg: Twist, sent: list[tuple[float, float]] = sent) -> None:
            sent.append((msg.linear.x, msg.angular.z))

        subscribe = simulation.sim.create_subscription
        subscribe(Twist, "/cmd_vel", note, 10)
        lidar = subscribe(LaserScan, "/lidar", scans.append, 10, shared=True)
        if not reads_all:
            lidar.limit_rate(20.0)
        simulation.run()
        commands.append(sent)
        readings.append(len(scans))
    assert len(commands[0]) > 60
    assert commands[1] == commands[0]
    assert readings == [pytest.approx(120, abs=3), pytest.approx(300, abs=3)]


@pytest.mark.long
@pytest.mark.parametrize("localization", ["slam", "amcl"])
def test_noisy_odometry_and_its_correction_are_the_same_again(
    simulate: MakeSimulation, tmp_path: Path, localization: str
) -> None:
    options = {
        "methods": {"localization": localization},
        "max_time_s": 8.0,
        # Any map will do: amcl draws its particles from the seed.
        "known_map": map_file(tmp_path) if localization == "amcl" else None,
    }
    first = record(simulate, tmp_path, "first", 7, **options)
    assert len(first) > 100_000
    assert record(simulate, tmp_path, "second", 7, **options) == first
    assert record(simulate, tmp_path, "other", 8, **options) != first
