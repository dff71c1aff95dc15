"""Compiled ray casting against MuJoCo's own."""

from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

from navette.geometry import Pose2, Transform3, quaternion_from_rpy
from navette.sim import Scene, SimParams, Simulator, World, load_robot, load_world
from navette.sim.build import compile_scene
from navette.sim.camera import pixel_rays
from navette.sim.camera_gl import GlCamera, probe
from navette.sim.mount import Mount
from navette.sim.ray_kernels import BOX, cast_fan, cast_image
from navette.sim.scene import (
    Box,
    Capsule,
    Cylinder,
    Ellipsoid,
    Geometry,
    Link,
    Model,
    Shape,
    Sphere,
)
from navette.sim.sensor_specs import CameraSensor
from navette.sim.shape_table import ShapeTable, ring_directions

SPANS = pytest.mark.parametrize(
    ("first", "last"),
    [(-np.pi, np.pi), (-2.3, 2.3), (0.5, 2.0), (1.0, 1.0 + 2 * np.pi)],
)


def _random_shape(rng: np.random.Generator) -> Shape:
    a, b, c = rng.uniform(0.1, 1.2, 3)
    shapes: list[Shape] = [
        Box((a, b, c)), Cylinder(a, b), Capsule(a, b), Sphere(a), Ellipsoid((a, b, c))
    ]  # fmt: skip
    return shapes[rng.integers(len(shapes))]


def _random_scene(seed: int) -> Scene:
    """Shapes of all kinds with random poses around the origin."""
    rng = np.random.default_rng(seed)
    models = []
    for i in range(40):
        x, y, z = rng.uniform((-6, -6, 0), (6, 6, 2)).tolist()
        pose = Transform3((x, y, z), quaternion_from_rpy(*rng.uniform(-3, 3, 3)))
        shape = Geometry(name="s", shape=_random_shape(rng))
        link = Link(name="l", geometries=(shape,))
        models.append(
            Model(name=f"m{i}", world_T_model=pose, static=True, links=(link,))
        )
    base = World().scene()
    robot = load_robot("turtlebot3_burger").model
    scene = Scene(name="random", models=(*base.models, *models))
    return scene.with_robot(robot)


def _tilted(rng: np.random.Generator) -> Mount:
    """A slightly tilted view from near the centre."""
    x, y, z = rng.uniform(-1, 1, 3)
    roll, pitch, yaw = rng.uniform((-0.3, -0.3, -3), (0.3, 0.3, 3)).tolist()
    pose = Transform3((x, y, z + 1.5), quaternion_from_rpy(roll, pitch, yaw))
    return Mount(0, pose)  # body 0 is the world


def _shapes(seed: int) -> tuple[Any, Any, ShapeTable]:
    """Return model, data and shapes of a random scene."""
    model = Simulator(_random_scene(seed)).compiled.model
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    shapes = ShapeTable(model, (0, 1))
    shapes.update(data)
    return model, data, shapes


def _check_fan(
    model: Any, data: Any, mount: Mount, angles: np.ndarray, limit_m: float
) -> None:
    """Compare a fan of beams of up to 30 m with MuJoCo's, of up to the limit."""
    mujoco.mj_kinematics(model, data)
    shapes = ShapeTable(model, (0, 1))
    shapes.update(data)
    origin, rotation = mount.world(data)
    ours = np.empty(len(angles))
    cast_fan(
        shapes.kind, shapes.size, shapes.position, shapes.rotation, origin, rotation,
        angles, np.stack([np.cos(angles), np.sin(angles)]), 30.0, ours,
    )  # fmt: skip
    beams = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    theirs, _ = shapes.cast_with_mujoco(
        model, data, origin, beams @ rotation.T, limit_m
    )
    np.testing.assert_allclose(ours, theirs, rtol=1e-6)


@pytest.mark.parametrize("seed", range(8))
@SPANS
def test_fans_equal_mujocos(seed: int, first: float, last: float) -> None:
    simulator = Simulator(_random_scene(seed))
    model, data = simulator.compiled.model, mujoco.MjData(simulator.compiled.model)
    mount = _tilted(np.random.default_rng(seed))
    _check_fan(model, data, mount, np.linspace(first, last, 181), np.inf)


@pytest.mark.parametrize("yaw", [0.0, np.pi / 4, 1.0, -2.5])
@pytest.mark.parametrize("x", [0.0, 1e-12, 0.4])
def test_fans_from_inside_a_box_meet_its_faces(x: float, yaw: float) -> None:
    c, s = np.cos(yaw), np.sin(yaw)
    rotation = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    angles, found = np.linspace(-np.pi, np.pi, 181), np.empty(181)
    cast_fan(
        np.array([BOX]), np.array([(1.0, 0.5, 1.0)]), np.array([(x, 0.0, 0.0)]),
        rotation[None].copy(), np.zeros(3), np.eye(3), angles,
        np.stack([np.cos(angles), np.sin(angles)]), 30.0, found,
    )  # fmt: skip
    ends = found * np.stack([np.cos(angles), np.sin(angles)])
    ends[0] -= x
    on_box = np.abs(rotation[:2, :2].T @ ends) / [[1.0], [0.5]]
    np.testing.assert_allclose(on_box.max(axis=0), 1.0, rtol=1e-9)


