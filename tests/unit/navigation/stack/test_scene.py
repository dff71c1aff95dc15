"""The robot of a run and the source of its parameters."""

import shutil
from pathlib import Path

import pytest

import navette.sim
from navette.errors import UnknownNameError
from navette.navigation.stack.options import RunOptions
from navette.navigation.stack.scene import resolve_scene

JACKAL = Path(navette.sim.__file__).parent / "data" / "robots" / "jackal" / "model.sdf"


def test_a_model_file_uses_the_parameters_beside_it(tmp_path: Path) -> None:
    model = Path(shutil.copy(JACKAL, tmp_path / "mine.sdf"))
    alone = resolve_scene(RunOptions(world="empty", robot=str(model)))
    assert alone.params_file is None
    assert alone.derived["control"]["footprint_m"]

    beside = tmp_path / "params.yaml"
    beside.write_text("control:\n  ros__parameters:\n    cruise_speed_mps: 0.3\n")
    resolved = resolve_scene(RunOptions(world="empty", robot=str(model)))
    assert resolved.params_file == beside
    assert resolved.derived["control"]["footprint_m"]  # for what the file leaves open


@pytest.mark.parametrize(
    ("world", "robot", "expected"),
    [
        ("empty", None, "jackal"),
        ("course", None, "course"),
        ("course", "husky", "husky"),
    ],
)
def test_the_robot_is_the_option_or_the_worlds_or_the_default(
    world: str, robot: str | None, expected: str
) -> None:
    assert resolve_scene(RunOptions(world=world, robot=robot)).robot_name == expected


def test_an_unknown_robot_lists_the_known_ones() -> None:
    with pytest.raises(UnknownNameError, match="husky"):
        resolve_scene(RunOptions(world="empty", robot="r2d2"))
