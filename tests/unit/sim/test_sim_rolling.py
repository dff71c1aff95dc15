"""Wheels roll on ramps and sills without a contact, and hit kerbs and walls."""

from pathlib import Path

import pytest

from navette.errors import InvalidValueError
from navette.geometry import Pose2
from navette.sim import SimParams, Simulator, load_robot, load_world

PARAMS = SimParams(timestep_s=0.005, command_timeout_s=0.0)
STEPS_PER_S = 200


def simulator(
    folder: Path,
    robot: str,
    *,
    size: str,
    pose: str,
    static: bool = True,
    start: Pose2 = Pose2(0, 0, 0),  # noqa: B008 - a value that cannot change
) -> Simulator:
    """Return a simulator of a world with one box; the robot faces along x."""
    box = f"<geometry><box><size>{size}</size></box></geometry>"
    path = folder / "world.sdf"
    path.write_text(
        "<sdf version='1.9'><world name='w'><model name='thing'>"
        f"<static>{str(static).lower()}</static><pose>{pose}</pose><link name='l'>"
        "<inertial><mass>0.5</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz>"
        f"</inertia></inertial><collision name='c'>{box}</collision>"
        "</link></model></world></sdf>",
        encoding="utf-8",
    )
    scene = load_world(path).with_robot(load_robot(robot).model)
    return Simulator(scene, PARAMS, start=start)


def driven(sim: Simulator, seconds: float, speed: float = 0.5) -> Simulator:
    for _ in range(round(seconds)):
        sim.command(speed, 0.0)
        sim.step(STEPS_PER_S)
    return sim


@pytest.mark.parametrize("robot", ["jackal", "husky", "turtlebot3_burger"])
@pytest.mark.parametrize("degrees", [4.0, 12.0])
def test_driving_up_a_ramp_does_not_count_as_a_contact(
    tmp_path: Path, robot: str, degrees: float
) -> None:
    # The upper face of the board passes through the floor at x = 1.
    pitch, x, z = {4.0: (0.0698, 3.996, 0.1594), 12.0: (0.2094, 3.945, 0.5748)}[degrees]
    sim = driven(
        simulator(
            tmp_path, robot, size="6 4 0.1", pose=f"{x} 0 {z} 0 {-pitch} 0"
        ),
        5.0,
    )  # fmt: skip
    assert sim.pose().translation[2] > 0.05
    assert sim.contacts.count == 0
    assert sim.min_clearance.distance > 0.0


def test_a_door_sill_is_rolled_over(tmp_path: Path) -> None:
    sim = driven(
        simulator(tmp_path, "husky", size="0.2 4 0.01", pose="1.2 0 0.005 0 0 0"), 5.0
    )
    assert sim.pose().translation[0] > 2.0
    assert sim.contacts.count == 0


@pytest.mark.parametrize("robot", ["jackal", "husky"])
def test_a_wheel_that_hits_a_kerb_is_a_contact(tmp_path: Path, robot: str) -> None:
    sim = driven(
        simulator(tmp_path, robot, size="1 4 0.08", pose="1.5 0 0.04 0 0 0"), 5.0
    )
    assert sim.contacts.count >= 1
    assert "wheel" in sim.contacts.episodes[0].part
    assert sim.min_clearance.distance < 0.01


def test_a_wheel_that_rubs_along_a_kerb_is_a_contact(tmp_path: Path) -> None:
    kerb = simulator(
        tmp_path, "jackal", size="8 0.2 0.08", pose="2 0.4 0.04 0 0 0",
        start=Pose2(0, 0, 0.15),
    )  # fmt: skip
    sim = driven(kerb, 3.0)
    assert sim.contacts.count >= 1
    assert "wheel" in sim.contacts.episodes[0].part


def test_a_loose_board_under_a_wheel_was_hit(tmp_path: Path) -> None:
    board = simulator(
        tmp_path, "husky", size="0.3 2 0.01", pose="1.2 0 0.006 0 0 0", static=False
    )
    assert driven(board, 3.0).contacts.count >= 1


def test_a_start_with_the_wheels_in_an_obstacle_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidValueError, match="inside 'thing'"):
        simulator(tmp_path, "jackal", size="2 2 0.06", pose="0 0 0.03 0 0 0")
