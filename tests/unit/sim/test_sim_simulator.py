"""Physics, sensors and records of the simulator."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from navette.errors import InvalidValueError, ParameterError
from navette.geometry import Pose2
from navette.sim import (
    Scene,
    SimParams,
    Simulator,
    World,
    load_robot,
    load_world,
)
from navette.sim.scene import Model
from navette.sim.sensor_specs import LidarSensor, Sensor

COURSE = load_robot("course").model
FREE = SimParams(
    max_speed_mps=1.5, max_reverse_speed_mps=0.8, max_yaw_rate_radps=1.5,
    max_accel_mps2=1.5, max_yaw_accel_radps2=3.0, command_timeout_s=0.0,
)  # fmt: skip


def _scene(world: World, robot: str = "course") -> Scene:
    return world.scene().with_robot(load_robot(robot).model)


def _fast(robot: str) -> SimParams:
    limits = {"turtlebot3_burger": (0.22, 2.84), "jackal": (2, 4), "husky": (1, 2)}
    speed, yaw_rate = limits[robot]
    return SimParams(
        max_speed_mps=speed, max_reverse_speed_mps=speed, max_yaw_rate_radps=yaw_rate,
        max_accel_mps2=speed * 4, max_yaw_accel_radps2=yaw_rate * 4,
        command_timeout_s=0.0,
    )  # fmt: skip


def _with_blind_zone(robot: Model, metres: float) -> Model:
    def changed(sensor: Sensor) -> Sensor:
        is_lidar = isinstance(sensor, LidarSensor)
        return replace(sensor, range_min=metres) if is_lidar else sensor

    links = tuple(
        replace(link, sensors=tuple(map(changed, link.sensors))) for link in robot.links
    )
    return replace(robot, links=links)


def _settled(
    simulator: Simulator, linear: float, angular: float
) -> tuple[float, float]:
    """Return mean speed and yaw rate after two seconds of a command."""
    simulator.command(linear, angular)
    simulator.step(1000)
    motions = []
    for _ in range(20):
        simulator.step(10)
        motion = simulator.motion()
        motions.append((motion.linear[0], motion.angular[2]))
    v, w = np.mean(motions, axis=0)
    return float(v), float(w)


def test_the_course_robot_falls_1_m_and_comes_to_rest() -> None:
    scene = load_world("course")
    high = scene.start.translation[:2]
    robot = COURSE.at(scene.start @ COURSE.world_T_model)
    lifted = robot.world_T_model._replace(translation=(*high, 1.0))
    simulator = Simulator(scene.with_robot(COURSE).with_robot(COURSE.at(lifted)))
    simulator.step(1500)
    x, y, z = simulator.pose().translation
    assert abs(z) < 0.002
    assert math.hypot(*simulator.motion().linear) < 1e-3
    assert simulator.contacts.count == 0
    assert (x, y) == pytest.approx((-12.0, 0.0), abs=0.05)


@pytest.mark.parametrize(
    ("linear", "angular"),
    [(1.0, 0.0), (-0.5, 0.0), (0.0, 1.0), (0.8, 0.6), (0.3, -1.2)],
)
def test_the_course_robot_follows_commands(linear: float, angular: float) -> None:
    simulator = Simulator(_scene(World()), FREE, start=Pose2(0, 0, 0))
    v, w = _settled(simulator, linear, angular)
    assert v == pytest.approx(linear, rel=0.02, abs=0.02)
    assert w == pytest.approx(angular, rel=0.02, abs=0.005)


@pytest.mark.parametrize(
    ("robot", "linear", "angular", "within"),
    [
        ("turtlebot3_burger", 0.2, 0.0, 0.02),
        ("turtlebot3_burger", 0.0, 1.5, 0.02),
        ("jackal", 1.5, 0.0, 0.02),
        ("jackal", 0.0, 1.5, 0.08),
        ("jackal", 1.0, 1.0, 0.10),
        ("husky", 0.8, 0.0, 0.02),
        ("husky", 0.0, 1.0, 0.08),
        ("husky", 0.5, 0.5, 0.08),
    ],
)
def test_other_robots_follow_commands_closely(
    robot: str, linear: float, angular: float, within: float
) -> None:
    simulator = Simulator(_scene(World(), robot), _fast(robot), start=Pose2(0, 0, 0))
    v, w = _settled(simulator, linear, angular)
    assert v == pytest.approx(linear, rel=0.05, abs=0.02)
    assert w == pytest.approx(angular, rel=within, abs=0.005)


def test_commands_time_out() -> None:
    params = SimParams(command_timeout_s=0.5)
    simulator = Simulator(_scene(World()), params, start=Pose2(0, 0, 0))
    simulator.command(0.4, 0.0)
    simulator.step(240)
    assert simulator.motion().linear[0] > 0.35
    simulator.step(500)
    assert abs(simulator.motion().linear[0]) < 0.01


def test_bad_commands_are_refused() -> None:
    simulator = Simulator(_scene(World()), start=Pose2(0, 0, 0))
    assert not simulator.command(math.nan, 0.0)
    simulator.step(50)
    assert abs(simulator.motion().linear[0]) < 1e-3


def _drive_about(simulator: Simulator, stride: int) -> bytes:
    for i in range(40):
        simulator.command(0.8 - 0.03 * i, 0.5 * math.sin(i))
        for _ in range(100 // stride):
            simulator.step(stride)
    return np.array(
        [*simulator.pose().translation, *simulator.pose().rotation]
    ).tobytes()


@pytest.mark.slow
def test_the_same_run_twice_is_equal_bit_for_bit() -> None:
    scene = load_world("arena").with_robot(COURSE)
    first = Simulator(scene, FREE)
    end = _drive_about(first, 100)
    assert _drive_about(Simulator(scene, FREE), 100) == end
    first.reset()
    assert first.now_ns == 0
    assert _drive_about(first, 100) == end


@pytest.mark.slow
def test_reading_sensors_does_not_change_the_state() -> None:
    scene = load_world("arena").with_robot(COURSE)
    plain, watched = Simulator(scene, FREE), Simulator(scene, FREE)
    end = _drive_about(plain, 100)
    step = watched.step

    def look_and_step(count: int) -> None:
        watched.scan()
        watched.imu()
        watched.clearance()
        step(count)

    watched.step = look_and_step  # type: ignore[method-assign]
    assert _drive_about(watched, 25) == end


def test_noise_depends_only_on_the_seed() -> None:
    def ranges(seed: int) -> bytes:
        params = SimParams(seed=seed, lidar_noise_m=0.02, lidar_dropout=0.1)
        simulator = Simulator(load_world("course").with_robot(COURSE), params)
        return simulator.scan().ranges.tobytes()

    assert ranges(1) == ranges(1)
    assert ranges(1) != ranges(2)


def test_ranges_are_exact_and_do_not_see_the_robot() -> None:
    world = World().add_box((4.3, 0.0), (1.0, 8.0), height=3.0)
    simulator = Simulator(_scene(world), start=Pose2(0, 0, 0))
    scan = simulator.scan()
    angles = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges))
    # The wall's face is at 3.8 m, the lidar 1.3 m ahead of the axle.
    hits = np.abs(np.tan(angles) * 2.5) < 3.9
    hits &= np.cos(angles) > 0
    np.testing.assert_allclose(scan.ranges[hits], 2.5 / np.cos(angles[hits]), rtol=1e-3)
    assert np.all(np.isinf(scan.ranges[np.cos(angles) < 0]))
    assert scan.angle_min + scan.angle_increment * 255 == pytest.approx(3.14159)


def test_dropped_beams_are_nan_and_near_ones_minus_infinity() -> None:
    params = SimParams(lidar_dropout=1.0)
    simulator = Simulator(_scene(World()), params, start=Pose2(0, 0, 0))
    assert np.all(np.isnan(simulator.scan().ranges))
    world = World().add_box((2.2, 0.0), (1.0, 8.0), height=3.0)
    near = Simulator(world.scene().with_robot(_with_blind_zone(COURSE, 0.5)))
    assert np.isneginf(near.scan().ranges[128])


def test_clearance_is_exact() -> None:
    world = World().add_cylinder((5.0, 0.0), 1.0).add_box((-3.0, 0.0), (1.0, 1.0))
    simulator = Simulator(_scene(world), start=Pose2(0, 0, 0))
    clearance = simulator.clearance()
    assert clearance.distance == pytest.approx(2.0, abs=1e-6)
    assert clearance.obstacle.startswith("box")
    turned = Simulator(_scene(world), start=Pose2(0, 0, math.pi / 2))
    assert turned.clearance().distance == pytest.approx(2.5 - 0.7, abs=1e-3)


def test_contacts_are_distinguished_and_counted_once() -> None:
    world = World().add_box((3.0, 0.0), (1.0, 4.0), height=1.0)
    simulator = Simulator(_scene(world), FREE, start=Pose2(0, 0, 0))
    simulator.command(0.8, 0.0)
    simulator.step(2000)
    (episode,) = simulator.contacts.episodes
    assert episode.part == "robot/chassis"
    assert episode.obstacle.startswith("box")
    assert 1.0e9 < episode.start_ns < 2.5e9
    assert episode.end_ns > episode.start_ns
    assert simulator.min_clearance.distance < 0.001
    simulator.reset()
    assert simulator.contacts.count == 0


def test_imu_measures_gravity_turning_and_acceleration() -> None:
    simulator = Simulator(_scene(World()), FREE, start=Pose2(0, 0, 0))
    simulator.step(500)
    still = simulator.imu()
    np.testing.assert_allclose(still.linear_acceleration, [0, 0, 9.81], atol=1e-3)
    np.testing.assert_allclose(still.angular_velocity, 0, atol=1e-3)
    simulator.command(0.0, 1.0)
    simulator.step(1000)
    simulator.imu()
    simulator.step(5)
    turning = simulator.imu()
    assert turning.angular_velocity[2] == pytest.approx(1.0, abs=0.01)
    # The sensor sits 0.5 m ahead of the axle: centripetal −ω² r.
    assert turning.linear_acceleration[0] == pytest.approx(-0.5, abs=0.03)
    simulator.command(0.0, 0.0)
    simulator.step(1000)
    simulator.command(1.5, 0.0)
    simulator.step(100)
    simulator.imu()
    simulator.step(50)
    assert simulator.imu().linear_acceleration[0] == pytest.approx(1.5, abs=0.1)


def test_wheel_odometry_drifts_only_with_slip_and_noise() -> None:
    def error(noise: float) -> float:
        params = SimParams(
            wheel_noise_m=noise, command_timeout_s=0.0, localization="odometry"
        )
        simulator = Simulator(_scene(World()), params, start=Pose2(1, 2, 0.5))
        simulator.command(0.8, 0.3)
        for _ in range(50):
            simulator.step(100)
            simulator.wheel_odometry()
        truth = simulator.pose().to_pose2()
        return truth.distance_to(simulator.wheel_odometry().pose)

    assert error(0.0) < 0.1
    assert error(0.1) > 0.2


def test_a_longer_step_is_as_accurate() -> None:
    params = SimParams(timestep_s=0.005, command_timeout_s=0.0)
    simulator = Simulator(_scene(World()), params, start=Pose2(0, 0, 0))
    v, w = _settled(simulator, 0.8, 0.5)
    assert (v, w) == pytest.approx((0.8, 0.5), rel=0.02)


@pytest.mark.parametrize("step", [0.003, 0.004, 0.02, 0.0])
def test_steps_that_do_not_fit_the_motor_cycle_are_refused(step: float) -> None:
    with pytest.raises(ParameterError, match="'timestep_s'"):
        SimParams(timestep_s=step)


def test_limits_can_change_while_driving() -> None:
    simulator = Simulator(_scene(World()), FREE, start=Pose2(0, 0, 0))
    simulator.change_params(SimParams(max_speed_mps=0.2, command_timeout_s=0.0))
    v, _ = _settled(simulator, 1.0, 0.0)
    assert v == pytest.approx(0.2, rel=0.02)


def test_a_world_without_a_robot_is_refused() -> None:
    with pytest.raises(ValueError, match="no robot"):
        Simulator(World("lonely").scene())


def test_many_static_shapes_do_not_collide() -> None:
    world = World()
    for i in range(300):
        world.add_cylinder((3 + 0.1 * (i % 20), 0.1 * (i // 20)), 0.075)
    simulator = Simulator(_scene(world, "jackal"), start=Pose2(0, 0, 0))
    simulator.step(50)
    assert simulator.compiled.model.nbody < 10
    assert simulator.contacts.count == 0


def test_a_robot_fixed_to_the_world_is_refused() -> None:
    scene = World().scene().with_robot(replace(COURSE, static=True))
    with pytest.raises(ValueError, match="'robot' is fixed to the world"):
        Simulator(scene)


CRATE = """<sdf version='1.9'><world name='w'><model name='crate'>
<pose>3 0 0.25 0 0 0</pose><link name='l'><inertial><mass>2</mass><inertia>
<ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial>
<collision name='c'><geometry><box><size>0.5 0.5 0.5</size></box></geometry></collision>
<visual name='c'><geometry><box><size>0.5 0.5 0.5</size></box></geometry></visual>
</link></model></world></sdf>"""


def test_movable_models_can_be_pushed_and_are_visible(tmp_path: Path) -> None:
    path = tmp_path / "crate.sdf"
    path.write_text(CRATE)
    scene = load_world(path).with_robot(load_robot("jackal").model)
    params = SimParams(command_timeout_s=0.0, max_speed_mps=0.5)
    simulator = Simulator(scene, params, start=Pose2(2.0, 0, 0))
    before = simulator.scan().ranges[360]
    assert before == pytest.approx(0.75 - 0.055, abs=0.02)
    simulator.command(0.5, 0.0)
    simulator.step(2000)
    assert simulator.contacts.count >= 1
    assert simulator.pose().translation[0] > 3.0  # where the crate was
    assert simulator.scan().ranges[360] == pytest.approx(0.2, abs=0.03)


def test_a_start_in_an_obstacle_is_refused_also_the_worlds_own() -> None:
    world = World().add_cylinder((0.0, 0.0), 1.5)
    with pytest.raises(InvalidValueError, match=r"start \(0.1, 0, 90°\): .*cylinder"):
        Simulator(_scene(world), start=Pose2(0.1, 0, math.pi / 2))
    with pytest.raises(InvalidValueError, match=r"pass another start.*cylinder"):
        Simulator(_scene(world))


def test_diverging_physics_raises_an_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    simulator = Simulator(_scene(World()), start=Pose2(0, 0, 0))
    simulator.step(100)
    simulator._data.qvel[0] = math.inf
    with pytest.raises(InvalidValueError, match="physics became unstable"):
        simulator.step(100)
    assert not list(tmp_path.iterdir())  # MuJoCo would write its log here