@pytest.mark.parametrize("seed", range(8))
def test_fans_between_walls_equal_mujocos(seed: int) -> None:
    """The circle around a long wall contains the sensor, and its corners do not."""
    rng = np.random.default_rng(seed)
    world = World()
    for _ in range(12):
        x, y, yaw = rng.uniform((-6, -6, -3), (6, 6, 3)).tolist()
        size = (float(rng.uniform(0.5, 15)), float(rng.uniform(0.02, 0.3)))
        world.add_box((x, y), size, yaw=yaw)
    scene = world.scene().with_robot(load_robot("turtlebot3_burger").model)
    compiled = compile_scene(scene, timestep_s=0.005)
    model, data = compiled.model, mujoco.MjData(compiled.model)
    tilt = quaternion_from_rpy(*rng.uniform(-1e-3, 1e-3, 2).tolist(), 0.0)
    mount = Mount(0, Transform3((0.0, 0.0, 0.3), tilt))
    _check_fan(model, data, mount, np.linspace(-np.pi, np.pi, 361), 30.0)


@pytest.mark.parametrize("seed", range(6))
@SPANS
def test_rings_equal_mujocos(seed: int, first: float, last: float) -> None:
    model, data, shapes = _shapes(seed)
    pose = _tilted(np.random.default_rng(seed)).world(data)
    azimuths = np.linspace(first, last, 91)
    elevations = np.linspace(-1.5, 1.5, 15)
    ours, rows = shapes.cast_rings(model, data, pose, azimuths, elevations, 1e6)
    beams = ring_directions(azimuths, elevations).reshape(-1, 3)
    theirs, of = shapes.cast_with_mujoco(
        model, data, pose[0], beams @ pose[1].T, np.inf
    )
    np.testing.assert_allclose(ours.ravel(), theirs, rtol=1e-6)
    assert np.mean(rows.ravel() == of) > 0.999


@pytest.mark.parametrize("seed", range(8))
def test_images_equal_mujocos(seed: int) -> None:
    model, data, shapes = _shapes(seed)
    origin, rotation = _tilted(np.random.default_rng(seed + 50)).world(data)
    sensor = CameraSensor(name="c", width=48, height=36)
    depth, shape = np.empty((36, 48)), np.empty((36, 48), dtype=np.int32)
    focal = 24 / np.tan(sensor.horizontal_fov / 2)
    cast_image(
        shapes.kind, shapes.size, shapes.position, shapes.rotation, origin, rotation,
        focal, 0.0, 1e9, depth, shape,
    )  # fmt: skip
    theirs, rows = shapes.cast_with_mujoco(
        model, data, origin, pixel_rays(sensor) @ rotation.T, np.inf
    )
    np.testing.assert_allclose(
        np.where(shape < 0, np.inf, depth).ravel(), theirs, rtol=1e-6
    )
    assert np.mean(shape.ravel() == rows) > 0.999


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("reach", [2.0, 5.0])
def test_a_short_reach_changes_nothing_within_it(seed: int, reach: float) -> None:
    """Shapes that are further away are not tested at all."""
    model, data, shapes = _shapes(seed)
    pose = _tilted(np.random.default_rng(seed)).world(data)
    table = shapes.kind, shapes.size, shapes.position, shapes.rotation
    angles = np.linspace(-2.0, 2.0, 181)
    beams = np.stack([np.cos(angles), np.sin(angles)])

    def fan(reach: float) -> np.ndarray:
        distance = np.empty(len(angles))
        cast_fan(*table, *pose, angles, beams, reach, distance)
        return distance

    def rings(reach: float) -> np.ndarray:
        elevations = np.linspace(-1.5, 1.5, 15)
        return shapes.cast_rings(model, data, pose, angles, elevations, reach)[0]

    def image(reach: float) -> np.ndarray:
        depth, shape = np.empty((36, 48)), np.empty((36, 48), np.int32)
        cast_image(*table, *pose, 24.0, 0.0, reach, depth, shape)
        return depth

    for cast in (fan, rings, image):
        near, all_of_it = cast(reach), cast(1e6)
        np.testing.assert_array_equal(near[near < reach], all_of_it[all_of_it < reach])
        assert (near[all_of_it >= reach] >= reach).all()


MESH_WORLD = """<mujoco><asset><mesh name='tetra'
 vertex='0 0 0  2 0 0  0 2 0  0 0 2'/></asset><worldbody>
 <geom type='plane' size='0 0 1'/><geom type='mesh' mesh='tetra' pos='2 -1 0'
 rgba='0.9 0.1 0.1 1'/></worldbody></mujoco>"""


def test_meshes_are_visible(tmp_path: Path) -> None:
    path = tmp_path / "mesh.xml"
    path.write_text(MESH_WORLD)
    scene = load_world(path).with_robot(load_robot("turtlebot3_burger").model)
    simulator = Simulator(scene, start=Pose2(0, 0, 0))
    assert simulator.scan().ranges[0] == pytest.approx(2.03, abs=0.05)
    image = simulator.image()
    assert np.any(image[:, :, 0].astype(int) - image[:, :, 2] > 60)


@pytest.mark.slow
def test_opengl_is_used_if_available_and_refused_otherwise() -> None:
    scene = World().add_box((6.0, 2.5), (0.5, 1.0), height=0.4).scene()
    scene = scene.with_robot(load_robot("turtlebot3_burger").model)
    if probe() is None:
        with pytest.raises(ValueError, match="'gl' is not available"):
            Simulator(scene, SimParams(camera_renderer="gl"))
        Simulator(scene, SimParams(camera_renderer="auto")).image()
        return
    simulator = Simulator(scene, SimParams(camera_renderer="gl"))
    assert isinstance(simulator.cameras[0], GlCamera)
    drawn, cast = simulator.image(), Simulator(scene).image()
    for image in (drawn, cast):
        sky, floor = image[:60].mean(axis=(0, 1)), image[200:].mean(axis=(0, 1))
        assert sky[2] > sky[0] + 10
        assert abs(floor[2] - floor[0]) < 10
