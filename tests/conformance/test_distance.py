"""Distance by odom_integrator for played bags of a drive."""

import runpy
from pathlib import Path

import numpy as np
import pytest
from distance_drive import length, played_distance, write_drive

from navette.bags import open_bag
from navette.bags.compare import Tolerances, compare

SECONDS = 30.0


@pytest.fixture(scope="module")
def drive() -> tuple[np.ndarray, np.ndarray]:
    """Return times and positions of a car on a winding uphill road at varying speed."""
    times = np.arange(0.0, SECONDS, 0.1)
    way = 8.0 * times + 12.0 * np.sin(times / 3.0)
    heading = 1.5 * np.sin(way / 40.0)
    steps = np.gradient(way)[:, None] * np.column_stack(
        [np.cos(heading), np.sin(heading), np.full(len(way), 0.08)]
    )
    return times, np.cumsum(steps, axis=0)


@pytest.fixture(scope="module")
def bags(drive, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("drives")
    for suffix in (".bag", ".mcap", ".db3"):
        write_drive(folder / f"drive{suffix}", *drive)
    return folder


@pytest.mark.parametrize("suffix", [".bag", ".mcap", ".db3"])
def test_the_distance_by_position_and_by_velocity(bags, drive, suffix) -> None:
    bag, metres = bags / f"drive{suffix}", length(drive[1])
    assert played_distance(bag) == pytest.approx(metres, rel=1e-6)
    by_velocity = played_distance(bag, odom_type="vel")
    assert by_velocity == pytest.approx(metres, rel=0.01)


@pytest.mark.parametrize("odom_type", ["pos", "vel"])
def test_neither_rate_nor_looping_nor_seeking_adds_a_jump(
    bags, drive, odom_type: str
) -> None:
    bag, (times, positions) = bags / "drive.mcap", drive
    once = played_distance(bag, odom_type=odom_type)

    def played(**how) -> float:
        return played_distance(bag, odom_type=odom_type, **how)

    assert played(rate=50.0) == pytest.approx(once, rel=1e-9)
    assert played(passes=2) == pytest.approx(2 * once, rel=1e-9)

    # A part played twice counts twice, a skipped part does not.
    def between(begin_s: float, end_s: float) -> float:
        taken = (times >= begin_s - 1e-9) & (times <= end_s + 1e-9)
        return length(positions[taken])

    one_step = 2.0  # the message at which the jump occurs
    back = played(seeks=[(20.0, 5.0)])
    assert back == pytest.approx(once + between(5.0, 20.0), abs=one_step)
    ahead = played(seeks=[(8.0, 22.0)])
    assert ahead == pytest.approx(once - between(8.0, 22.0), abs=one_step)


def test_the_shipped_drive_equals_the_output_of_its_script(tmp_path: Path) -> None:
    data = Path(__file__).parents[2] / "examples" / "data"
    make = runpy.run_path(str(data / "make_drive.py"))["make"]
    make(tmp_path / "drive.mcap")
    shipped = data / "drive.mcap"
    with open_bag(shipped) as expected, open_bag(tmp_path / "drive.mcap") as got:
        topics = [topic.name for topic in expected.topics]
        # Values are rounded; another machine's sine may round differently.
        found = compare(
            expected, got, topics=topics, tolerances=Tolerances.parse(["0.0011"])
        )
    assert found.same
    assert shipped.stat().st_size < 200_000
