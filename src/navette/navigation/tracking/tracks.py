"""Tracks: Kalman filters of constant velocity, and which measurement is whose."""

import math
from dataclasses import dataclass
from typing import NamedTuple

from navette.navigation.tracking.clusters import Cluster
from navette.navigation.tracking.params import TrackingParams

# Measurements before a track can count as moving, and how many of them must be new.
_LEAST_HITS = 3
_LEAST_CHANGES = 3
_LEAST_TRAVEL_M = 0.08
# A track that never moved is dropped after so many scans without a measurement.
_TENTATIVE_MISSES = 3
# Factor of the error of a centre whose returns do not lie on a circle: partly hidden,
# merged with a neighbour, or of another shape.
_UNCERTAIN = 4.0
_FIRST_SPEED_STDDEV_MPS = 1.0
_CORRELATION_S = 0.5  # of the acceleration
_RADIUS_GAIN = 0.1
# Time at low speed after which a track no longer counts as moving.
_STOPPED_S = 1.0
# Time in which a moving obstacle goes as far as the least speed takes it. The measured
# centre of a wall of which more and less is seen has a speed, and stays.
_TRAVEL_S = 2.0


class TrackedObstacle(NamedTuple):
    """A moving disc; m, m/s, map frame; ``stddev_mps`` of each velocity component."""

    number: int
    x: float
    y: float
    vx: float
    vy: float
    radius_m: float
    stddev_m: float
    stddev_mps: float

    def at(self, seconds: float) -> tuple[float, float]:
        """Return the predicted centre after a time."""
        return self.x + self.vx * seconds, self.y + self.vy * seconds


