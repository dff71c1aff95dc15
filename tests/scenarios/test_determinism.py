"""Same world, goals and seed: the same bag, byte for byte."""

import math
from pathlib import Path
from typing import Any

import pytest

from navette.msgs.geometry_msgs.msg import Twist
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.navigation.stack.simulation import Simulation

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


class Watched:
    """A drive, with its commands and the messages of one topic."""

    def __init__(self, simulation: Simulation, kind: type, topic: str) -> None:
        self.commands: list[tuple[float, float]] = []
        self.messages: list[Any] = []
        subscribe = simulation.sim.create_subscription
        subscribe(Twist, "/cmd_vel", self._note, 10)
        self.reader = subscribe(kind, topic, self.messages.append, 10, shared=True)

    def _note(self, msg: Twist) -> None:
        self.commands.append((msg.linear.x, msg.angular.z))


@pytest.mark.slow
def test_a_drive_is_the_same_if_only_parts_of_the_map_are_sent(
    simulate: MakeSimulation, tmp_path: Path
) -> None:
    params = tmp_path / "parts.yaml"
    params.write_text(PARTS_ONLY, encoding="utf-8")
    drives = []
    for files in ((), (params,)):
        simulation = simulate(
            world="course",
            goals=((-6.0, -3.0),),
            max_time_s=20.0,
            params_files=files,
        )
        drives.append(Watched(simulation, OccupancyGrid, "/map"))
        simulation.run()
    whole, parts = drives
    assert len(whole.commands) > 100
    assert parts.commands == whole.commands
    assert len(parts.messages) < len(whole.messages) / 2


@pytest.mark.slow
def test_a_drive_is_the_same_if_somebody_reads_every_scan(
    simulate: MakeSimulation, tmp_path: Path
) -> None:
    """Alone, navigation uses 20 of the Jackal's 50 scans a second."""
    params = tmp_path / "noisy.yaml"
    params.write_text(NOISY, encoding="utf-8")
    drives = []
    for rate_hz in (20.0, math.inf):
        simulation = simulate(
            world="arena",
            robot="jackal",
            goals=((4.0, 2.0),),
            max_time_s=6.0,
            params_files=(params,),
        )
        drives.append(Watched(simulation, LaserScan, "/lidar"))
        drives[-1].reader.limit_rate(rate_hz)
        simulation.run()
    some, every = drives
    assert len(some.commands) > 60
    assert every.commands == some.commands
    assert len(some.messages) == pytest.approx(120, abs=3)
    assert len(every.messages) == pytest.approx(300, abs=3)


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
