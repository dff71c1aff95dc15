"""Robots with Ackermann steering and with mecanum wheels move as commanded."""

import math
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from navette.errors import FileFormatError, InvalidValueError
from navette.geometry import Footprint, Pose2
from navette.navigation.control.params import ControlParams
from navette.navigation.planning.params import PlannerParams
from navette.sim import __file__ as sim_file
from navette.sim import derive_parameters, footprint_of, load_robot, load_world
from navette.sim.drive_geometry import base_of, drive_wheels
from navette.sim.params import SimParams
from navette.sim.scene import AckermannDrive, Model, Scene
from navette.sim.sdf import read_sdf
from navette.sim.simulator import Simulator
from navette.sim.steering import steering_angles

LIMITS = {
    "racecar": SimParams(
        max_speed_mps=7.0,
        max_reverse_speed_mps=3.0,
        max_accel_mps2=7.0,
        max_decel_mps2=7.0,
        localization="odometry",
    ),
    "mecanum": SimParams(
        max_accel_mps2=3.0,
        max_reverse_speed_mps=1.0,
        max_yaw_accel_radps2=8.0,
        localization="odometry",
    ),
}


@cache
def scene(robot: str) -> Scene:
    return load_world("empty").with_robot(load_robot(robot).model)


def driven(
    robot: str, command: tuple[float, float, float], steps: int = 100
) -> Simulator:
    """Command speed, yaw rate and speed to the left for steps of 10 ms."""
    simulator = Simulator(scene(robot), LIMITS[robot], start=Pose2(0, 0, 0))
    for _ in range(steps):
        assert simulator.command(*command)
        simulator.step(5)
    return simulator


@pytest.mark.parametrize(
    "command",
    [(0.8, 0, 0), (0, 0, 0.6), (0, 0, -0.6), (0, 0.9, 0), (-0.5, -0.4, 0.4)],
)
def test_a_mecanum_platform_moves_in_every_direction(
    command: tuple[float, float, float],
) -> None:
    simulator = driven("mecanum", command)
    motion = simulator.motion()
    measured = motion.linear[0], motion.angular[2], motion.linear[1]
    assert measured == pytest.approx(command, abs=0.03)
    odometry = simulator.wheel_odometry()
    assert odometry.pose == pytest.approx(simulator.pose().to_pose2(), abs=0.06)


def test_mecanum_odometry_reports_the_speed_to_the_left() -> None:
    simulator = driven("mecanum", (0.0, 0.0, 0.5), 50)
    simulator.wheel_odometry().motion()
    for _ in range(20):
        simulator.command(0.0, 0.0, 0.5)
        simulator.step(5)
    assert simulator.wheel_odometry().motion().side == pytest.approx(0.5, abs=0.01)


@pytest.mark.parametrize(("speed", "steering"), [(1.0, 0.3), (1.5, -0.2), (-0.8, 0.41)])
def test_a_racecar_drives_the_circle_of_its_steering(
    speed: float, steering: float
) -> None:
    simulator = Simulator(scene("racecar"), LIMITS["racecar"], start=Pose2(0, 0, 0))
    for _ in range(150):
        assert simulator.steer(speed, steering)
        simulator.step(5)
    motion = simulator.motion()
    assert motion.linear[0] == pytest.approx(speed, rel=0.02)
    expected = speed * math.tan(steering) / 0.3302
    assert motion.angular[2] == pytest.approx(expected, rel=0.03)


def test_a_racecar_never_turns_tighter_than_its_steering_allows() -> None:
    simulator = driven("racecar", (0.5, 6.0, 0.0), 150)
    most = 0.5 * math.tan(0.41) / 0.3302
    assert simulator.motion().angular[2] == pytest.approx(most, rel=0.03)


def test_a_racecar_does_not_turn_in_place() -> None:
    simulator = driven("racecar", (0.0, 2.0, 0.0))
    assert simulator.motion().angular[2] == pytest.approx(0.0, abs=0.01)
    assert simulator.pose().to_pose2().yaw == pytest.approx(0.0, abs=0.01)


def test_both_steered_wheels_turn_about_the_same_centre() -> None:
    drive = load_robot("racecar").model.drive
    assert isinstance(drive, AckermannDrive)
    left, right = steering_angles(drive, 0.3)
    radius = drive.wheel_base / math.tan(0.3)
    half = drive.kingpin_width / 2
    assert math.tan(left) == pytest.approx(drive.wheel_base / (radius - half))
    assert math.tan(right) == pytest.approx(drive.wheel_base / (radius + half))


