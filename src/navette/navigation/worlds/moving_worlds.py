"""Generated worlds with moving cylinders, after the rules of DynaBARN.

Every cylinder follows a polynomial of random order across a walled field, with a speed
of its own between two points of it, and starts again at its end (Nair et al., 2022,
section III). Difficulty rises with the seed modulo 3: more and faster cylinders on
curves of higher order.
"""

import itertools
import math
from typing import NamedTuple

import numpy as np
from numpy.polynomial import Polynomial

from navette.navigation.worlds.dynabarn import placed, walled_field
from navette.sim import Scene

KIND = "dynabarn-like"

_HALF_M = 10.0
_RADIUS_M, _HEIGHT_M = 0.5, 1.0
_POINTS = 12  # on the polynomial
_LEAST_PATH_M = 4.0

Keyframe = tuple[float, float, float]


class _Difficulty(NamedTuple):
    cylinders: tuple[int, int]
    order: tuple[int, int]
    speed_mps: tuple[float, float]
    speed_stddev_mps: tuple[float, float]


_DIFFICULTIES = (
    _Difficulty((8, 14), (1, 2), (0.5, 1.0), (0.0, 0.1)),
    _Difficulty((14, 20), (2, 3), (1.0, 1.5), (0.1, 0.2)),
    _Difficulty((20, 25), (3, 4), (1.5, 2.0), (0.1, 0.3)),
)


def moving_scene(seed: int) -> Scene:
    """Return the world of a seed; equal seeds give equal worlds."""
    rng = np.random.default_rng([seed, 20])
    difficulty = _DIFFICULTIES[seed % len(_DIFFICULTIES)]
    field = walled_field(f"{KIND}-{seed}")
    for _ in range(int(rng.integers(*difficulty.cylinders))):
        field.add_actor(_keyframes(rng, difficulty), _RADIUS_M, height=_HEIGHT_M)
    return placed(field.scene())


def _keyframes(rng: np.random.Generator, difficulty: _Difficulty) -> list[Keyframe]:
    """Return time (s), x, y (m) along a curve."""
    points = _curve(rng, int(rng.integers(*difficulty.order, endpoint=True)))
    if rng.random() < 0.5:
        points.reverse()
    slowest, fastest = difficulty.speed_mps
    mean = rng.uniform(slowest, fastest)
    stddev = rng.uniform(*difficulty.speed_stddev_mps)
    time_s = 0.0
    frames = [(0.0, *points[0])]
    for before, after in itertools.pairwise(points):
        speed = float(np.clip(rng.normal(mean, stddev), slowest, fastest))
        time_s += math.dist(before, after) / speed
        frames.append((time_s, *after))
    return frames


def _curve(rng: np.random.Generator, order: int) -> list[tuple[float, float]]:
    """Return points on the longest stretch within the field of a random polynomial.

    The polynomial y(x) or x(y) passes through ``order + 1`` random points.
    """
    while True:
        given = rng.choice(np.arange(-_HALF_M, _HALF_M + 1), order + 1, replace=False)
        values = rng.uniform(-_HALF_M, _HALF_M, order + 1)
        fit = Polynomial.fit(given, values, order)
        u = np.linspace(-_HALF_M, _HALF_M, 400)
        v = fit(u)
        first, last = _longest_run(np.abs(v) <= _HALF_M)
        u, v = u[first:last], v[first:last]
        if len(u) < 2:
            continue
        along = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(u), np.diff(v)))])
        if along[-1] < _LEAST_PATH_M:
            continue
        at = np.linspace(0.0, along[-1], _POINTS)
        u, v = np.interp(at, along, u), np.interp(at, along, v)
        x, y = (u, v) if rng.random() < 0.5 else (v, u)
        return list(zip(x.tolist(), y.tolist(), strict=True))


def _longest_run(
    inside: "np.ndarray[tuple[int], np.dtype[np.bool_]]",
) -> tuple[int, int]:
    """Return the half-open interval of the longest run of true values."""
    padded = np.concatenate([[False], inside, [False]])
    edges = np.flatnonzero(padded[1:] != padded[:-1])
    begins, ends = edges[0::2], edges[1::2]
    if not len(begins):
        return 0, 0
    longest = int(np.argmax(ends - begins))
    return int(begins[longest]), int(ends[longest])
