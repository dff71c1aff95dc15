"""Names, files, identification and derived parameters."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml

import navette.sim
from navette.errors import FileFormatError, UnknownNameError
from navette.geometry import Footprint, Pose2
from navette.sim import (
    SimParams,
    Simulator,
    derive_parameters,
    footprint_of,
    identify_robot,
    load_robot,
    load_world,
    robot_names,
    world_names,
)


def test_built_in_names() -> None:
    assert robot_names() == [
        "course",
        "husky",
        "jackal",
        "mecanum",
        "racecar",
        "turtlebot3_burger",
    ]
    assert {"arena", "course", "empty"} <= set(world_names())


@pytest.mark.parametrize("load", [load_world, load_robot])
def test_unknown_names_list_the_known(load: object) -> None:
    assert callable(load)
    with pytest.raises(UnknownNameError, match=r"'nowhere'; known: .*course"):
        load("nowhere")


def test_the_burger_has_the_makers_names() -> None:
    burger = load_robot("burger")
    assert burger.name == "turtlebot3_burger"
    assert burger.topic_names == {"/lidar": "/scan", "/odom/filtered": "/odom"}
    assert load_robot("jackal").topic_names == {}


def test_a_models_folder_may_name_its_topics(tmp_path: Path) -> None:
    model = Path(navette.sim.__file__).parent / "data/robots/husky/model.sdf"
    (tmp_path / "model.sdf").write_text(model.read_text())
    names = tmp_path / "names.yaml"
    names.write_text("/lidar: /front/scan\n")
    assert load_robot(tmp_path / "model.sdf").topic_names == {"/lidar": "/front/scan"}
    for wrong in ("/lidar: 3", "[1]", "lidar: /scan", "a: b: c"):
        names.write_text(wrong)
        with pytest.raises(FileFormatError, match=r"names\.yaml"):
            load_robot(tmp_path / "model.sdf")


def test_unknown_file_extensions_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "x.stl"
    path.write_text("")
    with pytest.raises(FileFormatError, match="unknown extension of a world file"):
        load_world(path)
    with pytest.raises(FileFormatError, match="unknown extension of a robot file"):
        load_robot(path)


@pytest.mark.parametrize("robot", ["course", "husky", "jackal", "turtlebot3_burger"])
@pytest.mark.parametrize("world", ["arena", "course"])
def test_every_robot_stands_in_every_world(robot: str, world: str) -> None:
    scene = load_world(world).with_robot(load_robot(robot).model)
    simulator = Simulator(scene)
    simulator.step(100)
    assert not simulator.contacts.episodes
    assert simulator.clearance().distance > 0.3
    start = load_world(world).start
    assert simulator.pose().to_pose2() == pytest.approx(start.to_pose2(), abs=0.02)
    assert abs(simulator.pose().translation[2]) < 0.005


@pytest.mark.parametrize(
    "name", ["course", "husky", "jackal", "mecanum", "racecar", "turtlebot3_burger"]
)
def test_parameter_files_fit_the_robot(name: str) -> None:
    robot = load_robot(name)
    assert robot.params_file is not None
    nodes = yaml.safe_load(robot.params_file.read_text())
    values = nodes["sim"]["ros__parameters"]
    SimParams.from_dict(values)
    reported = Footprint.from_flat(
        tuple(nodes["control"]["ros__parameters"]["footprint_m"])
    )
    shape = Footprint(footprint_of(robot.model))
    assert reported.circumscribed_radius == pytest.approx(
        shape.circumscribed_radius, abs=0.02
    )
    assert reported.inscribed_radius == pytest.approx(shape.inscribed_radius, abs=0.02)


def test_a_copy_of_a_built_in_robot_is_identified() -> None:
    model = load_robot("course").model
    found = identify_robot(replace(model, links=model.links))
    assert found is not None
    assert found.name == "course"
    assert found.params_file is not None
    assert identify_robot(replace(model, name="other")) is None


def test_another_robot_replaces_the_worlds_own() -> None:
    own = load_world("course").with_robot(load_robot("course").model)
    scene = own.with_robot(load_robot("jackal").model)
    assert scene.robot is not None
    assert scene.robot.name == "jackal"
    assert scene.robot.world_T_model.translation == (-6, 0, 0)


def test_derived_parameters_of_the_course_robot() -> None:
    derived = derive_parameters(load_robot("course").model)
    outline = Footprint.from_flat(tuple(derived["planner"]["footprint_m"]))  # type: ignore[arg-type]
    assert outline.circumscribed_radius == pytest.approx(1.58, abs=0.01)
    SimParams.from_dict(derived["sim"])
    assert derived["control"]["cruise_speed_mps"] == pytest.approx(0.7)


def test_start_inside_an_obstacle_is_refused() -> None:
    scene = load_world("course").with_robot(load_robot("jackal").model)
    with pytest.raises(ValueError, match="inside 'cylinder_1'"):
        Simulator(scene, start=Pose2(0, 0, 0))


@pytest.mark.parametrize("robot", ["course", "husky", "jackal", "turtlebot3_burger"])
@pytest.mark.parametrize("world", ["arena", "course", "pillar"])
def test_every_robots_lidar_hits_every_obstacle(robot: str, world: str) -> None:
    """A beam above an obstacle would let the robot drive into it."""
    scene = load_world(world).with_robot(load_robot(robot).model)
    simulator = Simulator(scene)
    simulator.step(400)  # the course robot falls to the floor first
    model, data = simulator.compiled.model, simulator._data
    [lidar] = simulator.lidars
    beam_m = lidar.mount.world(data)[0][2]
    for geom in np.flatnonzero(simulator.compiled.is_obstacle):
        top_m = data.geom_xpos[geom][2] + model.geom_aabb[geom][5]
        assert top_m > beam_m + 0.05, simulator.compiled.geom_owner[geom]
