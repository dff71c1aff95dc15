"""The ray-cast camera."""

import numpy as np

from navette.geometry import Pose2
from navette.sim import Simulator, World, load_robot
from navette.sim.camera import Image


def _image(world: World, yaw: float = 0.0, x: float = 0.0) -> Image:
    scene = world.scene().with_robot(load_robot("course").model)
    return Simulator(scene, start=Pose2(x, 0, yaw)).image()


def test_sky_is_above_the_floor_with_objects_between() -> None:
    red = (0.9, 0.1, 0.1, 1.0)
    image = _image(World().add_box((6.0, 0.0), (1.0, 1.5), height=1.8, colour=red))
    assert image.shape == (240, 320, 3)
    assert image.dtype == np.uint8
    sky, floor, middle = image[5, 10], image[235, 10], image[120, 160]
    assert sky[2] > sky[0]
    assert abs(int(floor[0]) - int(floor[2])) < 25
    assert middle[0] > 2 * middle[2]


def test_left_is_left() -> None:
    red = (0.9, 0.1, 0.1, 1.0)
    image = _image(World().add_box((6.0, 1.5), (1.0, 1.0), height=3.0, colour=red))
    reddish = image[:, :, 0].astype(int) - image[:, :, 2] > 60
    columns = np.flatnonzero(reddish.any(axis=0))
    assert columns.max() < 160


def test_motion_over_the_floor_is_visible() -> None:
    assert np.any(_image(World()) != _image(World(), x=0.5))


def test_size_in_the_image_follows_the_pinhole() -> None:
    red = (0.9, 0.1, 0.1, 1.0)
    image = _image(World().add_box((7.3, 0.0), (2.0, 2.0), height=3.0, colour=red))
    reddish = image[120, :, 0].astype(int) - image[120, :, 2] > 60
    focal = 160 / np.tan(1.047 / 2)
    assert abs(reddish.sum() - 2.0 / 5.0 * focal) < 2  # the face is 5 m ahead