@dataclass
class Track:
    """State of one obstacle; both axes share the covariance (pp, pv, vv)."""

    number: int
    x: float
    y: float
    radius_m: float
    pp: float
    vv: float
    stamp_ns: int
    seen_ns: int
    origin: tuple[float, float]
    origin_ns: int
    vx: float = 0.0
    vy: float = 0.0
    pv: float = 0.0
    hits: int = 1
    changes: int = 1
    misses: int = 0
    is_moving: bool = False
    is_round: bool = False
    wholes: int = 0  # measurements of the whole obstacle
    slow_ns: int = 0

    @classmethod
    def begin(
        cls, number: int, cluster: Cluster, stamp_ns: int, params: TrackingParams
    ) -> "Track":
        """Return a track at rest at a measurement."""
        return cls(
            number=number,
            x=cluster.x,
            y=cluster.y,
            radius_m=cluster.radius_m,
            pp=params.measurement_stddev_m**2,
            vv=_FIRST_SPEED_STDDEV_MPS**2,
            stamp_ns=stamp_ns,
            seen_ns=stamp_ns,
            slow_ns=stamp_ns,
            is_round=cluster.is_round,
            wholes=int(cluster.is_whole),
            origin=(cluster.x, cluster.y),
            origin_ns=stamp_ns,
        )

    @property
    def speed_mps(self) -> float:
        return math.hypot(self.vx, self.vy)

    def predict(self, stamp_ns: int, acceleration_mps2: float) -> None:
        """Advance to a stamp; the acceleration is noise of this stddev."""
        dt = (stamp_ns - self.stamp_ns) / 1e9
        density = acceleration_mps2**2 * _CORRELATION_S  # m²/s³
        self.stamp_ns = stamp_ns
        self.x += self.vx * dt
        self.y += self.vy * dt
        self.pp += dt * (2 * self.pv + dt * self.vv) + density * dt**3 / 3
        self.pv += dt * self.vv + density * dt**2 / 2
        self.vv += density * dt

    def update(
        self, cluster: Cluster, sensor: tuple[float, float], params: TrackingParams
    ) -> None:
        """Correct the prediction by a measurement at the same stamp from ``sensor``."""
        self._resize(cluster, sensor)
        stddev = params.measurement_stddev_m
        if not cluster.is_round:
            stddev *= _UNCERTAIN
        noise = stddev**2
        total = self.pp + noise
        gain, speed_gain = self.pp / total, self.pv / total
        dx, dy = cluster.x - self.x, cluster.y - self.y
        self.x += gain * dx
        self.y += gain * dy
        self.vx += speed_gain * dx
        self.vy += speed_gain * dy
        self.vv -= speed_gain * self.pv
        self.pv *= 1 - gain
        self.pp *= 1 - gain
        self.hits += 1
        self.changes += 1 if cluster.changed else 0
        self.misses = 0
        self.seen_ns = self.stamp_ns
        self._judge(params)

    def miss(self, params: TrackingParams) -> None:
        """Note that a scan shows nothing that belongs to the track."""
        self.misses += 1
        self._judge(params)

    def _resize(self, cluster: Cluster, sensor: tuple[float, float]) -> None:
        """Correct the radius; the near side, which was measured, stays.

        A part that is seen shows the least radius only. The centre moves without a
        velocity.
        """
        before = self.radius_m
        if cluster.is_whole:
            self.wholes += 1
            gain = max(_RADIUS_GAIN, 1.0 / self.wholes)
            self.radius_m += gain * (cluster.radius_m - before)
            self.is_round = cluster.is_round
        elif not self.wholes and cluster.is_round:
            self.radius_m += _RADIUS_GAIN * (cluster.radius_m - before)
        elif not self.wholes:
            self.radius_m = max(before, cluster.radius_m)
        away = math.hypot(self.x - sensor[0], self.y - sensor[1]) or 1.0
        grown = (self.radius_m - before) / away
        self.x += grown * (self.x - sensor[0])
        self.y += grown * (self.y - sensor[1])

    def _judge(self, params: TrackingParams) -> None:
        """Decide whether the obstacle moves."""
        slow = self.speed_mps < params.min_speed_mps
        if not slow:
            self.slow_ns = self.stamp_ns
        travel_m = math.hypot(self.x - self.origin[0], self.y - self.origin[1])
        if not self.is_moving:
            self.is_moving = (
                not slow
                and self.hits >= _LEAST_HITS
                and self.changes >= _LEAST_CHANGES
                and travel_m >= _LEAST_TRAVEL_M
            )
            if self.is_moving:
                self._start_here()
            return
        if travel_m >= params.min_speed_mps * _TRAVEL_S:
            self._start_here()
        if (
            self.stamp_ns - self.slow_ns >= _STOPPED_S * 1e9
            or self.stamp_ns - self.origin_ns >= _TRAVEL_S * 1e9
        ):
            self.is_moving, self.hits, self.changes = False, 0, 0
            self._start_here()

    def _start_here(self) -> None:
        """Measure the travel from here."""
        self.origin, self.origin_ns = (self.x, self.y), self.stamp_ns

    def is_over(self, params: TrackingParams) -> bool:
        """Return whether the track has ended."""
        if not self.is_moving:
            return self.misses >= _TENTATIVE_MISSES
        return self.stamp_ns - self.seen_ns > params.memory_s * 1e9

    def estimate(self) -> TrackedObstacle:
        return TrackedObstacle(
            self.number,
            self.x,
            self.y,
            self.vx,
            self.vy,
            self.radius_m,
            math.sqrt(self.pp),
            math.sqrt(self.vv),
        )


def associate(
    tracks: list[Track], clusters: list[Cluster], gate_m: float
) -> dict[int, int]:
    """Return track index → cluster index: the nearest pairs first, each once."""
    pairs = []
    for i, track in enumerate(tracks):
        reach = gate_m + 2 * math.sqrt(track.pp)
        for j, cluster in enumerate(clusters):
            away = math.hypot(cluster.x - track.x, cluster.y - track.y)
            if away <= reach:
                pairs.append((away, i, j))
    found: dict[int, int] = {}
    taken: set[int] = set()
    for _, i, j in sorted(pairs):
        if i not in found and j not in taken:
            found[i] = j
            taken.add(j)
    return found
