"""The stack as processes in lock-step: repeatable, and a failed process is named."""

import os
import signal
import subprocess
from pathlib import Path

import pytest
from fleet import PATIENCE_S, STACK, Fleet, until

from free_ports import free_endpoint
from navette.bags import open_bag
from navette.msgs import deserialize
from navette.msgs.nav_msgs.msg import Odometry

pytestmark = [
    pytest.mark.long,
    pytest.mark.slow,
    pytest.mark.skipif(os.name != "posix", reason="signals are POSIX's"),
]

WORLD = ("--world", "course")
FOLLOW = {"NAVETTE_LOCKSTEP": "follow", "PYTHONFAULTHANDLER": "1"}
GOAL = (-4.8, -2.2)
UNTIL_S = 6.0


def fleet_in(folder: Path) -> Fleet:
    folder.mkdir()
    return Fleet(folder, {"NAVETTE_ROUTER": free_endpoint()})


def follow(fleet: Fleet, name: str, *words: str) -> None:
    fleet.start(name, "navette", name, *words, env=FOLLOW)


def end_of(fleet: Fleet, name: str) -> int:
    """Return the exit code; a process that does not end prints its stack traces."""
    process = fleet.running[name]
    try:
        return process.wait(PATIENCE_S)
    except subprocess.TimeoutExpired:
        process.send_signal(signal.SIGABRT)
        return process.wait(20.0)


def drive(folder: Path) -> bytes:
    """Drive with seven processes; return the content of the bag."""
    bag = folder / "bag.mcap"
    with fleet_in(folder) as fleet:
        for stage in STACK:
            follow(fleet, stage, *WORLD)
        follow(fleet, "missions", *WORLD, "--goal", *map(str, GOAL))
        follow(fleet, "recorder", str(bag))
        names = ",".join(fleet.running)
        run = ("--lockstep", names, "--lockstep-until", str(UNTIL_S))
        fleet.start("sim", "navette", "sim", *WORLD, *run)
        for name in fleet.running:
            assert end_of(fleet, name) == 0, f"{name}: {fleet.output(name)}"
        assert any(
            "lock-step: 600 steps to 6 s" in line for line in fleet.output("sim")
        )
    return bag.read_bytes()


def differences(first: Path, second: Path) -> str:
    """Return the topics whose messages differ; pytest's own text takes minutes."""
    contents = []
    for folder in (first, second):
        with open_bag(folder / "bag.mcap") as bag:
            by_topic: dict[str, list[bytes]] = {}
            for message in bag.messages():
                by_topic.setdefault(message.topic.name, []).append(message.data)
            contents.append(by_topic)
    ours, theirs = contents
    differ = {t for t in ours.keys() | theirs.keys() if ours.get(t) != theirs.get(t)}
    counts = (f"{t}: {len(ours.get(t, ()))}, {len(theirs.get(t, ()))}" for t in differ)
    return "messages that differ: " + ("; ".join(sorted(counts)) or "their order")


def test_two_runs_of_the_split_stack_produce_the_same_bag(tmp_path: Path) -> None:
    """Byte for byte, including /rosout; and the robot reaches the goal."""
    first = drive(tmp_path / "first")
    with open_bag(tmp_path / "first/bag.mcap") as bag:
        last_data = list(bag.messages(["/ground_truth"]))[-1].data
    last = deserialize(last_data, Odometry).pose.pose.position
    assert ((last.x - GOAL[0]) ** 2 + (last.y - GOAL[1]) ** 2) ** 0.5 < 0.6
    is_same = drive(tmp_path / "second") == first
    assert is_same, differences(tmp_path / "first", tmp_path / "second")


@pytest.mark.parametrize(
    ("kind", "limit", "error_text"),
    [
        (signal.SIGKILL, "60", "gone at"),
        (signal.SIGSTOP, "2", "no response within 2 s"),
    ],
)
def test_a_process_that_fails_or_hangs_is_named(
    kind: signal.Signals, limit: str, error_text: str, tmp_path: Path
) -> None:
    with fleet_in(tmp_path / "run") as fleet:
        for stage in ("planner", "control"):
            follow(fleet, stage, *WORLD)
        run = ("--lockstep", "planner,control", "--lockstep-limit", limit)
        fleet.start("sim", "navette", "sim", *WORLD, *run)
        until(lambda: "begins, with" in "".join(fleet.output("sim")), "the beginning")
        fleet.running["control"].send_signal(kind)
        assert end_of(fleet, "sim") == 1
        assert end_of(fleet, "planner") == 1
        (error,) = [line for line in fleet.output("sim") if "navette:" in line]
        assert error.startswith(f"navette: lock-step: {error_text}")
        assert "/control" in error  # and the nodes that wait for its messages
        assert "the simulator is gone" in fleet.output("planner")[-1]
