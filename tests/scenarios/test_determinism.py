"""Same world, goals and seed: the same bag, byte for byte."""

from pathlib import Path
from typing import Any

import pytest

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
