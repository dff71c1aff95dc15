"""DynaBARN's worlds, and generated ones of their kind."""

import json
import math
from pathlib import Path

import pytest

from navette.errors import FileFormatError, InvalidValueError
from navette.navigation.bench.dynabarn import dynabarn_trials
from navette.navigation.bench.suites import suite_trials
from navette.navigation.worlds import load_scene
from navette.navigation.worlds.dynabarn import dynabarn_scene
from navette.navigation.worlds.moving_worlds import moving_scene

OBSTACLE = {
    "name": "obs_1",
    "radius_m": 0.5,
    "duration_s": 10.0,
    "keyframes_t_x_y": [[0.0, -10.0, 4.0], [10.0, 10.0, -4.0]],
}


def _folder(tmp_path: Path, content: object) -> Path:
    (tmp_path / "trajectories.json").write_text(json.dumps(content))
    return tmp_path


def test_worlds_start_goal_and_limits_are_those_of_the_benchmark(
    tmp_path: Path,
) -> None:
    folder = _folder(tmp_path, {"world_3": [OBSTACLE], "world_12": [OBSTACLE]})
    trials = suite_trials("dynabarn", data=folder, worlds=(), robot=None)
    assert [trial.name for trial in trials] == ["world_3", "world_12"]
    assert trials[0].start == (11.0, 0.0, math.pi)
    assert trials[0].goals == ((-9.0, 0.0),)
    assert (trials[0].limit_s, trials[0].shortest_m) == (100.0, 20.0)
    scene = load_scene(trials[1].world)
    assert scene is not None
    (motion,) = [m.motion for m in scene.models if m.motion is not None]
    assert motion.at(5.0)[:2] == pytest.approx((0.0, 0.0))
    assert motion.cycle_s == 10.0


def test_missing_worlds_and_wrong_files_are_named(tmp_path: Path) -> None:
    with pytest.raises(InvalidValueError, match="--data FOLDER"):
        suite_trials("dynabarn", data=None, worlds=(), robot=None)
    with pytest.raises(InvalidValueError, match=r"expected trajectories\.json"):
        dynabarn_trials(tmp_path)
    folder = _folder(tmp_path, {"world_3": [OBSTACLE]})
    with pytest.raises(InvalidValueError, match=r"worlds \[4\]: .*available: \[3\]"):
        dynabarn_trials(folder, (4,))
    with pytest.raises(FileFormatError, match="expected world_N"):
        dynabarn_trials(_folder(tmp_path, {"first": []}))
    wrong = OBSTACLE | {"keyframes_t_x_y": [[0.0, 0.0], [1.0, 1.0]]}
    (trial,) = dynabarn_trials(_folder(tmp_path, {"world_3": [wrong]}))
    with pytest.raises(FileFormatError, match="world_3, obstacle 0"):
        dynabarn_scene(trial.world)


def test_generated_worlds_repeat_and_get_harder() -> None:
    assert moving_scene(5) == moving_scene(5)
    assert moving_scene(5) != moving_scene(8)
    speeds = []
    for seed in (0, 1, 2):
        motions = [m.motion for m in moving_scene(seed).models if m.motion is not None]
        assert len(motions) >= 8
        speeds.append(max(motion.fastest_mps() for motion in motions))
        for motion in motions:
            for waypoint in motion.waypoints:
                assert max(abs(waypoint.x), abs(waypoint.y)) <= 10.0 + 1e-9
    assert speeds == sorted(speeds)
    assert speeds[-1] <= 2.0 + 1e-6
