"""``navette slam``: a recording in, a map and a trajectory out."""

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from verb_world import Done

from navette.cli.app import app
from navette.errors import NavetteError
from navette.geometry import Pose2
from navette.geometry.map_files import read_occupancy_map
from slam_office import Step, drive, errors_m, loop, write_bag

STEPS: list[Step] = list(drive(seed=1, poses=loop(0.2)))


def run(*words: object) -> Done:
    done = CliRunner().invoke(app, ["slam", *map(str, words)])
    if isinstance(done.exception, NavetteError):
        return Done(done.stdout, str(done.exception), 2)
    if done.exception and not isinstance(done.exception, SystemExit):
        raise done.exception
    return Done(done.stdout, done.stderr, done.exit_code)


@pytest.fixture(scope="module")
def bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("slam") / "office.mcap"
    write_bag(path, iter(STEPS))
    return path


def poses_of(path: Path) -> list[Pose2]:
    lines = np.loadtxt(path)
    stamps = np.array([step.stamp_ns / 1e9 for step in STEPS])
    np.testing.assert_allclose(lines[:, 0], stamps, atol=1e-8)
    return [Pose2(x, y, 2 * np.arctan2(z, w)) for x, y, z, w in lines[:, [1, 2, 6, 7]]]


def test_a_map_and_a_trajectory_are_written(bag: Path, tmp_path: Path) -> None:
    stem, lines = tmp_path / "office", tmp_path / "office.tum"
    done = run(bag, "--map", stem, "--trajectory", lines, "--json")
    assert done.code == 0, done
    values = json.loads(done.out)
    assert values["scans"] == len(STEPS)
    assert values["odometry"] == "/tf"
    assert values["loop_closures"] > 0
    assert values["skipped"] == values["unmatched"] == 0
    away = errors_m(poses_of(lines), [step.truth for step in STEPS])
    assert np.sqrt((away**2).mean()) < 0.04
    occupancy = read_occupancy_map(stem.with_suffix(".yaml"))
    assert occupancy.resolution == 0.05
    height, width = occupancy.cells.shape
    assert 12.0 <= height * 0.05 < 14.0
    assert 16.0 <= width * 0.05 < 18.0


def test_damage_is_reported_and_the_rest_is_used(bag: Path, tmp_path: Path) -> None:
    damaged, lines = tmp_path / "damaged.mcap", tmp_path / "office.tum"
    data = bag.read_bytes()
    damaged.write_bytes(data[: len(data) * 3 // 4])
    done = run(damaged, "--trajectory", lines)
    assert done.code == 1
    assert "damaged: " in done.err
    assert "wrote" in done.out
    assert lines.is_file()


def test_the_same_recording_gives_the_same_files(bag: Path, tmp_path: Path) -> None:
    for name in ("one", "two"):
        stem = tmp_path / name
        run(bag, "--map", stem, "--trajectory", stem.with_suffix(".tum"))
    for suffix in (".pgm", ".tum"):
        one = (tmp_path / "one").with_suffix(suffix).read_bytes()
        assert one == (tmp_path / "two").with_suffix(suffix).read_bytes()


def test_scans_alone_are_enough(bag: Path, tmp_path: Path) -> None:
    lines = tmp_path / "office.tum"
    done = run(bag, "--odometry", "none", "--trajectory", lines)
    assert "odometry: none" in done.out
    away = errors_m(poses_of(lines), [step.truth for step in STEPS])
    assert np.sqrt((away**2).mean()) < 0.06


def test_parameters_are_set(bag: Path, tmp_path: Path) -> None:
    stem = tmp_path / "coarse"
    assert run(bag, "--map", stem, "-p", "resolution_m:=0.1").code == 0
    assert read_occupancy_map(stem.with_suffix(".yaml")).resolution == 0.1
    failed = run(bag, "--map", tmp_path / "x", "-p", "resolution_m:=7.0")
    assert "resolution_m" in failed.err
    failed = run(bag, "--map", tmp_path / "x", "-p", "resolution:=0.1")
    assert "unknown parameter 'resolution'" in failed.err


def test_files_are_checked_before_the_work(bag: Path, tmp_path: Path) -> None:
    assert "nothing to write" in run(bag).err
    existing = tmp_path / "office.tum"
    existing.write_text("old", encoding="utf-8")
    assert "--overwrite replaces it" in run(bag, "--trajectory", existing).err
    assert existing.read_text(encoding="utf-8") == "old"
    missing = run(bag, "--map", tmp_path / "no" / "map")
    assert "does not exist" in missing.err


def test_wrong_topics_are_named(bag: Path, tmp_path: Path) -> None:
    lines = tmp_path / "office.tum"
    failed = run(bag, "--scan", "/laser", "--trajectory", lines)
    assert "'/laser'; known: /scan" in failed.err
    failed = run(bag, "--odometry", "/wheels", "--trajectory", lines)
    assert "'/wheels'; known: none" in failed.err
    assert not lines.exists()


def test_a_saved_map_is_continued_and_localised_in(bag: Path, tmp_path: Path) -> None:
    saved, again = tmp_path / "office.slam", tmp_path / "again.slam"
    done = run(bag, "--save", saved, "--json")
    assert done.code == 0, done
    keys = json.loads(done.out)["key_scans"]

    later = tmp_path / "later.mcap"
    poses = loop(0.2)[20:90]
    steps = list(drive(seed=9, poses=poses))
    write_bag(later, iter(steps))
    lines = tmp_path / "later.tum"
    done = run(
        later, "--continue", saved, "--localize", "--trajectory", lines, "--json"
    )
    assert done.code == 0, done
    assert json.loads(done.out)["key_scans"] == keys
    origin = STEPS[0].truth
    for row, step in zip(np.loadtxt(lines), steps, strict=True):
        truth = origin.inverse() @ step.truth
        assert np.hypot(row[1] - truth.x, row[2] - truth.y) < 0.05

    done = run(later, "--continue", saved, "--save", again, "--json")
    assert done.code == 0, done
    assert json.loads(done.out)["key_scans"] > keys
    done = run(later, "--continue", again, "--localize", "--trajectory", lines,
               "--overwrite", "--start", "3.9 0 0")  # fmt: skip
    assert done.code == 0, done


def test_a_damaged_map_is_refused(bag: Path, tmp_path: Path) -> None:
    lines = tmp_path / "x.tum"
    damaged = tmp_path / "damaged.slam"
    damaged.write_bytes(b"no archive")
    failed = run(bag, "--continue", damaged, "--trajectory", lines)
    assert failed.code == 2
    assert "no map of SLAM" in failed.err
    failed = run(bag, "--localize", "--trajectory", lines)
    assert "--localize needs a known map" in failed.err
    failed = run(bag, "--continue", tmp_path / "none.slam", "--trajectory", lines)
    assert "cannot be opened" in failed.err


def test_wrong_options_are_usage_errors(bag: Path, tmp_path: Path) -> None:
    """As for `navette sim`: exit code 2."""
    old = tmp_path / "old.yaml"
    old.touch()
    for words, text in (
        (("--map", old), "old.yaml: exists already; --overwrite replaces it"),
        ((), "nothing to write"),
        (("--map", tmp_path / "none" / "x"), "does not exist"),
    ):
        failed = run(bag, *words)
        assert failed.code == 2
        assert text in failed.err
