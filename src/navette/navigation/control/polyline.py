"""Polylines: simplify waypoints, round corners, sample evenly."""

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]


def simplify(points: Points, tolerance: float) -> Points:
    """Reduce waypoints (N, 2), metres, to (M, 2) of the same shape.

    Every dropped point lies within ``tolerance`` metres of the chord that replaces it
    (Douglas and Peucker 1973).
    """
    keep = np.zeros(len(points), bool)
    keep[[0, -1]] = True
    spans = [(0, len(points) - 1)]
    while spans:
        first, last = spans.pop()
        if last - first < 2:
            continue
        away = _distance_to_chord(points[first : last + 1])
        farthest = int(np.argmax(away))
        if away[farthest] > tolerance:
            middle = first + 1 + farthest
            keep[middle] = True
            spans += [(first, middle), (middle, last)]
    return points[keep]


def _distance_to_chord(points: Points) -> NDArray[np.float64]:
    """Return the distance of the inner points to the segment from first to last."""
    start, chord = points[0], points[-1] - points[0]
    inner = points[1:-1] - start
    length2 = float(chord @ chord)
    if length2 == 0.0:
        return np.asarray(np.hypot(inner[:, 0], inner[:, 1]))
    t = np.clip(inner @ chord / length2, 0.0, 1.0)
    off = inner - t[:, None] * chord
    return np.asarray(np.hypot(off[:, 0], off[:, 1]))


def turn_angles(points: Points) -> NDArray[np.float64]:
    """Return the turn (rad, left positive) at each inner point: (M, 2) → (M−2,)."""
    steps = np.diff(points, axis=0)
    headings = np.arctan2(steps[:, 1], steps[:, 0])
    change = np.diff(headings)
    return np.asarray((change + math.pi) % math.tau - math.pi, np.float64)


def round_corners(points: Points, deviation: float) -> Points:
    """Replace each corner of (M, 2) by an arc within ``deviation`` of the corner.

    A fillet of radius R in a corner of angle θ passes it at R·(1/cos(θ/2) − 1) and
    touches the legs R·tan(θ/2) before and after; it uses at most half of each leg.
    """
    if len(points) < 3:
        return points
    angles = turn_angles(points)
    legs = np.hypot(*np.diff(points, axis=0).T)
    rounded = [points[:1]]
    for i, angle in enumerate(angles):
        half = abs(float(angle)) / 2
        if half < 0.005:
            rounded.append(points[i + 1 : i + 2])
            continue
        radius = deviation / (1 / math.cos(half) - 1)
        touch = min(radius * math.tan(half), legs[i] / 2, legs[i + 1] / 2)
        rounded.append(_fillet(points[i : i + 3], touch, float(angle)))
    rounded.append(points[-1:])
    return np.concatenate(rounded)


def _fillet(corner: Points, touch: float, angle: float) -> Points:
    """Return the arc in the corner a–b–c that starts ``touch`` metres before b."""
    a, b, _ = corner
    into = (b - a) / math.dist(a, b)
    left = np.array([-into[1], into[0]]) * math.copysign(1.0, angle)
    radius = touch / math.tan(abs(angle) / 2)
    # Finer than the later samples, else the sampled curvature is uneven.
    count = 1 + max(
        2, math.ceil(abs(angle) / 0.1), math.ceil(abs(angle) * radius / 0.02)
    )
    phi = np.linspace(0.0, abs(angle), count)[:, None]
    start = b - touch * into
    return np.asarray(
        start + radius * (np.sin(phi) * into + (1 - np.cos(phi)) * left), np.float64
    )


def resample(points: Points, spacing: float) -> tuple[Points, NDArray[np.float64]]:
    """Return evenly spaced points on a polyline and their arc lengths."""
    legs = np.hypot(*np.diff(points, axis=0).T)
    arc = np.concatenate(([0.0], np.cumsum(legs)))
    count = max(1, math.ceil(arc[-1] / spacing))
    s = np.linspace(0.0, arc[-1], count + 1)
    x = np.interp(s, arc, points[:, 0])
    y = np.interp(s, arc, points[:, 1])
    return np.stack((x, y), axis=1), s


def split_at(points: Points, corners: NDArray[np.bool_]) -> Iterator[Points]:
    """Split (M, 2) at the marked inner points (M−2,); parts share the split point."""
    start = 0
    for i in np.flatnonzero(corners) + 1:
        yield points[start : i + 1]
        start = int(i)
    yield points[start:]
