"""Generated worlds and suites."""

import math
from pathlib import Path

import numpy as np
import pytest

from navette.errors import InvalidValueError, UnknownNameError
from navette.navigation.bench.barn import barn_trials, reference_length
from navette.navigation.bench.suites import suite_trials
from navette.navigation.bench.trial import barn_score
from navette.navigation.worlds.generators import GENERATORS, generate


@pytest.mark.parametrize("kind", GENERATORS)
def test_a_seed_gives_one_world_with_a_path(kind: str) -> None:
    world, again, other = generate(kind, 3), generate(kind, 3), generate(kind, 4)
    assert world == again
    assert world != other
    apart = math.dist(world.goal, (world.start.x, world.start.y))
    assert apart - 0.2 < world.shortest_m < 12 * apart


def test_an_unknown_kind_lists_the_known_ones() -> None:
    with pytest.raises(UnknownNameError, match=r"'cave'.*barn-like.*rooms"):
        generate("cave", 0)


def test_the_score_is_that_of_the_challenge() -> None:
    assert barn_score(True, 10.0, 10.0) == 0.5
    assert barn_score(True, 1.0, 10.0) == 0.5, "at most 0.5"
    assert barn_score(True, 20.0, 10.0) == 0.25
    assert barn_score(True, 1000.0, 10.0) == 0.125, "at least 1/8 for a success"
    assert barn_score(False, 10.0, 10.0) == 0.0


def _data_set(folder: Path) -> Path:
    (folder / "worlds").mkdir()
    (folder / "paths").mkdir()
    (folder / "worlds/world_7.world").write_text("<sdf/>", encoding="utf-8")
    np.save(folder / "paths/path_7.npy", np.array([[15, 0], [15, 29]]))
    return folder


def test_the_reference_path_starts_and_ends_as_in_the_challenge(tmp_path: Path) -> None:
    [trial] = barn_trials(_data_set(tmp_path))
    # (−2.25, 3) → (−2.325, 5.075) → (−2.325, 9.425) → (−2.25, 13)
    expected = math.hypot(0.075, 2.075) + 4.35 + math.hypot(0.075, 3.575)
    assert trial.shortest_m == pytest.approx(expected)
    assert (trial.robot, trial.reach_m) == ("jackal", 1.0)


def test_a_missing_world_or_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(InvalidValueError, match=r"world_N\.world"):
        barn_trials(tmp_path)
    with pytest.raises(InvalidValueError, match=r"\[9\].*available: \[7\]"):
        barn_trials(_data_set(tmp_path), (9,))
    (tmp_path / "paths/path_7.npy").write_bytes(b"not an array")
    with pytest.raises(InvalidValueError, match="path_7"):
        reference_length(tmp_path / "paths/path_7.npy")


def test_suites_name_their_trials() -> None:
    course = suite_trials("course", data=None, worlds=(), robot=None)
    assert len(course) == 11
    assert {trial.robot for trial in course} == {"course"}
    mazes = suite_trials("maze", data=None, worlds=(1, 2), robot="husky")
    assert [(t.name, t.world, t.robot) for t in mazes] == [
        ("maze-1", "maze:1", "husky"),
        ("maze-2", "maze:2", "husky"),
    ]
    with pytest.raises(InvalidValueError, match="--data"):
        suite_trials("barn", data=None, worlds=(), robot=None)
    with pytest.raises(UnknownNameError, match="known: barn"):
        suite_trials("moon", data=None, worlds=(), robot=None)


def test_runs_of_the_course_are_chosen_by_number() -> None:
    chosen = suite_trials("course", data=None, worlds=(2, 10), robot=None)
    assert [each.name for each in chosen] == ["box-and-wall", "seven-goals"]
    assert len(suite_trials("course", data=None, worlds=(), robot=None)) == 11
    with pytest.raises(InvalidValueError, match=r"runs \[11\].*10 seven-goals"):
        suite_trials("course", data=None, worlds=(0, 11), robot=None)
