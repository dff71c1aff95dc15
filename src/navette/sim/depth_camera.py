# SPDX-License-Identifier: Apache-2.0
"""A depth camera by ray casting."""

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from navette.sim.build import Compiled
from navette.sim.camera import focal_length, pixel_rays
from navette.sim.instant import Instant
from navette.sim.masks import SEEN, SEEN_SOLID
from navette.sim.mount import Mount
from navette.sim.ray_kernels import cast_image
from navette.sim.sensor_specs import CameraSensor, DepthCameraSensor
from navette.sim.shape_table import ShapeTable

Depths = NDArray[np.float32]  # (height, width) m


@dataclass(frozen=True)
class DepthImage:
    """Depths along the optical axis: +inf too far, −inf too near (REP 117)."""

    stamp_ns: int
    depths: Depths


class DepthCamera:
    """One ray per pixel; the robot itself and glass are invisible to it."""

    def __init__(
        self, sensor: DepthCameraSensor, mount: Mount, compiled: Compiled
    ) -> None:
        self.sensor = sensor
        self.mount = mount
        groups = (SEEN_SOLID, SEEN)
        self._shapes = ShapeTable(compiled.model, groups, compiled.surfaces)
        self._opaque = np.flatnonzero(self._shapes.specular == 0.0)
        self._depth = np.empty((sensor.height, sensor.width))
        self._shape = np.empty((sensor.height, sensor.width), dtype=np.int32)

    def read(self, instant: Instant, rng: np.random.Generator) -> DepthImage:
        """Measure the depth of every pixel."""
        s = self.sensor
        depth = self._cast(instant.model, instant.data)
        noise = s.noise_stddev > 0 or s.noise_per_m > 0
        if noise:
            stddev = s.noise_stddev + s.noise_per_m * np.minimum(depth, s.far) ** 2
            depth = depth + stddev * rng.standard_normal(depth.shape)
        depths = depth.astype(np.float32)
        depths[self._shape < 0] = np.inf
        depths[depths >= s.far] = np.inf
        depths[depths < s.near] = -np.inf
        return DepthImage(instant.stamp_ns, depths)

    def _cast(self, model: mujoco.MjModel, data: mujoco.MjData) -> NDArray[np.float64]:
        """True depths; the rows of the shapes are in ``_shape``."""
        s, shapes, rows = self.sensor, self._shapes, self._opaque
        shapes.update(data)
        origin, world_R_camera = self.mount.world(data)
        if shapes.has_others:
            rays_world = pixel_rays(s) @ world_R_camera.T
            depth, _ = shapes.cast_with_mujoco(model, data, origin, rays_world, s.far)
            self._depth[:] = depth.reshape(self._depth.shape)
            self._shape[:] = np.isfinite(self._depth).astype(np.int32) - 1
            return self._depth
        # From the lens on: what is nearer than near hides the rest, as in a real one.
        cast_image(
            shapes.kind[rows], shapes.size[rows], shapes.position[rows],
            shapes.rotation[rows], origin, world_R_camera, focal_length(s), 1e-3,
            s.far, self._depth, self._shape,
        )  # fmt: skip
        return self._depth


def points_of_depths(depths: Depths, sensor: CameraSensor) -> NDArray[np.float32]:
    """Return the points (H, W, 3), m, in the optical frame (z ahead, x right: REP 103).

    p = z · ((u + ½ − W/2) / f, (v + ½ − H/2) / f, 1); NaN where the depth is not
    finite.
    """
    focal, height, width = focal_length(sensor), *depths.shape
    x = ((np.arange(width) + 0.5 - width / 2) / focal).astype(np.float32)
    y = ((np.arange(height) + 0.5 - height / 2) / focal).astype(np.float32)
    z = np.where(np.isfinite(depths), depths, np.float32(np.nan))
    return np.stack([z * x, z * y[:, None], z], axis=-1)
