"""One loader for worlds by name, by file, and by kind and seed."""

from pathlib import Path

import pytest

from navette.errors import InvalidValueError, UnknownNameError
from navette.navigation.stack.options import RunOptions
from navette.navigation.stack.scene import resolve_scene
from navette.navigation.worlds import load_scene
from navette.navigation.worlds.generated import KINDS
from navette.navigation.worlds.generators import generate
from navette.sim import Simulator


def test_a_name_a_file_and_a_generated_world() -> None:
    assert load_scene("arena").name == "arena"
    data = Path(__file__).parents[4] / "src/navette/sim/data/worlds/empty.sdf"
    assert load_scene(str(data)).models == load_scene("empty").models
    assert load_scene("rooms:3") == generate("rooms", 3).scene


@pytest.mark.parametrize("kind", KINDS)
def test_a_robot_without_a_pose_begins_at_the_start_of_the_world(kind: str) -> None:
    resolved = resolve_scene(RunOptions(world=f"{kind}:7"))
    pose = Simulator(resolved.scene).pose().to_pose2()
    start = resolved.scene.start.to_pose2()
    assert pose.distance_to(start) < 0.01
    assert abs(pose.yaw - start.yaw) < 0.01


@pytest.mark.parametrize(
    ("world", "error", "text"),
    [
        ("mase:7", UnknownNameError, "maze:SEED"),
        ("maze", UnknownNameError, "maze:SEED"),
        ("maze:x", InvalidValueError, "seed of 0 or more, as maze:7"),
        ("maze:-1", InvalidValueError, "seed of 0 or more"),
        ("aren", UnknownNameError, "arena"),
    ],
)
def test_a_wrong_name_is_answered_with_what_is_allowed(
    world: str, error: type[Exception], text: str
) -> None:
    with pytest.raises(error, match=text):
        load_scene(world)
