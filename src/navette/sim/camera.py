# SPDX-License-Identifier: Apache-2.0
"""A pinhole camera drawn by ray casting: works anywhere, without OpenGL."""

import math

import mujoco
import numpy as np
from numpy.typing import NDArray

from navette.sim.build import SEEN, SEEN_SOLID
from navette.sim.mount import Mount
from navette.sim.scene import CameraSensor, Scene

_AMBIENT = 0.55
_DIFFUSE = 0.45
_CHECKER_M = 1.0
_CHECKER_DARK = 0.90  # every other floor tile, so that motion can be seen
_HORIZON = np.array([0.90, 0.93, 0.96], dtype=np.float32)
_HAZE_M = 60.0  # distance after which things fade into the horizon

Image = NDArray[np.uint8]  # (height, width, 3) red, green, blue


class Camera:
    """Casts one ray a pixel and shades by colour, sun angle and distance."""

    def __init__(
        self, sensor: CameraSensor, mount: Mount, scene: Scene, model: mujoco.MjModel
    ) -> None:
        self.sensor = sensor
        self.mount = mount
        self._rays_sensor = _pixel_rays(sensor)
        count = len(self._rays_sensor)
        self._groups = np.zeros(mujoco.mjNGROUP, dtype=np.uint8)
        self._groups[[SEEN_SOLID, SEEN]] = 1
        self._geom = np.empty(count, dtype=np.int32)
        self._distance = np.empty(count)
        self._normal = np.empty((count, 3))
        sun = -np.array(scene.sun_direction)
        self._sun = (sun / np.linalg.norm(sun)).astype(np.float32)
        self._sky = np.array(scene.sky[:3], dtype=np.float32)
        # The last row answers index −1, "nothing hit".
        colours = np.array(model.geom_rgba[:, :3], dtype=np.float32)
        self._colours = np.vstack([colours, np.zeros((1, 3), np.float32)])
        planes = np.array(model.geom_type) == mujoco.mjtGeom.mjGEOM_PLANE
        self._is_floor = np.append(planes, False)

    def render(self, model: mujoco.MjModel, data: mujoco.MjData) -> Image:
        """The image now (kinematics must be fresh)."""
        s = self.sensor
        position, rotation = self.mount.world(data)
        rays = self._rays_sensor @ rotation.T
        mujoco.mj_multiRay(
            model,
            data,
            position,
            rays.ravel(),
            self._groups,
            True,  # static geoms too
            -1,
            self._geom,
            self._distance,
            self._normal.ravel(),
            len(rays),
            s.far,
        )
        shaded = self._shade(position, rays)
        return shaded.reshape(s.height, s.width, 3)

    def _shade(self, position: NDArray[np.float64], rays: NDArray[np.float64]) -> Image:
        geom, distance = self._geom, self._distance.astype(np.float32)
        light = self._normal.astype(np.float32) @ self._sun
        light = _AMBIENT + _DIFFUSE * np.maximum(light, 0.0)
        floor = np.flatnonzero(self._is_floor[geom])
        spot = position[:2] + rays[floor, :2] * self._distance[floor, None]
        tiles = np.floor(spot / _CHECKER_M).astype(np.int64).sum(axis=1)
        light[floor] *= np.where(tiles & 1, np.float32(_CHECKER_DARK), np.float32(1.0))
        haze = np.minimum(distance / _HAZE_M, 1.0)[:, None] * np.float32(0.6)
        colour = self._colours[geom] * light[:, None]
        colour += (_HORIZON - colour) * haze
        sky = np.flatnonzero(geom < 0)
        height = np.clip(rays[sky, 2], 0.0, 1.0).astype(np.float32)[:, None]
        colour[sky] = _HORIZON + (self._sky - _HORIZON) * np.sqrt(height)
        pixels: Image = (np.clip(colour, 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)
        return pixels


def focal_length(sensor: CameraSensor) -> float:
    """In pixels; pixels are square."""
    return sensor.width / (2.0 * math.tan(sensor.horizontal_fov / 2.0))


def _pixel_rays(sensor: CameraSensor) -> NDArray[np.float64]:
    """Unit rays (height · width, 3) through pixel centres; x ahead, z up."""
    focal = focal_length(sensor)
    right = (np.arange(sensor.width) + 0.5 - sensor.width / 2) / focal
    down = (np.arange(sensor.height) + 0.5 - sensor.height / 2) / focal
    u, v = np.meshgrid(right, down)
    rays = np.stack([np.ones_like(u), -u, -v], axis=-1).reshape(-1, 3)
    unit: NDArray[np.float64] = rays / np.linalg.norm(rays, axis=1, keepdims=True)
    return unit
