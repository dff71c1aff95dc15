"""Models that follow a script: trajectories, SDF actors, physics, sensors, drawing."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from navette.errors import FileFormatError, InvalidValueError
from navette.geometry import Pose2
from navette.sim import Scene, SimParams, Simulator, World, load_robot
from navette.sim.messages import actors_message
from navette.sim.sdf import read_sdf
from navette.sim.trajectory import Trajectory, Waypoint

WALK = """<waypoint><time>0</time><pose>2 -1 1 0 0 1.57</pose></waypoint>
<waypoint><time>4</time><pose>2 1 1 0 0 1.57</pose></waypoint>"""


def _actor(script: str, inside: str = "") -> str:
    return f"<actor name='walker'>{inside}<script>{script}</script></actor>"


def _trajectory(waypoints: str = WALK, attributes: str = "id='0' type='walk'") -> str:
    return f"<trajectory {attributes}>{waypoints}</trajectory>"


def _read(tmp_path: Path, body: str) -> Scene:
    path = tmp_path / "w.sdf"
    path.write_text(f"<sdf version='1.9'>\n<world name='w'>\n{body}</world></sdf>")
    return read_sdf(path)


def _motion(scene: Scene) -> Trajectory:
    motion = scene.models[-1].motion
    assert motion is not None
    return motion


def _simulator(world: World, start: Pose2 | None = None) -> Simulator:
    scene = world.scene().with_robot(load_robot("jackal").model)
    return Simulator(scene, SimParams(), start=start or Pose2(0.0, 0.0, 0.0))


def test_straight_lines_at_constant_speed_loop_after_the_last_waypoint() -> None:
    motion = Trajectory(
        waypoints=(Waypoint(0, 0, 0), Waypoint(2, 2, 0), Waypoint(3, 2, 3)), delay_s=1.0
    )
    assert motion.at(0.5)[:2] == (0, 0)  # waits
    assert motion.at(2.0)[:2] == pytest.approx((1, 0))
    assert motion.at(3.5)[:2] == pytest.approx((2, 1.5))
    assert motion.at(4.5)[:2] == (0, 0)  # second cycle
    assert motion.fastest_mps() == pytest.approx(3.0)
    assert motion.jumps_within(3.95, 0.1)
    assert not motion.jumps_within(2.0, 0.1)


def test_without_loop_the_last_pose_remains() -> None:
    motion = Trajectory(waypoints=(Waypoint(0, 0, 0), Waypoint(2, 2, 0)), loop=False)
    assert motion.at(100.0)[:2] == (2, 0)


def test_spline_passes_through_waypoints_and_tension_1_stops_there() -> None:
    points = (Waypoint(0, 0, 0), Waypoint(2, 2, 0), Waypoint(4, 2, 2))
    for tension in (0.0, 0.5, 1.0):
        motion = Trajectory(waypoints=points, tension=tension, loop=False)
        for point in points:
            assert motion.at(point.time_s)[:2] == pytest.approx(point[1:3])
        moves = [math.dist(motion.at(t)[:2], motion.at(t + 1e-3)[:2]) * 1e3
                 for t in np.arange(0, 3.99, 0.01)]  # fmt: skip
        assert max(moves) <= motion.fastest_mps()
        here = math.dist(motion.at(1.999)[:2], motion.at(2.001)[:2]) / 0.002
        assert here == pytest.approx((1 - tension) * math.sqrt(0.5), abs=0.01)


def test_yaw_takes_the_short_way() -> None:
    motion = Trajectory(
        waypoints=(Waypoint(0, 0, 0, 0, 3.0), Waypoint(1, 0, 0, 0, -3.0))
    )
    assert abs(motion.at(0.5).yaw) == pytest.approx(math.pi)


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ({"waypoints": ()}, "without a waypoint"),
        ({"waypoints": (Waypoint(1, 0, 0),)}, "expected 0 s"),
        ({"waypoints": (Waypoint(0, 0, 0), Waypoint(0, 1, 0))}, "must increase"),
        ({"waypoints": (Waypoint(0, math.nan, 0),)}, "finite"),
        ({"waypoints": (Waypoint(0, 0, 0),), "delay_s": -1.0}, "delay"),
        ({"waypoints": (Waypoint(0, 0, 0),), "tension": 2.0}, "tension"),
    ],
)
def test_wrong_trajectories_are_refused(
    arguments: dict[str, object], text: str
) -> None:
    with pytest.raises(InvalidValueError, match=text):
        Trajectory(**arguments)  # type: ignore[arg-type]


def test_actor_of_a_world_file(tmp_path: Path) -> None:
    skin = "<skin><filename>walk.dae</filename></skin>"
    script = "<loop>false</loop><delay_start>1.5</delay_start>" + _trajectory()
    scene = _read(tmp_path, _actor(script, skin))
    motion = _motion(scene)
    assert motion.delay_s == 1.5
    assert not motion.loop
    assert motion.at(1.0)[:2] == (2, -1)
    x, y, z, yaw = motion.at(3.5)
    assert (x, y, z, yaw) == pytest.approx((2, 0, 0, 1.57))


def test_actor_starts_at_its_pose_and_trajectories_follow_each_other(
    tmp_path: Path,
) -> None:
    first = "<waypoint><time>2</time><pose>2 0 0 0 0 0</pose></waypoint>"
    second = "<waypoint><time>3</time><pose>2 3 0 0 0 0</pose></waypoint>"
    script = _trajectory(first) + _trajectory(second, "id='1' type='walk'")
    motion = _motion(_read(tmp_path, _actor(script, "<pose>0 0 0 0 0 0</pose>")))
    assert motion.at(0.0)[:2] == (0, 0)
    assert motion.at(2.0)[:2] == pytest.approx((2, 0))
    assert motion.at(5.0 - 1e-9)[:2] == pytest.approx((2, 3))
    assert motion.cycle_s == 5.0


def test_auto_start_false_stands(tmp_path: Path) -> None:
    script = "<auto_start>false</auto_start>" + _trajectory()
    assert _motion(_read(tmp_path, _actor(script))).at(50.0)[:2] == (2, -1)


def test_actor_with_links_has_their_shapes(tmp_path: Path) -> None:
    box = "<geometry><box><size>0.4 0.6 1</size></box></geometry>"
    link = f"<link name='l'><collision name='c'>{box}</collision></link>"
    scene = _read(tmp_path, _actor(_trajectory(), link))
    (geometry,) = scene.models[-1].links[0].geometries
    assert geometry.collides
    assert _motion(scene).at(0.0).z == 1.0


@pytest.mark.parametrize(
    ("actor", "text"),
    [
        ("<actor name='a'/>", "<script> is missing"),
        (_actor(_trajectory("")), "no <waypoint>"),
        (
            _actor(_trajectory("<waypoint><pose>0 0 0 0 0 0</pose></waypoint>")),
            "<time> is missing",
        ),
        (_actor(_trajectory("<waypoint><time>1</time></waypoint>")), "<pose>"),
        (
            _actor(
                _trajectory(
                    "<waypoint><time>2</time><pose>0 0 0 0 0 0</pose></waypoint>"
                    "<waypoint><time>1</time><pose>0 0 0 0 0 0</pose></waypoint>"
                )
            ),
            "1 s after 2 s; times must increase",
        ),
        (
            _actor(
                _trajectory(
                    "<waypoint><time>-1</time><pose>0 0 0 0 0 0</pose></waypoint>"
                )
            ),
            "must be >= 0",
        ),
        (_actor(_trajectory(WALK, "id='0' tension='3'")), "tension 3"),
        (_actor("<delay_start>-2</delay_start>" + _trajectory()), "must be >= 0"),
        (_actor("<loop>maybe</loop>" + _trajectory()), "'maybe' is not true or false"),
        (_actor(_trajectory()) * 2, "used twice"),
    ],
)
def test_wrong_actor_is_refused_with_its_line(
    tmp_path: Path, actor: str, text: str
) -> None:
    with pytest.raises(FileFormatError, match=text) as caught:
        _read(tmp_path, actor)
    assert "w.sdf:" in str(caught.value)


def test_lidar_sees_an_actor_where_its_script_is() -> None:
    world = World().add_actor([(0, 3, -2), (4, 3, 2), (8, 3, -2)], 0.3)
    simulator = _simulator(world)
    sensor_x = 0.055
    for time_s in (0.5, 2.0, 3.5):
        simulator.advance_to(round(time_s * 1e9))
        scan = simulator.scan()
        nearest = scan.angle_min + scan.angle_increment * int(np.argmin(scan.ranges))
        y = time_s - 2.0
        expected = math.hypot(3 - sensor_x, y) - 0.3
        assert float(scan.ranges.min()) == pytest.approx(expected, abs=0.01)
        assert nearest == pytest.approx(math.atan2(y, 3 - sensor_x), abs=0.02)


def test_contact_of_an_actor_that_hits_the_standing_robot_is_counted() -> None:
    simulator = _simulator(World().add_actor([(0, 3, 0), (2, -3, 0)], loop=False))
    simulator.step(1000)
    assert simulator.contacts.count == 1
    assert simulator.pose().to_pose2().x < -0.1  # pushed


def test_actor_that_jumps_into_the_robot_touches_it_at_once() -> None:
    """The script starts again where the robot stands."""
    world = World().add_actor([(0, 0.6, 0), (0.5, 6, 0)])
    simulator = _simulator(world, Pose2(0.0, 0.0, 0.0))
    simulator.advance_to(490_000_000)
    assert simulator.contacts.count == 0
    simulator.command(0.5, 0.0)
    simulator.advance_to(2_000_000_000)
    starts = [episode.start_ns for episode in simulator.contacts.episodes]
    assert starts
    assert min(start % 500_000_000 for start in starts) <= 20_000_000


def test_motion_does_not_depend_on_how_often_sensors_are_read() -> None:
    world = World().add_actor([(0, 2, -1), (1, 0.4, 0), (2, 2, 1)], 0.3)
    often, seldom = _simulator(world), _simulator(world)
    for _ in range(100):
        often.step(10)
        often.scan()
    seldom.step(1000)
    assert often.pose() == seldom.pose()
    assert often.contacts.episodes == seldom.contacts.episodes


def test_reset_starts_the_script_again() -> None:
    simulator = _simulator(World().add_actor([(0, 3, 0), (10, 6, 0)]))
    simulator.step(500)
    first = simulator.scan().ranges.copy()
    simulator.reset()
    simulator.step(500)
    assert np.array_equal(first, simulator.scan().ranges)


def test_actors_are_drawn_at_their_poses() -> None:
    simulator = _simulator(World().add_actor([(0, 3, 0), (10, 6, 0)], 0.25))
    message = actors_message(simulator.actors.poses(5_000_000_000), 5, "map")
    (marker,) = message.markers
    assert marker.pose.position.x == pytest.approx(4.5)
    assert (marker.type, marker.scale.x) == (marker.CYLINDER, 0.5)
    assert marker.header.frame_id == "map"


def test_obstacles_at_rest_sleep_until_the_robot_or_an_actor_touches_them(
    tmp_path: Path,
) -> None:
    """Without sleep each of them would be simulated all the time."""
    geometry = "<geometry><box><size>0.5 0.5 0.6</size></box></geometry>"

    def crate(name: str, x: float, y: float, z: float = 0.3) -> str:
        return (
            f"<model name='{name}'><pose>{x} {y} {z} 0 0 0</pose><link name='l'>"
            f"<inertial><mass>3</mass></inertial><collision name='c'>{geometry}"
            f"</collision><visual name='v'>{geometry}</visual></link></model>"
        )

    scripted = World().add_actor([(0, -3, 3), (4, -3, 3), (8, 1, 3)], loop=False)
    crates = crate("ahead", 2, 0), crate("aside", -1, 3), crate("alone", 0, -3)
    lifted = crate("falls", 0, -6, 0.5)
    loose = _read(tmp_path, "".join(crates) + lifted)
    scene = replace(loose, models=(*loose.models, *scripted.scene().models))
    params = SimParams(command_timeout_s=0.0, max_speed_mps=0.5)
    robot = load_robot("jackal").model
    simulator = Simulator(scene.with_robot(robot), params, start=Pose2(0, 0, 0))
    data = simulator._data

    def at(name: str) -> np.ndarray:
        return np.array(data.body(f"{name}/l").xpos)

    before = {name: at(name) for name in ("ahead", "aside", "alone")}
    simulator.advance_to(4_000_000_000)
    assert at("falls")[2] == pytest.approx(0.3, abs=0.01)
    assert data.ntree_awake == 1  # the robot
    simulator.command(0.5, 0.0)
    simulator.advance_to(9_000_000_000)
    assert at("ahead")[0] > before["ahead"][0] + 0.8  # pushed by the robot
    assert at("aside")[0] > before["aside"][0] + 2.0  # and by the actor
    np.testing.assert_allclose(at("alone"), before["alone"], atol=1e-3)
    assert simulator.contacts.count >= 1
