"""URDF for viewers, read back by the URDF reader."""

import re
from pathlib import Path

import pytest

from navette.geometry import Pose2
from navette.sim import SimParams, Simulator, World, load_robot, load_world, robot_names
from navette.sim.description import describe_robot, describe_world
from navette.sim.frames import RobotFrames

COURSE_FRAMES = SimParams(base_frame="robot", link_frame_prefix="robot/")


@pytest.mark.parametrize("name", robot_names())
def test_robot_description(tmp_path: Path, name: str) -> None:
    scene = World().scene().with_robot(load_robot(name).model)
    simulator = Simulator(scene, start=Pose2(0, 0, 0))
    frames = RobotFrames(simulator.compiled.robot, SimParams())
    path = tmp_path / "robot.urdf"
    path.write_text(describe_robot(simulator.compiled, frames))
    model = load_world(path).models[0]
    assert model.links[0].name == "base_link"
    assert {link.name for link in model.links} == {
        "base_link",
        *(link.name for link in load_robot(name).model.links),
    }
    for link in model.links[1:]:
        reported = link.model_T_link.translation
        assert reported == pytest.approx(
            simulator.link_in_base(link.name).translation, abs=2e-3
        )


def test_course_frames_are_the_public_ones() -> None:
    scene = World().scene().with_robot(load_robot("course").model)
    simulator = Simulator(scene, start=Pose2(0, 0, 0))
    frames = RobotFrames(simulator.compiled.robot, COURSE_FRAMES)
    assert frames.fixed_pose("robot/chassis/lidar").translation == pytest.approx(
        (1.3, 0, 0.9)
    )
    assert frames.moving["left_wheel"] == "robot/left_wheel"
    with pytest.raises(ValueError, match=r"'no' is not fixed .*robot/chassis"):
        frames.fixed_pose("no")


def test_world_description(tmp_path: Path) -> None:
    scene = load_world("course").with_robot(load_robot("jackal").model)
    simulator = Simulator(scene)
    path = tmp_path / "world.urdf"
    path.write_text(describe_world(simulator.compiled, "map"))
    (model,) = load_world(path).models
    assert [link.name for link in model.links] == ["map"]
    assert len(model.links[0].geometries) == 12  # floor, 4 walls, 5 boxes, 2 cylinders
    names = re.findall(r'<visual name="([^"]+)"', path.read_text())
    assert len(names) == 12
    assert "wall_north" in names
