# SPDX-License-Identifier: Apache-2.0
"""A pinhole camera rendered by ray casting, without OpenGL."""

import math

import mujoco
import numpy as np
from numpy.typing import NDArray

from navette.sim.instant import Instant
from navette.sim.masks import SEEN, SEEN_SOLID
from navette.sim.mount import Mount
from navette.sim.ray_kernels import cast_image
from navette.sim.scene import Scene
from navette.sim.sensor_specs import CameraSensor
from navette.sim.shading import shade
from navette.sim.shape_table import ShapeTable

_HORIZON = np.array([0.90, 0.93, 0.96])

Image = NDArray[np.uint8]  # (height, width, 3) red, green, blue


class Camera:
    """One shaded ray per pixel; the robot itself is invisible to it."""

    def __init__(
        self, sensor: CameraSensor, mount: Mount, scene: Scene, model: mujoco.MjModel
    ) -> None:
        self.sensor = sensor
        self.mount = mount
        self._shapes = ShapeTable(model, (SEEN_SOLID, SEEN))
        self._depth = np.empty((sensor.height, sensor.width))
        self._shape = np.empty((sensor.height, sensor.width), dtype=np.int32)
        sun = -np.array(scene.sun_direction)
        self._sun = sun / np.linalg.norm(sun)
        self._sky = np.array(scene.sky[:3])

    def read(self, instant: Instant, rng: np.random.Generator) -> Image:
        """Render the image of an instant."""
        model, data = instant.model, instant.data
        s, shapes = self.sensor, self._shapes
        shapes.update(data)
        origin, world_R_camera = self.mount.world(data)
        if shapes.has_others:
            self._cast_with_mujoco(model, data, origin, world_R_camera)
        else:
            cast_image(
                shapes.kind, shapes.size, shapes.position, shapes.rotation, origin,
                world_R_camera, focal_length(s), s.near, s.far, self._depth,
                self._shape,
            )  # fmt: skip
        image = np.empty((s.height, s.width, 3), dtype=np.uint8)
        shade(
            shapes.kind, shapes.size, shapes.position, shapes.rotation, shapes.colour,
            origin, world_R_camera, focal_length(s), self._depth, self._shape,
            self._sun, self._sky, _HORIZON, image,
        )  # fmt: skip
        return image

    def _cast_with_mujoco(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        origin: NDArray[np.float64],
        world_R_camera: NDArray[np.float64],
    ) -> None:
        rays_world = pixel_rays(self.sensor) @ world_R_camera.T
        depth, shape = self._shapes.cast_with_mujoco(
            model, data, origin, rays_world, self.sensor.far
        )
        self._depth[:] = depth.reshape(self._depth.shape)
        self._shape[:] = shape.reshape(self._shape.shape)


def focal_length(sensor: CameraSensor) -> float:
    """Focal length in pixels; pixels are square."""
    return sensor.width / (2.0 * math.tan(sensor.horizontal_fov / 2.0))


def pixel_rays(sensor: CameraSensor) -> NDArray[np.float64]:
    """Rays (height · width, 3) through pixel centres, with x = 1 and z up."""
    focal = focal_length(sensor)
    right = (np.arange(sensor.width) + 0.5 - sensor.width / 2) / focal
    down = (np.arange(sensor.height) + 0.5 - sensor.height / 2) / focal
    u, v = np.meshgrid(right, down)
    return np.stack([np.ones_like(u), -u, -v], axis=-1).reshape(-1, 3)
