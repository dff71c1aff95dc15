# SPDX-License-Identifier: Apache-2.0
"""Shading of the ray-cast image, compiled."""

import math

import numpy as np

from navette.files.kernels import kernel
from navette.sim.ray_kernels import BOX, CAPSULE, CYLINDER, ELLIPSOID, PLANE, SPHERE

_AMBIENT = 0.55
_DIFFUSE = 0.45
_TILE_M = 1.0
_DARK_TILE = 0.90  # checkered floor, so that motion is visible
_HAZE_PER_M = 0.01  # rate at which objects fade into the horizon
_MOST_HAZE = 0.6


@kernel(inline="never")
def _normal(kind, size, x, y, z):  # type: ignore[no-untyped-def]
    """Outward unit normal at a point on a shape, in its frame; zero if unknown."""
    if kind == PLANE:
        return 0.0, 0.0, 1.0
    if kind == BOX:
        a, b, c = abs(x) / size[0], abs(y) / size[1], abs(z) / size[2]
        if a >= b and a >= c:
            return math.copysign(1.0, x), 0.0, 0.0
        if b >= c:
            return 0.0, math.copysign(1.0, y), 0.0
        return 0.0, 0.0, math.copysign(1.0, z)
    if kind == CYLINDER:
        if abs(z) >= size[1] * (1 - 1e-6):
            return 0.0, 0.0, math.copysign(1.0, z)
        z = 0.0
    elif kind == CAPSULE:
        z -= min(max(z, -size[1]), size[1])
    elif kind == ELLIPSOID:
        x, y, z = x / size[0] ** 2, y / size[1] ** 2, z / size[2] ** 2
    elif kind != SPHERE:
        return 0.0, 0.0, 0.0
    length = math.sqrt(x * x + y * y + z * z) + 1e-12
    return x / length, y / length, z / length


@kernel
def shade(  # type: ignore[no-untyped-def]
    kind, size, position, rotation, colour, origin, world_R_camera, focal,
    depth, shape, sun, sky, horizon, image,
):  # fmt: skip
    """Write colours (H, W, 3) uint8 to ``image``.

    Lambert's cosine law plus ambient light, a checkered floor, haze that grows with
    distance, and a sky gradient from horizon to zenith.

    Args:
        depth, shape: from :func:`navette.sim.ray_kernels.cast_image`.
        sun: (3,) unit vector to the sun, world.
        sky, horizon: (3,) colours in 0…1.
    """
    height, width = depth.shape
    ray, spot = np.empty(3), np.empty(3)
    r = world_R_camera
    for row in range(height):
        v = (row + 0.5 - height / 2) / focal
        for column in range(width):
            u = (column + 0.5 - width / 2) / focal
            for i in range(3):
                ray[i] = r[i, 0] - r[i, 1] * u - r[i, 2] * v
            length = math.sqrt(1.0 + u * u + v * v)
            g = shape[row, column]
            if g < 0:
                up = math.sqrt(max(0.0, ray[2] / length))
                for i in range(3):
                    tint = horizon[i] + (sky[i] - horizon[i]) * up
                    image[row, column, i] = np.uint8(255.0 * tint + 0.5)
                continue
            for i in range(3):
                spot[i] = origin[i] + depth[row, column] * ray[i]
            light = _light(kind[g], size[g], position[g], rotation[g], spot, sun)
            haze = min(_MOST_HAZE, _HAZE_PER_M * depth[row, column] * length)
            for i in range(3):
                tint = colour[g, i] * light
                tint += (horizon[i] - tint) * haze
                image[row, column, i] = np.uint8(255.0 * min(1.0, tint) + 0.5)


@kernel(inline="never")
def _light(kind, size, position, rotation, spot, sun):  # type: ignore[no-untyped-def]
    """Brightness of a point of a shape."""
    x, y, z = 0.0, 0.0, 0.0
    for k in range(3):
        d = spot[k] - position[k]
        x += rotation[k, 0] * d
        y += rotation[k, 1] * d
        z += rotation[k, 2] * d
    nx, ny, nz = _normal(kind, size, x, y, z)
    cosine = 0.0
    for k in range(3):
        n = rotation[k, 0] * nx + rotation[k, 1] * ny + rotation[k, 2] * nz
        cosine += n * sun[k]
    light = _AMBIENT + _DIFFUSE * max(0.0, cosine)
    if kind == PLANE:
        tile = math.floor(spot[0] / _TILE_M) + math.floor(spot[1] / _TILE_M)
        light *= _DARK_TILE if tile % 2 else 1.0
    return light