@pytest.mark.parametrize("steering", [-0.41, 0.2, 0.41])
def test_the_footprint_contains_the_steered_wheels(steering: float) -> None:
    model = load_robot("racecar").model
    assert isinstance(model.drive, AckermannDrive)
    outline = Footprint(footprint_of(model))
    angles = steering_angles(model.drive, steering)
    for y, angle in zip((0.12065, -0.12065), angles, strict=True):
        wheel = Pose2(0.3302, y, angle)
        tyre = [(x, across) for x in (-0.049, 0.049) for across in (-0.017, 0.017)]
        assert outline.contains(wheel.apply(np.array(tyre)), depth_m=1e-3).all()


def test_commands_that_are_not_finite_have_no_effect() -> None:
    for robot, bad in (("mecanum", (0.0, 0.0, math.nan)), ("racecar", (0.0, math.inf))):
        simulator = Simulator(scene(robot), LIMITS[robot], start=Pose2(0, 0, 0))
        assert not simulator.command(*bad)
    assert not simulator.steer(math.nan, 0.0)
    assert not simulator.steer(1.0, math.inf)


def test_only_steered_wheels_can_be_steered() -> None:
    simulator = Simulator(scene("mecanum"), LIMITS["mecanum"], start=Pose2(0, 0, 0))
    with pytest.raises(InvalidValueError, match="not steered"):
        simulator.steer(1.0, 0.1)


ACKERMANN = """<sdf version="1.9"><model name="m"><link name="l"/>
<plugin filename="gz-sim-ackermann-steering-system" name="AckermannSteering">
{content}</plugin></model></sdf>"""
MECANUM = ACKERMANN.replace("ackermann-steering", "mecanum-drive").replace(
    "AckermannSteering", "MecanumDrive"
)


@pytest.mark.parametrize(
    ("text", "content", "expected"),
    [
        (
            ACKERMANN,
            "<left_joint>a</left_joint><right_joint>b</right_joint>"
            "<wheel_separation>1</wheel_separation><wheel_radius>1</wheel_radius>",
            "left_steering_joint",
        ),
        (MECANUM, "<wheel_separation>1</wheel_separation>", "front_left_joint"),
    ],
)
def test_incomplete_plugins_name_what_is_missing(
    tmp_path: Path, text: str, content: str, expected: str
) -> None:
    path = tmp_path / "m.sdf"
    path.write_text(text.format(content=content), encoding="utf-8")
    with pytest.raises(FileFormatError, match=expected):
        read_sdf(path)


def test_the_models_have_their_drives() -> None:
    def kind(robot: str) -> str:
        model: Model = load_robot(robot).model
        return type(model.drive).__name__

    assert kind("racecar") == "AckermannDrive"
    assert kind("mecanum") == "MecanumDrive"


def test_bends_of_a_car_are_derived_from_its_model() -> None:
    derived = derive_parameters(load_robot("racecar").model)
    full_lock = 0.3302 / math.tan(0.41)
    planner = PlannerParams.from_dict(derived["planner"])
    control = ControlParams.from_dict(derived["control"])
    assert planner.drive == control.drive == derived["behaviors"]["drive"]
    assert planner.drive == "ackermann"
    assert planner.min_turning_radius_m == pytest.approx(0.85, abs=0.01)  # its file's
    assert full_lock < control.min_turning_radius_m < planner.min_turning_radius_m
    assert control.steering_time_s == pytest.approx(0.15, abs=0.02)


def test_sideways_motion_of_a_mecanum_platform_is_derived_from_its_model() -> None:
    derived = derive_parameters(load_robot("mecanum").model)
    control = ControlParams.from_dict(derived["control"])
    assert PlannerParams.from_dict(derived["planner"]).drive == control.drive == "omni"
    assert control.method == "omni_tracking"
    assert control.max_side_speed_mps == pytest.approx(0.6)
    assert SimParams.from_dict(derived["sim"]).max_side_speed_mps == 1.0


def _racecar_with(tmp_path: Path, old: str, new: str) -> Path:
    text = (Path(sim_file).parent / "data/robots/racecar/model.sdf").read_text("utf-8")
    assert text.count(old) == 1
    path = tmp_path / "car.sdf"
    path.write_text(text.replace(old, new), encoding="utf-8")
    return path


def test_driven_front_wheels_of_a_car_roll_freely(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """Gazebo's examples name both wheels of a side; the base is at the rear axle."""
    left = "<left_joint>rear_left_wheel</left_joint>"
    both = "<left_joint>front_left_wheel</left_joint>" + left
    model = load_robot(_racecar_with(tmp_path, left, both)).model
    original = load_robot("racecar").model
    assert base_of(model) == base_of(original)
    assert drive_wheels(model) == drive_wheels(original)
    assert "drive of steered wheels (they roll freely)" in caplog.text


def test_a_car_that_drives_with_its_front_wheels_only_is_refused(
    tmp_path: Path,
) -> None:
    left = "<left_joint>rear_left_wheel</left_joint>"
    front = "<left_joint>front_left_wheel</left_joint>"
    with pytest.raises(FileFormatError, match="not steered, at the rear"):
        load_robot(_racecar_with(tmp_path, left, front))
