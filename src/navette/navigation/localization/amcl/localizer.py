"""Localization in a known map: particles, confidence, and when to search the map."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2, angle_difference
from navette.navigation.grids import GridSpec
from navette.navigation.localization.amcl.confidence import (
    ConfidenceMonitor,
    DoubtCause,
    LocalizationState,
)
from navette.navigation.localization.amcl.estimate import ParticleEstimate
from navette.navigation.localization.amcl.evidence import (
    DECISIVE,
    GOOD_FIT,
    PATH_APART_M,
    PATH_SCANS,
)
from navette.navigation.localization.amcl.global_search import Candidates
from navette.navigation.localization.amcl.hypotheses import (
    APART_M,
    APART_RAD,
    MOST_POINTS,
    SCANS,
)
from navette.navigation.localization.amcl.likelihood_field import (
    LikelihoodField,
    Points,
)
from navette.navigation.localization.amcl.motion_model import noise_of_motion
from navette.navigation.localization.amcl.params import AmclParams
from navette.navigation.localization.amcl.particle_filter import ParticleFilter
from navette.navigation.localization.amcl.recent_scans import RecentScans, thinned

# Period of an update of a robot at rest: it may have been carried.
_REST_UPDATE_NS = 1_000_000_000
# Period of searches of the whole map while the robot is lost.
_SEARCH_NS = 1_000_000_000
# Period of comparisons with all places of the map before it counts as localized.
_COMPARE_NS = 500_000_000
# Period of comparisons of a localized robot that does not fit well.
_VERIFY_NS = 2_000_000_000
_SAME_M = 0.5  # distance below which two estimates are of one place
_FARTHEST_M = 1e6  # of a standard deviation
_LOST_SHARE = 0.5  # of the particles that such a search replaces
# A scan with fewer echoes is not used: the few may be of people.
_LEAST_ECHOES = 0.1  # of the beams
# Where the robot was localized last it is localized again, unless the newest scan fits
# another place so much better (mean log likelihood of a beam).
_FAR_BETTER = 0.5


class Located(NamedTuple):
    """Result of a scan.

    Attributes:
        state: whether the robot is localized.
        estimate: heaviest cluster; None without particles.
        map_T_odom: correction of the odometry; None until it was localized once.
        match: share of the beams that end at obstacles of the map; None if the scan has
            too few echoes.
        is_updated: whether the filter was updated.
        hypotheses: places of the map that explain the newest scans; more than 1 while
            the robot is localized if others explain them better, yet not enough.
        cause: why the robot is not localized any more, if so.
    """

    state: LocalizationState
    estimate: ParticleEstimate | None
    map_T_odom: Pose2 | None
    match: float | None
    is_updated: bool
    hypotheses: int = 1
    cause: DoubtCause | None = None


@dataclass(frozen=True, eq=False)
class ScanView:
    """A scan with the pose of the odometry at its stamp.

    Attributes:
        points: (N, 2) ends of the beams, base frame, m.
        odom_T_base: pose of the base in the odometry's frame.
        stamp_ns: time of the scan.
        beams: number of beams, with or without an echo; 0 if unknown.
        odom_covariance: (3, 3) of x, y, yaw of odom_T_base; None if unknown.
    """

    points: Points
    odom_T_base: Pose2
    stamp_ns: int
    beams: int = 0
    odom_covariance: NDArray[np.float64] | None = None

    @property
    def is_informative(self) -> bool:
        """Whether enough beams have an echo to support or contradict a pose."""
        return len(self.points) > _LEAST_ECHOES * self.beams


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
        self._was_localized = False  # map_T_odom was confirmed by scans
        self._is_blind = False  # the newest scan has too few echoes
        self._recent = RecentScans(SCANS, APART_M, APART_RAD)
        self._path = RecentScans(PATH_SCANS, PATH_APART_M)
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
        self._is_given, self._was_localized = True, False
        self._hypotheses = 1
        self._path.clear()
        self._updated = None

    def locate_globally(self) -> None:
        """Forget the pose; the next scan begins a search of the whole map."""
        self.filter.forget()
        self.confidence.restart(is_given=False)
        self._is_given = self._was_localized = False
        self._clear_scans()
        self._updated = None

    def request_update(self) -> None:
        """Update at the next scan, also without motion."""
        self._updated = None

    def step(self, scan: ScanView) -> Located:
        """Use a scan."""
        used = thinned(scan.points, self.params.max_beams)
        is_seen = scan.is_informative
        if self.confidence.state is LocalizationState.LOST:
            self._clear_scans()  # it may have been carried
        if is_seen:
            self._recent.add(used, scan.odom_T_base)
            self._path.add(used, scan.odom_T_base)
        if self.filter.is_empty:
            if not is_seen or not self.filter.locate_globally(used):
                return Located(self.confidence.state, None, None, None, False)
            self._updated, self._searched_ns = scan, scan.stamp_ns
        elif not self._is_due(scan):
            return self._report(scan, is_updated=False)
        elif is_seen:
            self._correct(scan, used)
        else:
            self._drift(scan)
        return self._report(scan, is_updated=True)

    def follow_jump(self, new_T_old: Pose2) -> Pose2 | None:
        """Keep the pose if the odometry jumps: the robot does not.

        Args:
            new_T_old: from the odometry's frame before the jump to the one after.

        Returns:
            map_T_odom since the jump, if it is known.
        """
        self._recent.move_odometry(new_T_old)
        self._path.move_odometry(new_T_old)
        before = self._updated
        if before is not None:
            odom_T_base = new_T_old @ before.odom_T_base
            self._updated = replace(before, odom_T_base=odom_T_base)
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

    def _motion_to(self, scan: ScanView) -> Pose2 | None:
        """Return the odometry's motion since the last update; continue from here."""
        before, self._updated = self._updated, scan
        if before is None:
            return None
        return before.odom_T_base.inverse() @ scan.odom_T_base

    def _correct(self, scan: ScanView, used: Points) -> None:
        motion = self._motion_to(scan)
        if motion is not None:
            self.filter.predict(motion)
        is_localized = self.confidence.state is LocalizationState.LOCALIZED
        self.filter.update(used, is_localized=is_localized or self._is_given)
        self._is_blind = False

    def _drift(self, scan: ScanView) -> None:
        """Move by the odometry alone: the particles around the pose spread."""
        if not self._is_blind and self.confidence.state is LocalizationState.LOCALIZED:
            self.filter.keep_cluster()
        before = self._updated
        motion = self._motion_to(scan)
        if before is not None and motion is not None:
            self.filter.drift(motion, _noise_between(before, scan))
        self._is_blind = True

    def _estimate(self) -> ParticleEstimate:
        # A cluster has a largest radius, which a pose without scans may outgrow.
        is_one = self._is_blind and self._was_localized
        return self.filter.particles.whole if is_one else self.filter.estimate()

    def _report(self, scan: ScanView, *, is_updated: bool) -> Located:
        estimate = self._estimate()
        assert self._updated is not None, "an update came first"
        # Particles are those of the last update.
        map_T_odom = estimate.pose @ self._updated.odom_T_base.inverse()
        pose = map_T_odom @ scan.odom_T_base
        match = self.filter.match(pose, scan.points) if scan.is_informative else None
        before = self.confidence.state
        state = self.confidence.update(
            match, estimate.stddev_m, estimate.share, scan.stamp_ns
        )
        localized = LocalizationState.LOCALIZED
        if match is not None and state is localized:
            if before is not localized and not self._is_given:
                state = self._compare(scan, pose)
            elif before is localized and is_updated:
                state = self._verify(scan, pose, match)
        if state is LocalizationState.LOST:
            self._handle_loss(scan, before)
        is_new = is_updated or before is not localized
        # A given pose is used at once; a confirmed correction stays until the next.
        is_first = self._is_given and not self._was_localized
        is_known = state is localized or is_first
        if is_known and is_new and match is not None:
            self._map_T_odom = map_T_odom
            self._was_localized |= state is localized
        return Located(
            self.confidence.state,
            estimate,
            self._map_T_odom,
            match,
            is_updated,
            self._hypotheses,
            self.confidence.cause,
        )

    def _compare(self, scan: ScanView, pose: Pose2) -> LocalizationState:
        """Return localized if no other place explains the newest scans as well.

        Otherwise the filter continues with all these places.
        """
        if 0 <= scan.stamp_ns - self._compared_ns < _COMPARE_NS:
            self.confidence.doubt()
            return self.confidence.state
        self._compared_ns = scan.stamp_ns
        found = self.filter.hypotheses(pose, self._recent_points(scan))
        self._hypotheses = len(found.poses)
        best = Pose2(*found.poses[0].tolist())
        if self._hypotheses > 1 or best.distance_to(pose) > _SAME_M:
            self._continue_with(found, scan)
        return self.confidence.state

    def _verify(self, scan: ScanView, pose: Pose2, match: float) -> LocalizationState:
        """Return localized unless the pose jumps or the path proves another place.

        Scans along the path that fit the map well need no search of the map.
        """
        is_doubtful = match < self.params.localized_match
        period_ns = _COMPARE_NS if is_doubtful else _VERIFY_NS
        if self._map_T_odom is not None:
            expected = self._map_T_odom @ scan.odom_T_base
            if expected.distance_to(pose) > _SAME_M:
                self._confirm_again()
                return self.confidence.state
        if 0 <= scan.stamp_ns - self._compared_ns < period_ns:
            return self.confidence.state
        self._compared_ns, self._hypotheses = scan.stamp_ns, 1
        _, fit = self.filter.refined(pose, self._recent_points(scan))
        if fit > GOOD_FIT:
            return self.confidence.state
        used = thinned(scan.points, self.params.max_beams)
        path = self._path.backward_from(used, scan.odom_T_base)
        found = self.filter.rivals(pose, path)
        self._hypotheses += len(found.poses)
        better = found.poses[found.scores >= DECISIVE]
        if len(better):
            self._is_given = self._was_localized = False
            self._compared_ns = -_COMPARE_NS
            self._continue_with(Candidates(better, np.zeros(len(better))), scan)
            self.confidence.doubt(DoubtCause.ELSEWHERE)
        return self.confidence.state

    def _continue_with(self, found: Candidates, scan: ScanView) -> None:
        self.filter.spread_over(found)
        self._updated = scan
        self.confidence.doubt()

    def _confirm_again(self) -> None:
        """Keep the pose, and count it as localized once scans confirm it."""
        self.confidence.restart(is_given=True)
        self._is_given = True

    def _handle_loss(self, scan: ScanView, before: LocalizationState) -> None:
        """Search the map; a confirmed pose that is only uncertain is continued."""
        was_given = self._is_given or before is LocalizationState.LOCALIZED
        is_continued = was_given and before is not LocalizationState.LOCALIZING
        is_uncertain = self.confidence.cause is DoubtCause.UNCERTAIN
        self._is_given = is_continued and is_uncertain
        is_open = not self._is_given and not self.confidence.is_promising
        if is_open and scan.is_informative:
            self._search(scan)

    def _search(self, scan: ScanView) -> None:
        if 0 <= scan.stamp_ns - self._searched_ns < _SEARCH_NS:
            return
        self._searched_ns = scan.stamp_ns
        # Candidates are poses now; the others are those of the last update.
        motion = self._motion_to(scan)
        assert motion is not None, "the robot was localized before"
        self.filter.predict(motion)
        used = thinned(scan.points, self.params.max_beams)
        found = self.filter.candidates(used)
        if not self._return_home(scan, used, found):
            self.filter.recover(found, _LOST_SHARE)

    def _return_home(self, scan: ScanView, used: Points, found: Candidates) -> bool:
        """Continue where the odometry is since the robot was localized, if it fits.

        People who surrounded the robot have left; a robot that was carried sees
        something else there.
        """
        if not self._was_localized or self._map_T_odom is None:
            return False
        home, fit = self.filter.refined(self._map_T_odom @ scan.odom_T_base, used)
        is_matched = self.filter.match(home, scan.points) >= self.params.localized_match
        if not is_matched or found.scores.max(initial=fit) > fit + _FAR_BETTER:
            return False
        self.filter.set_pose(home, default_covariance(self.params))
        self._confirm_again()
        return True

    def _recent_points(self, scan: ScanView) -> Points:
        used = thinned(scan.points, self.params.max_beams)
        return self._recent.seen_from(used, scan.odom_T_base, MOST_POINTS)

    def _clear_scans(self) -> None:
        self._recent.clear()
        self._path.clear()


def _noise_between(before: ScanView, after: ScanView) -> NDArray[np.float64] | None:
    """Return the covariance of the motion between scans, if the odometry states it."""
    former, latter = before.odom_covariance, after.odom_covariance
    if former is None or latter is None or not is_usable(latter):
        return None
    return noise_of_motion(before.odom_T_base, former, after.odom_T_base, latter)


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
