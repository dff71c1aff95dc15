"""Search for a robot whose place in a known map is unknown."""

from typing import NamedTuple, Protocol

import numpy as np

from navette.geometry import Pose2
from navette.navigation.grids import PlanarScan
from navette.navigation.slam.match_status import MatchStatus
from navette.navigation.slam.motion import HERE, Matrix3, inverted
from navette.navigation.slam.params import SlamParams
from navette.navigation.slam.refinement import PosePrior
from navette.navigation.slam.relocation import (
    Relocation,
    anywhere_covariance,
    evidence_of,
    locate,
)
from navette.navigation.slam.scan_graph import KeyScan, ScanGraph
from navette.navigation.slam.tracking import (
    DOUBTFUL,
    ScanComparison,
    compare,
    make_local_map,
)

# Of a pose that a person or a search of the whole map gives.
_PLACED = np.diag([0.3**2, 0.3**2, 0.2**2])
# Newest key scans that are searched for in the map.
_SCOUTED = 10


class FoundPlace(NamedTuple):
    """Where a scan was taken in the known map.

    Attributes:
        pose: map_T_base.
        information: (3, 3) of the pose, in the map's axes.
        near: a key scan of the map near the pose.
    """

    pose: Pose2
    information: Matrix3
    near: int


class Scout(Protocol):
    """SLAM that maps what the robot has seen since its place is unknown."""

    graph: ScanGraph
    unmatched_in_a_row: int

    def add(
        self,
        stamp_ns: int,
        scan: PlanarScan,
        odom_T_base: Pose2 | None = None,
        *,
        base_T_sensor: Pose2 = HERE,
        yaw: float | None = None,
    ) -> object:
        """Use a scan."""


class MakeScout(Protocol):
    """Returns a SLAM without a map."""

    def __call__(self) -> Scout: ...


class PlaceSearch:
    """Search for a robot around a start pose, and in the whole map if that is wrong.

    Attributes:
        status: why the place is still unknown.

    Args:
        graph: the known map.
        params: as of the SLAM.
        start: map_T_base at the next scan, roughly; None: the whole map is searched.
        status: why the search begins.
        make_scout: returns a SLAM without a map.
    """

    def __init__(
        self,
        graph: ScanGraph,
        params: SlamParams,
        start: Pose2 | None,
        status: MatchStatus,
        *,
        make_scout: MakeScout,
    ) -> None:
        self.graph = graph
        self.params = params
        self.status = status
        self._start = start
        self._make_scout = make_scout
        self._scout: Scout | None = None
        # What the last search of the whole map showed.
        self._shown = MatchStatus.LOST_NOWHERE
        self._failures = 0

    def find(
        self, key: KeyScan, motion: Pose2, odom: Pose2 | None, yaw: float | None
    ) -> FoundPlace | None:
        """Return the place of a scan; None: it is still unknown.

        Args:
            key: the scan.
            motion: of the base since the scan before.
            odom: odom_T_base at the scan, if measured.
            yaw: heading by an IMU, if measured.
        """
        if self._start is None:
            place = self._anywhere(key, odom, yaw)
        else:
            self._start = self._start @ motion
            place = self._at_start(self._start, key)
        if place is None:
            self._note_failure()
        return place

    def covariance(self, pose: Pose2) -> Matrix3:
        """Return the covariance (3, 3) about a pose while the place is unknown."""
        if self._start is None:
            return anywhere_covariance(self.graph, pose)
        return _PLACED

    def _at_start(self, start: Pose2, key: KeyScan) -> FoundPlace | None:
        """Match a scan around a start pose; without echoes, assume the start pose."""
        if not key.is_informative:
            return FoundPlace(start, inverted(_PLACED), self._nearest(start))
        compared = self._compared(start, key)
        return self._place(start, compared, compared.overlap)

    def _anywhere(
        self, key: KeyScan, odom: Pose2 | None, yaw: float | None
    ) -> FoundPlace | None:
        """Match a scan at the place that a search of the whole map finds.

        The place may be another one that is not mapped. What the map does not explain
        may be new. What contradicts the map, too, but then all other points have to
        fit, or the robot has to see more.
        """
        relocation = self._searched(key, odom, yaw)
        if relocation is None:
            return None
        self._shown = MatchStatus.LOST_NOWHERE
        if not key.is_informative:
            self._shown = MatchStatus.LOST_NO_ECHOES
        elif relocation.is_ambiguous:
            self._shown = MatchStatus.LOST_AMBIGUOUS
        if relocation.pose is None:
            return None
        compared = self._compared(relocation.pose, key)
        evidence = evidence_of(compared.overlap, compared.contradicted)
        return self._place(relocation.pose, compared, evidence)

    def _searched(
        self, key: KeyScan, odom: Pose2 | None, yaw: float | None
    ) -> Relocation | None:
        """Search the whole map for the newest scans, after each new key scan."""
        scout = self._scout
        if scout is None or scout.unmatched_in_a_row:
            scout = self._scout = self._make_scout()
        before = len(scout.graph)
        scout.add(
            key.stamp_ns, key.scan, odom, base_T_sensor=key.base_T_sensor, yaw=yaw
        )
        count = len(scout.graph)
        if count == before:
            return None
        newest = range(max(0, count - _SCOUTED), count)
        points = scout.graph.points(newest, scout.graph.pose(count - 1))
        return locate(self.graph, points, key, self.params)

    def _compared(self, start: Pose2, key: KeyScan) -> ScanComparison:
        local = make_local_map(self.graph, self._around(start), start, self.params)
        prior = PosePrior(start, inverted(_PLACED))
        return compare(local, key, prior, self.params)

    def _place(
        self, start: Pose2, compared: ScanComparison, evidence: float
    ) -> FoundPlace | None:
        """Return the place of a match, unless its evidence is doubtful."""
        matched = compared.refined
        if matched is None or evidence < DOUBTFUL:
            return None
        information = matched.information + inverted(_PLACED)
        return FoundPlace(matched.pose, information, self._nearest(start))

    def _around(self, pose: Pose2) -> list[int]:
        return self.graph.nearest(pose, 2 * self.params.local_scans)

    def _nearest(self, pose: Pose2) -> int:
        """Return the nearest key scan with echoes, or the newest one."""
        return min(
            self._around(pose),
            key=lambda node: self.graph.pose(node).distance_to(pose),
            default=len(self.graph) - 1,
        )

    def _note_failure(self) -> None:
        """Search the whole map when scans do not match around the start."""
        self._failures += 1
        if not (self.status.is_lost or self._failures >= self.params.lost_scans):
            return
        if self._start is None:
            self.status = self._shown
        else:
            self.status = MatchStatus.LOST_CONTRADICTED
            self._start = None  # it was wrong
