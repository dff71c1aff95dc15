"""URDF, map_server maps and MJCF as worlds and robots."""

import logging
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from navette.errors import FileFormatError
from navette.geometry import Pose2
from navette.sim import Simulator, load_robot, load_world
from navette.sim.occupancy_map import merge_runs
from navette.sim.scene import Box
from navette.sim.sensor_specs import LidarSensor

ROBOT = """<robot name='r'>
<material name='red'><color rgba='1 0 0 1'/></material>
<link name='base'>
 <visual><geometry><box size='0.4 0.3 0.1'/></geometry><material name='red'/></visual>
 <collision><geometry><box size='0.4 0.3 0.1'/></geometry></collision>
 <inertial><mass value='5'/><inertia ixx='0.1' iyy='0.1' izz='0.1'/></inertial>
</link>
{wheels}
<link name='ball'><collision><geometry><sphere radius='0.05'/></geometry></collision>
 <inertial><mass value='0.1'/><inertia ixx='1e-3' iyy='1e-3' izz='1e-3'/></inertial>
</link>
<joint name='ball_joint' type='fixed'><parent link='base'/><child link='ball'/>
 <origin xyz='-0.15 0 -0.05'/></joint>
<gazebo reference='ball'><mu1>0.01</mu1></gazebo>
<gazebo reference='base'><sensor name='scan' type='ray'><ray><scan><horizontal>
 <samples>5</samples><min_angle>-0.5</min_angle><max_angle>0.5</max_angle></horizontal>
 </scan><range><min>0.1</min><max>5</max></range></ray></sensor></gazebo>
<gazebo><plugin name='d' filename='libgazebo_ros_diff_drive.so'>
 <left_joint>left</left_joint><right_joint>right</right_joint>
 <wheel_separation>0.4</wheel_separation><wheel_diameter>0.2</wheel_diameter>
</plugin></gazebo></robot>"""
WHEEL = """<link name='{n}_wheel'><collision><geometry><cylinder radius='0.1'
 length='0.04'/></geometry></collision><inertial><mass value='0.5'/>
 <inertia ixx='1e-3' iyy='1e-3' izz='2e-3'/></inertial></link>
<joint name='{n}' type='continuous'><parent link='base'/><child link='{n}_wheel'/>
 <origin xyz='0.1 {y} 0' rpy='-1.5707963 0 0'/><axis xyz='0 0 1'/></joint>"""


def _robot_file(tmp_path: Path) -> Path:
    wheels = WHEEL.format(n="left", y=0.2) + WHEEL.format(n="right", y=-0.2)
    path = tmp_path / "r.urdf"
    path.write_text(ROBOT.replace("{wheels}", wheels))
    return path


def test_urdf_robot_drives(tmp_path: Path) -> None:
    robot = load_robot(_robot_file(tmp_path))
    assert robot.name == "r"
    assert robot.params_file is None
    base = robot.model.link("base")
    assert base.geometries[0].colour == (1, 0, 0, 1)
    (sensor,) = base.sensors
    assert isinstance(sensor, LidarSensor)
    assert not sensor.sees_visuals
    assert robot.model.link("ball").geometries[0].friction == 0.01
    simulator = Simulator(
        load_world("empty").with_robot(robot.model), start=Pose2(0, 0, 0)
    )
    simulator.command(0.3, 0.0)
    simulator.step(200)
    assert simulator.motion().linear[0] == pytest.approx(0.3, abs=0.02)


def test_urdf_environment_without_collisions_is_solid(tmp_path: Path) -> None:
    path = tmp_path / "env.urdf"
    path.write_text(
        "<robot name='e'><link name='world'/><link name='wall'><visual><geometry>"
        "<box size='1 2 3'/></geometry></visual></link>"
        "<joint name='j' type='fixed'><origin xyz='5 0 0'/><parent link='world'/>"
        "<child link='wall'/></joint></robot>"
    )
    (model,) = load_world(path).models
    assert model.static
    wall = model.link("wall")
    assert wall.model_T_link.translation == (5, 0, 0)
    assert wall.geometries[0].collides


