"""Localization in a known map: particles, confidence, and when to search the map."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2, angle_difference
from navette.navigation.grids import GridSpec
from navette.navigation.localization.amcl.confidence import (
    ConfidenceMonitor,
    LocalizationState,
)
from navette.navigation.localization.amcl.estimate import ParticleEstimate
from navette.navigation.localization.amcl.hypotheses import RecentScans
from navette.navigation.localization.amcl.likelihood_field import (
    LikelihoodField,
    Points,
)
from navette.navigation.localization.amcl.messages import thinned
from navette.navigation.localization.amcl.params import AmclParams
from navette.navigation.localization.amcl.particle_filter import (
    GOOD_FIT,
    ParticleFilter,
)

# Period of an update of a robot at rest: it may have been carried.
_REST_UPDATE_NS = 1_000_000_000
# Period of searches of the whole map while the robot is lost.
_SEARCH_NS = 1_000_000_000
# Period of comparisons with all places of the map before it counts as localized.
_COMPARE_NS = 500_000_000
# Period of checks of a robot that is localized, unless its pose fits well; and by which
# mean log likelihood of a beam another place is clearly better.
_VERIFY_NS = 2_000_000_000
_BETTER_FIT = 0.1
_SAME_M = 0.5  # distance below which two estimates are of one place
_FARTHEST_M = 1e6  # of a standard deviation
_LOST_SHARE = 0.5  # of the particles that such a search replaces


class Located(NamedTuple):
    """Result of a scan.

    Attributes:
        state: whether the robot is localized.
        estimate: heaviest cluster; None without particles.
        map_T_odom: correction of the odometry; None until it was localized once.
        match: share of the beams that end at obstacles of the map.
        is_updated: whether the filter was updated.
        hypotheses: places of the map that explain the newest scans equally well; 1
            while the robot is localized.
    """

    state: LocalizationState
    estimate: ParticleEstimate | None
    map_T_odom: Pose2 | None
    match: float
    is_updated: bool
    hypotheses: int = 1


@dataclass(frozen=True, eq=False)
class ScanView:
    """A scan with the pose of the odometry at its stamp.

    Attributes:
        points: (N, 2) ends of the beams, base frame, m.
        odom_T_base: pose of the base in the odometry's frame.
        stamp_ns: time of the scan.
    """

    points: Points
    odom_T_base: Pose2
    stamp_ns: int


class MapLocalizer:
    """The pose on a known map, scan by scan.

    Args:
        params: of the filter and of its confidence.
        cells: (H, W) -1 unknown, 0 free … 100 occupied.
        spec: their geometry in the map frame.
    """

    def __init__(
        self, params: AmclParams, cells: NDArray[np.int8], spec: GridSpec
    ) -> None:
        self.params = params
        field = LikelihoodField.of(
            cells,
            spec,
            sigma=params.sigma_hit,
            random=params.z_rand / (params.z_hit + params.z_rand),
            reach_m=params.laser_likelihood_max_dist,
        )
        self.filter = ParticleFilter(
            params, field, np.random.default_rng(params.used_seed)
        )
        self.confidence = ConfidenceMonitor(params)
        self._updated: ScanView | None = None  # scan of the last update
        self._searched_ns = -_SEARCH_NS
        self._map_T_odom: Pose2 | None = None
        self._is_given = False  # the pose, and no scan has contradicted it yet
        self._recent = RecentScans()
        self._hypotheses = 1
        self._compared_ns = -_COMPARE_NS

    @property
    def present_pose(self) -> tuple[Pose2, NDArray[np.float64]] | None:
        """The estimated pose and its covariance (3, 3), to continue on another map."""
        if self.filter.is_empty:
            return None
        estimate = self.filter.estimate()
        return estimate.pose, estimate.covariance + np.eye(3) * 1e-4

    def set_pose(self, pose: Pose2, covariance: NDArray[np.float64]) -> None:
        """Continue from a pose; covariance (3, 3) of x, y, yaw."""
        self.filter.set_pose(pose, covariance)
        self.confidence.restart(is_given=True)
        self._is_given = True
        self._hypotheses = 1
        self._updated = None

    def locate_globally(self) -> None:
        """Forget the pose; the next scan begins a search of the whole map."""
        self.filter.forget()
        self.confidence.restart(is_given=False)
        self._is_given = False
        self._recent.clear()
        self._updated = None

    def request_update(self) -> None:
        """Update at the next scan, also without motion."""
        self._updated = None

    def step(self, scan: ScanView) -> Located:
        """Use a scan."""
        used = thinned(scan.points, self.params.max_beams)
        if self.confidence.state is LocalizationState.LOST:
            self._recent.clear()  # it may have been carried
        self._recent.add(used, scan.odom_T_base)
        if self.filter.is_empty:
            if not self.filter.locate_globally(used):
                return Located(self.confidence.state, None, None, 0.0, False)
            self._updated, self._searched_ns = scan, scan.stamp_ns
        elif not self._is_due(scan):
            return self._report(scan, is_updated=False)
        else:
            if self._updated is not None:
                motion = self._updated.odom_T_base.inverse() @ scan.odom_T_base
                self.filter.predict(motion)
            self._updated = scan
            is_localized = self.confidence.state is LocalizationState.LOCALIZED
            self.filter.update(used, may_skip=is_localized)
        return self._report(scan, is_updated=True)

    def follow_jump(self, new_T_old: Pose2) -> Pose2 | None:
        """Keep the pose if the odometry jumps: the robot does not.

        Args:
            new_T_old: from the odometry's frame before the jump to the one after.

        Returns:
            map_T_odom since the jump, if it is known.
        """
        self._recent.move_odometry(new_T_old)
        before = self._updated
        if before is not None:
            odom_T_base = new_T_old @ before.odom_T_base
            self._updated = ScanView(before.points, odom_T_base, before.stamp_ns)
        if self._map_T_odom is not None:
            self._map_T_odom = self._map_T_odom @ new_T_old.inverse()
        return self._map_T_odom

    def _is_due(self, scan: ScanView) -> bool:
        before = self._updated
        if before is None:
            return True
        here, there = before.odom_T_base, scan.odom_T_base
        turn = abs(angle_difference(here.yaw, there.yaw))
        return (
            here.distance_to(there) >= self.params.update_min_d
            or turn >= self.params.update_min_a
            or scan.stamp_ns - before.stamp_ns >= _REST_UPDATE_NS
        )

    def _report(self, scan: ScanView, *, is_updated: bool) -> Located:
        estimate = self.filter.estimate()
        assert self._updated is not None, "an update came first"
        # Particles are those of the last update.
        map_T_odom = estimate.pose @ self._updated.odom_T_base.inverse()
        pose = map_T_odom @ scan.odom_T_base
        match = self.filter.match(pose, scan.points)
        before = self.confidence.state
        state = self.confidence.update(
            match, estimate.stddev_m, estimate.share, scan.stamp_ns
        )
        localized = LocalizationState.LOCALIZED
        if state is localized and before is localized and is_updated:
            state = self._verify(scan, pose)
        elif state is localized and before is not localized and not self._is_given:
            state = self._compare(scan, pose)
        is_new = is_updated or before is not localized
        if (state is localized and is_new) or (self._is_given and is_updated):
            self._map_T_odom = map_T_odom
        if state is LocalizationState.LOST:
            self._is_given = False
            if not self.confidence.is_promising:
                self._search(scan)
        return Located(
            state, estimate, self._map_T_odom, match, is_updated, self._hypotheses
        )

    def _compare(self, scan: ScanView, pose: Pose2) -> LocalizationState:
        """Return localized if no other place explains the newest scans as well.

        Otherwise the filter continues with all these places.
        """
        if 0 <= scan.stamp_ns - self._compared_ns < _COMPARE_NS:
            self.confidence.doubt()
            return self.confidence.state
        self._compared_ns = scan.stamp_ns
        used = thinned(scan.points, self.params.max_beams)
        points = self._recent.seen_from(used, scan.odom_T_base)
        found = self.filter.hypotheses(pose, points)
        self._hypotheses = len(found.poses)
        best = Pose2(*found.poses[0].tolist())
        if self._hypotheses > 1 or best.distance_to(pose) > _SAME_M:
            self.filter.spread_over(found)
            self._updated = scan
            self.confidence.doubt()
        return self.confidence.state

    def _verify(self, scan: ScanView, pose: Pose2) -> LocalizationState:
        """Return localized unless the pose jumps or fits worse than another place.

        Scans along the path that fit the map well need no search of the map.
        """
        if self._map_T_odom is not None:
            expected = self._map_T_odom @ scan.odom_T_base
            if expected.distance_to(pose) > _SAME_M:
                return self._doubt()
        if 0 <= scan.stamp_ns - self._compared_ns < _VERIFY_NS:
            return self.confidence.state
        self._compared_ns = scan.stamp_ns
        used = thinned(scan.points, self.params.max_beams)
        points = self._recent.seen_from(used, scan.odom_T_base)
        fit = self.filter.fit(pose, points)
        if fit > GOOD_FIT:
            return self.confidence.state
        found = self.filter.hypotheses(pose, points)
        best = Pose2(*found.poses[0].tolist())
        is_better = self.filter.fit(best, points) > fit + _BETTER_FIT
        if best.distance_to(pose) > _SAME_M and is_better:
            self.filter.spread_over(found)
            self._updated = scan
            return self._doubt()
        return self.confidence.state

    def _doubt(self) -> LocalizationState:
        self.confidence.doubt()
        self._is_given = False
        self._compared_ns = -_COMPARE_NS
        return self.confidence.state

    def _search(self, scan: ScanView) -> None:
        if 0 <= scan.stamp_ns - self._searched_ns < _SEARCH_NS:
            return
        self._searched_ns = scan.stamp_ns
        assert self._updated is not None, "the robot was localized before"
        # Candidates are poses now; the others are those of the last update.
        self.filter.predict(self._updated.odom_T_base.inverse() @ scan.odom_T_base)
        self._updated = scan
        used = thinned(scan.points, self.params.max_beams)
        self.filter.recover(used, _LOST_SHARE)


def default_covariance(params: AmclParams) -> NDArray[np.float64]:
    """Return the covariance (3, 3) of an initial pose without one."""
    sd = params.initial_stddev_m, params.initial_stddev_m, params.initial_stddev_rad
    return np.diag(np.square(sd))


def is_usable(covariance: NDArray[np.float64]) -> bool:
    """Whether a matrix (3, 3) is a covariance with variances above zero."""
    if not (np.abs(covariance) < _FARTHEST_M**2).all():  # false for NaN, too
        return False
    if not np.allclose(covariance, covariance.T):
        return False
    return bool((np.linalg.eigvalsh(covariance) > 0.0).all())
