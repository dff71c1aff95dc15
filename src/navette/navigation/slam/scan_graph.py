"""Key scans, the measurements between them and their poses."""

from collections.abc import Iterable
from copy import copy
from dataclasses import dataclass
from itertools import islice
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2
from navette.navigation.grids import PlanarScan
from navette.navigation.slam.pose_graph import GraphEdge, optimise
from navette.navigation.slam.relative_covariance import EdgeList, covariances_from
from navette.navigation.slam.scan_points import LEAST_POINTS, Points, moved_points

Matrix = NDArray[np.float64]

# A robot looks at the place this far before it: scanners see ahead, or all around.
_AHEAD_M = 1.0
# Key scans of a chunk at least: fewer contain too few surfaces.
_LEAST_SCANS = 3


@dataclass(frozen=True, eq=False)
class KeyScan:
    """A scan that is kept."""

    stamp_ns: int
    scan: PlanarScan
    base_T_sensor: Pose2
    points: Points
    """(N, 4) in the base frame"""

    @property
    def is_informative(self) -> bool:
        """Whether the scan has enough echoes to be matched, or matched with."""
        return len(self.points) >= LEAST_POINTS


class ScanChunk(NamedTuple):
    """Consecutive key scans, from ``first`` up to ``last`` (excluded)."""

    first: int
    last: int

    @property
    def anchor(self) -> int:
        """The key scan in whose frame the chunk lies."""
        return (self.first + self.last) // 2


class ScanGraph:
    """Pose graph of key scans.

    Attributes:
        keys: the key scans, by node.
        edges: the measurements that the poses follow from.
        sessions: first node of each session; between two the robot was switched off.
    """

    def __init__(self) -> None:
        self.keys: list[KeyScan] = []
        self.edges: list[GraphEdge] = []
        self.sessions: list[int] = []
        self._poses = np.empty((0, 3))
        self._centers: list[NDArray[np.float64]] = []
        self._path_m: list[float] = []  # up to each key scan, when it was added
        self._table = EdgeList()

    def __len__(self) -> int:
        return len(self.keys)

    def copy(self) -> "ScanGraph":
        """Return a graph with the same key scans, to which none are added."""
        other = copy(self)
        other.keys, other.edges = self.keys.copy(), self.edges.copy()
        other.sessions = self.sessions.copy()
        return other

    @property
    def poses(self) -> Matrix:
        """(N, 3) x, y, yaw of each key scan in the map."""
        return self._poses

    @poses.setter
    def poses(self, poses: Matrix) -> None:
        self._poses = poses

    def pose(self, node: int) -> Pose2:
        """Return map_T_base of a key scan."""
        x, y, yaw = self._poses[node]
        return Pose2(float(x), float(y), float(yaw))

    def insert(self, key: KeyScan, pose: Pose2, *, starts_session: bool) -> int:
        """Add a key scan and return its node; the caller adds its edges."""
        node = len(self.keys)
        if starts_session:
            self.sessions.append(node)
        self.keys.append(key)
        step_m = self.pose(node - 1).distance_to(pose) if node else 0.0
        self._path_m.append(step_m + (self._path_m[-1] if node else 0.0))
        self._poses = np.vstack([self._poses, np.array(pose)])
        # Where a scan looks: half-way to the middle of its points.
        points = key.points[:, :2]
        self._centers.append(0.5 * points.mean(axis=0) if len(points) else np.zeros(2))
        return node

    def connect(self, edges: Iterable[GraphEdge]) -> None:
        """Add measurements; the poses do not change."""
        for edge in edges:
            self.edges.append(edge)
            self._table.add(edge)

    def optimise(self, steps: int = 10) -> None:
        """Compute the poses from the edges."""
        if len(self.keys) > 1:
            self._poses = optimise(self._poses, self.edges, steps=steps).poses

    def covariances_from(self, node: int) -> Matrix:
        """Return (N, 3, 3) covariances of all poses relative to a node."""
        return covariances_from(node, self._poses, self._table.table(len(self.keys)))

    def view_centers(self) -> Matrix:
        """Return (N, 2) the place in the map that each key scan looks at, m."""
        local = np.array(self._centers).reshape(-1, 2)
        c, s = np.cos(self._poses[:, 2]), np.sin(self._poses[:, 2])
        x = self._poses[:, 0] + c * local[:, 0] - s * local[:, 1]
        y = self._poses[:, 1] + s * local[:, 0] + c * local[:, 1]
        return np.column_stack([x, y])

    def nearest(self, pose: Pose2, count: int) -> list[int]:
        """Return the key scans that look at what a robot at ``pose`` looks at.

        Scans without echoes look at nothing.
        """
        here = np.array(pose.apply(np.array([[_AHEAD_M, 0.0]]))[0])
        away = np.linalg.norm(self.view_centers() - here, axis=1)
        order = (int(node) for node in np.argsort(away, kind="stable"))
        seeing = (node for node in order if self.keys[node].is_informative)
        return sorted(islice(seeing, count))

    def newest(self, first: int, count: int) -> list[int]:
        """Return the newest key scans with echoes, from node ``first`` on."""
        nodes = range(len(self.keys) - 1, first - 1, -1)
        seeing = (node for node in nodes if self.keys[node].is_informative)
        return sorted(islice(seeing, count))

    def points(self, nodes: Iterable[int], frame: Pose2 | None = None) -> Points:
        """Return the points of key scans in the map, or in a frame given in the map."""
        frame_T_map = None if frame is None else frame.inverse()
        parts = [np.empty((0, 4))]
        for node in nodes:
            pose = self.pose(node)
            placed = pose if frame_T_map is None else frame_T_map @ pose
            parts.append(moved_points(self.keys[node].points, placed))
        return np.concatenate(parts)

    def has_points(self, chunk: ScanChunk) -> bool:
        """Whether any scan of a chunk has an echo in range."""
        return any(len(self.keys[node].points) for node in range(*chunk))

    def chunks(self, most: int, length_m: float) -> list[ScanChunk]:
        """Return all complete chunks of each session.

        Args:
            most: key scans of a chunk.
            length_m: path after which a chunk with fewer is complete.
        """
        found: list[ScanChunk] = []
        for start, end in zip(
            self.sessions, [*self.sessions[1:], len(self.keys)], strict=True
        ):
            first = start
            for last in range(start + 1, end + 1):
                if self._is_complete(ScanChunk(first, last), most, length_m):
                    found.append(ScanChunk(first, last))
                    first = last
        return found

    def newest_chunk(self, most: int, length_m: float) -> ScanChunk | None:
        """Return the chunk that ends with the newest key scan of this session."""
        count = len(self.keys)
        for first in range(count - 1, self.sessions[-1] - 1, -1):
            chunk = ScanChunk(first, count)
            if self._is_complete(chunk, most, length_m):
                return chunk
        return None

    def path_m(self, first: int, last: int) -> float:
        """Return the length of the path between two key scans, as it was driven."""
        return self._path_m[last] - self._path_m[first]

    def _is_complete(self, chunk: ScanChunk, most: int, length_m: float) -> bool:
        count = chunk.last - chunk.first
        if count >= most:
            return True
        path_m = self.path_m(chunk.first, chunk.last - 1)
        return count >= _LEAST_SCANS and path_m >= length_m
