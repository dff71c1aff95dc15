"""``navette explore``: its options choose the methods, as those of ``sim`` do."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from navette.bags import open_bag
from navette.cli.app import app
from navette.cli.explore import _Screen
from navette.navigation.missions.explore.node import ExplorationReport

PLANNER = """
def plan(grid, start, goal):
    print("planned by my own")
    return None
"""


def test_methods_parameters_and_generated_worlds_are_taken(tmp_path: Path) -> None:
    own = tmp_path / "own.py"
    own.write_text(PLANNER, encoding="utf-8")
    words = ["explore", "rooms:1", "--headless", "--json", "--max-time", "6"]
    words += ["--planner", f"{own}:plan", "-p", "planner.goal_tolerance_m=0.4"]
    recording = tmp_path / "drive.mcap"
    words += ["--record", str(recording)]
    ended = CliRunner().invoke(app, words)
    assert "planned by my own" in ended.stdout
    with open_bag(recording) as bag:
        assert "/lidar" in {each.name for each in bag.topics}
    report = json.loads(ended.stdout[ended.stdout.index("{") :])
    assert report["goals"] >= 1


def test_one_goal_is_not_in_the_plural(capsys: pytest.CaptureFixture[str]) -> None:
    _Screen().on_end(ExplorationReport(goals=1), contacts=1)
    words = " ".join(capsys.readouterr().err.split())
    assert words.endswith("1 goal, 0 m driven in 0 s, 1 contact")


def test_methods_of_a_running_robot_are_refused() -> None:
    ended = CliRunner().invoke(app, ["explore", "--running", "--planner", "dijkstra"])
    assert ended.exit_code != 0
    assert "--planner" in str(ended.exception) + ended.stderr
    ended = CliRunner().invoke(app, ["explore", "--running", "--start", "1", "2", "0"])
    assert ended.exit_code != 0
    assert "--start" in str(ended.exception) + ended.stderr
    ended = CliRunner().invoke(app, ["explore", "--running", "--record", "x.mcap"])
    assert ended.exit_code != 0
    assert "navette bag record" in str(ended.exception) + ended.stderr


def test_a_world_whose_origin_is_in_a_wall_is_explored_from_a_start(
    tmp_path: Path,
) -> None:
    world = tmp_path / "walled.sdf"
    box = "<geometry><box><size>1 1 1</size></box></geometry>"
    world.write_text(
        "<sdf version='1.9'><world name='walled'><model name='block'>"
        f"<static>1</static><link name='l'><collision name='c'>{box}</collision>"
        "</link></model></world></sdf>",
        encoding="utf-8",
    )
    words = ["explore", str(world), "--headless", "--json", "--max-time", "3"]
    refused = CliRunner().invoke(app, words)
    assert "pass another start" in str(refused.exception) + refused.stderr
    ended = CliRunner().invoke(app, [*words, "--start", "-3", "0", "90"])
    assert json.loads(ended.stdout)["contacts"] == 0
