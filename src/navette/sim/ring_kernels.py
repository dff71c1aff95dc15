# SPDX-License-Identifier: Apache-2.0
"""Ray casting of rings of beams, compiled: lidars with several rows, sonar cones.

As :mod:`navette.sim.ray_kernels`, for beams above and below the sensor's plane, with
the shape that each beam meets, and with glass.
"""

import math

import numpy as np

from navette.files.kernels import kernel
from navette.sim.ray_kernels import (
    PLANE,
    _eye,
    _half_box,
    _hit,
    _seen_from,
    is_beyond,
)
from navette.sim.shading import _normal


@kernel
def cast_rings(  # type: ignore[no-untyped-def]
    kind, size, position, rotation, specular, origin, world_R_fan, azimuths,
    elevations, reach, distance, shape,
):  # fmt: skip
    """Distances of beams at ascending azimuths, at each of the elevations.

    The beam at azimuth a and elevation e points along (cos e cos a, cos e sin a,
    sin e) in the fan's frame.

    Args:
        specular: (K,) of each shape: 0, or for glass the cosine of the largest angle
            from its normal at which it returns a beam; others pass.
        azimuths: (N,) rad, evenly spaced, at most one turn.
        elevations: (R,) rad, within ±π/2.
        reach: m; farther shapes are ignored.
        distance: (R, N) m, written; inf where nothing is hit.
        shape: (R, N) int32 written: row of the shape, −1 for none.
    """
    n = len(azimuths)
    distance[:] = np.inf
    shape[:] = -1
    step = azimuths[1] - azimuths[0] if n > 1 else 1.0
    m, c = np.empty((3, 3)), np.empty(3)
    cos_a, sin_a = np.cos(azimuths), np.sin(azimuths)
    for g in range(len(kind)):
        if is_beyond(kind[g], size[g], position[g], origin, reach):
            continue
        _seen_from(origin, world_R_fan, position[g], rotation[g], m, c)
        middle, half, lowest, highest = _directions(kind[g], size[g], m, c, reach)
        if half < 0.0:
            continue
        first, count, wrapped = _columns(middle, half, azimuths[0], step, n)
        ox, oy, oz = _eye(m, c)
        for r in range(len(elevations)):
            if not lowest <= elevations[r] <= highest:
                continue
            across, up = math.cos(elevations[r]), math.sin(elevations[r])
            for k in range(count + wrapped):
                i = first + k if k < count else k - count
                x, y = across * cos_a[i], across * sin_a[i]
                dx = m[0, 0] * x + m[1, 0] * y + m[2, 0] * up
                dy = m[0, 1] * x + m[1, 1] * y + m[2, 1] * up
                dz = m[0, 2] * x + m[1, 2] * y + m[2, 2] * up
                s = size[g]
                t = _hit(kind[g], s[0], s[1], s[2], ox, oy, oz, dx, dy, dz)
                if t >= distance[r, i]:
                    continue
                if specular[g] > 0.0:
                    p = ox + t * dx, oy + t * dy, oz + t * dz
                    if _cosine(kind[g], s, p, (dx, dy, dz)) < specular[g]:
                        continue
                distance[r, i] = t
                shape[r, i] = g


@kernel(inline="never")
def _cosine(kind, size, point, ray):  # type: ignore[no-untyped-def]
    """Cosine of the angle between a ray and the normal where it meets a shape."""
    x, y, z = _normal(kind, size, point[0], point[1], point[2])
    return abs(x * ray[0] + y * ray[1] + z * ray[2])


@kernel(inline="never")
def _columns(middle, half, start, step, n):  # type: ignore[no-untyped-def]
    """First column of an interval of azimuths, their number, and those from 0 on.

    The latter are the part that wraps around to the first columns.
    """
    if half >= math.pi:
        return 0, n, 0
    turn = 2.0 * math.pi / step
    low, width = (middle - half - start) / step, 2.0 * half / step
    low -= math.floor(low / turn) * turn
    first, last = math.ceil(low), min(n - 1, math.floor(low + width))
    wrapped = min(n, math.floor(low + width - turn) + 1)
    return first, max(0, last - first + 1), max(0, wrapped)


@kernel(inline="never")
def _directions(kind, size, m, c, reach):  # type: ignore[no-untyped-def]
    """Azimuths and elevations that a shape can cover.

    Centre and half width of the azimuths (half < 0: none), lowest and highest
    elevation; rad.
    """
    right = math.pi / 2
    if kind == PLANE:
        return 0.0, math.pi, -right, right
    hx, hy, hz = _half_box(kind, size)
    ex = abs(m[0, 0]) * hx + abs(m[0, 1]) * hy + abs(m[0, 2]) * hz
    ey = abs(m[1, 0]) * hx + abs(m[1, 1]) * hy + abs(m[1, 2]) * hz
    ez = abs(m[2, 0]) * hx + abs(m[2, 1]) * hy + abs(m[2, 2]) * hz
    away, around = math.hypot(c[0], c[1]), math.hypot(ex, ey)
    if away - around > reach:
        return 0.0, -1.0, 0.0, 0.0
    if away <= around:
        return 0.0, math.pi, -right, right
    near, far = away - around, away + around
    low, high = c[2] - ez, c[2] + ez
    lowest = math.atan2(low, near if low < 0.0 else far) - 1e-9
    highest = math.atan2(high, near if high > 0.0 else far) + 1e-9
    return math.atan2(c[1], c[0]), math.asin(around / away), lowest, highest