def test_urdf_links_without_joints_are_named(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    path = tmp_path / "loose.urdf"
    path.write_text("<robot name='e'><link name='a'/><link name='b'/></robot>")
    with caplog.at_level(logging.WARNING):
        load_world(path)
    assert "link without a joint" in caplog.text


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("<robot name='r'/>", "has no links"),
        ("<sdf/>", "must be <robot>"),
        (
            "<robot name='r'><link name='a'/><link name='b'/>"
            "<joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint>"
            "<joint name='k' type='fixed'><parent link='b'/><child link='a'/></joint>"
            "</robot>",
            "circle",
        ),
        (
            "<robot name='r'><link name='a'/><joint name='j' type='fixed'>"
            "<parent link='a'/><child link='x'/></joint></robot>",
            "no link 'x'",
        ),
        (
            "<robot name='r'><link name='a'><visual><geometry><box size='1 2'/>"
            "</geometry></visual></link></robot>",
            "2 numbers; expected 3",
        ),
    ],
)
def test_broken_urdf(tmp_path: Path, text: str, reason: str) -> None:
    path = tmp_path / "broken.urdf"
    path.write_text(text)
    with pytest.raises(FileFormatError, match=reason):
        load_world(path)


def _map_file(tmp_path: Path, extra: str = "") -> Path:
    pixels = np.full((4, 6), 254, dtype=np.uint8)
    pixels[0, :] = 0  # the top row of the image is the far (+y) side
    pixels[1:3, 2] = 0
    pixels[3, 5] = 205  # unknown
    Image.fromarray(pixels).save(tmp_path / "m.pgm")
    path = tmp_path / "m.yaml"
    path.write_text(
        "image: m.pgm\nresolution: 0.5\norigin: [-1.0, 2.0, 0.0]\nnegate: 0\n"
        f"occupied_thresh: 0.65\nfree_thresh: 0.196\n{extra}"
    )
    return path


def test_map_becomes_wall_boxes(tmp_path: Path) -> None:
    scene = load_world(_map_file(tmp_path))
    walls = scene.models[0].link("walls").geometries
    sizes = {(g.shape.size[:2]) for g in walls if isinstance(g.shape, Box)}
    assert sizes == {(0.5, 1.0), (3.0, 0.5)}
    far = next(g for g in walls if g.shape == Box((3.0, 0.5, 1.0)))
    assert far.link_T_shape.translation == pytest.approx((0.5, 3.75, 0.5))


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("image: gone.pgm", "cannot be read"),
        ("resolution: -1", "must be > 0"),
        ("origin: [0, 0]", "'origin'"),
        ("mode: funny", "mode 'funny'"),
        ("resolution: .nan", "finite"),
        ("resolution: [", "not YAML"),
        ("occupied_thresh: 0.1", "free_thresh < occupied_thresh"),
        ("occupied_thresh: 65", "occupied_thresh <= 1"),
    ],
)
def test_broken_maps(tmp_path: Path, line: str, reason: str) -> None:
    with pytest.raises(FileFormatError, match=reason):
        load_world(_map_file(tmp_path, line))


def test_merged_runs_of_a_plus() -> None:
    grid = np.zeros((3, 3), dtype=np.bool_)
    grid[1, :] = grid[:, 1] = True
    assert merge_runs(grid) == [(0, 1, 1, 1), (1, 0, 1, 3), (2, 1, 1, 1)]


def test_mjcf_world_takes_a_robot(tmp_path: Path) -> None:
    path = tmp_path / "room.xml"
    path.write_text(
        "<mujoco model='room'><worldbody><geom type='plane' size='0 0 1'/>"
        "<geom name='wall' type='box' size='0.1 2 1' pos='2 0 1'/></worldbody></mujoco>"
    )
    scene = load_world(path).with_robot(load_robot("turtlebot3_burger").model)
    simulator = Simulator(scene, start=Pose2(0, 0, 0))
    ahead = simulator.scan().ranges[0]
    assert ahead == pytest.approx(1.9 + 0.032, abs=0.02)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("<robot/>", "must be <mujoco>"),
        (
            "<mujoco><asset><mesh file='../../x.stl'/></asset></mujoco>",
            "is outside the file's folder",
        ),
        ("<mujoco><extension/></mujoco>", "plugins"),
        ("<mujoco><include file='room.xml'/></mujoco>", "included twice"),
    ],
)
def test_unsafe_mjcf_is_refused(tmp_path: Path, text: str, reason: str) -> None:
    path = tmp_path / "room.xml"
    path.write_text(text)
    with pytest.raises(FileFormatError, match=reason):
        load_world(path)
