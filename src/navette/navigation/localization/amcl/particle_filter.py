"""Augmented, adaptive Monte Carlo localization.

Thrun, Burgard, Fox, "Probabilistic Robotics" (2005), table 8.3, with KLD sampling.
Where the algorithm adds random poses, here candidates of a search of the whole map are
added: poses from which the present scan fits. While the robot is localized none are
added: where furniture was moved, wrong places fit a scan better than the right one.
"""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2, wrap_angles
from navette.navigation.localization.amcl.estimate import (
    ParticleEstimate,
    Particles,
)
from navette.navigation.localization.amcl.evidence import GOOD_FIT, rivals
from navette.navigation.localization.amcl.global_search import (
    Candidates,
    search_map,
)
from navette.navigation.localization.amcl.hypotheses import hypotheses
from navette.navigation.localization.amcl.likelihood_field import (
    LikelihoodField,
    Points,
)
from navette.navigation.localization.amcl.motion_model import (
    Alphas,
    add_noise,
    move_differential,
    move_omni,
)
from navette.navigation.localization.amcl.params import AmclParams
from navette.navigation.localization.amcl.recent_scans import Seen
from navette.navigation.localization.amcl.resampling import (
    kld_limit,
    occupied_bins,
    resampled,
)

# Spread of the particles around a candidate of the search.
_SEED_STDDEV = (0.08, 0.08, math.radians(3.0))
# Candidates are drawn by this power of their likelihood: candidates that fit a little
# less well survive until the robot has moved.
_SEED_BEAMS = 6.0
# Alphas of a motion without noise.
_EXACT: Alphas = (0.0, 0.0, 0.0, 0.0, 0.0)
# Updates between two searches of the whole map.
_SEARCH_EVERY = 5
# Largest share of particles that recovery replaces in an update.
_MOST_REPLACED = 0.5
# Below this ratio of the short-term to the long-term mean recovery begins, unless a
# particle fits well: the mean also falls where walls are far, and no search finds a
# better pose.
_RECOVERY_RATIO = 0.8


class ParticleFilter:
    """Particles of the pose of the base in the map.

    Args:
        params: models and numbers.
        field: of the known map.
        rng: source of all noise.
    """

    def __init__(
        self, params: AmclParams, field: LikelihoodField, rng: np.random.Generator
    ) -> None:
        self.params = params
        self._field = field
        self._rng = rng
        self._alphas = tuple(getattr(params, f"alpha{i}") for i in range(1, 6))
        omni = params.robot_model_type == "nav2_amcl::OmniMotionModel"
        self._move = move_omni if omni else move_differential
        self.forget()

    def forget(self) -> None:
        """Drop all particles."""
        self.particles = Particles.of(np.empty((0, 3)))
        self._forget_means()

    @property
    def is_empty(self) -> bool:
        """Whether no pose has been given or found yet."""
        return not len(self.particles)

    def set_pose(self, pose: Pose2, covariance: NDArray[np.float64]) -> None:
        """Start at a pose with a covariance (3, 3) of x, y, yaw."""
        count = self.params.max_particles
        mean = np.array([pose.x, pose.y, pose.yaw])
        drawn = self._rng.multivariate_normal(
            mean, covariance, count, check_valid="ignore"
        )
        drawn[:, 2] = wrap_angles(drawn[:, 2])
        self.particles = Particles.of(drawn)
        self._forget_means()

    def locate_globally(self, points: Points) -> bool:
        """Start at all poses from which a scan fits; return whether there are any."""
        found = search_map(self._field, points)
        if not len(found.poses):
            return False
        self.particles = Particles.of(self._around(found, self.params.max_particles))
        self._forget_means()
        return True

    def predict(self, motion: Pose2) -> None:
        """Move the particles by the odometry's motion, base before to base after."""
        poses = self.particles.poses.copy()
        self._move(poses, motion, self._alphas, self._rng)
        self.particles = Particles(poses, self.particles.weights)

    def drift(self, motion: Pose2, noise: NDArray[np.float64] | None) -> None:
        """Move without a scan that corrects: the number follows the growing spread.

        Args:
            motion: base before to base after, of the odometry.
            noise: covariance (3, 3) of the motion, base frame; None: by the alphas.
                These are larger, so that particles between two scans are diverse.
        """
        if noise is None:
            self.predict(motion)
        else:
            moved = self.particles.poses.copy()
            self._move(moved, motion, _EXACT, self._rng)
            add_noise(moved, noise, self._rng)
            self.particles = Particles(moved, self.particles.weights)
        poses, weights = self.particles.poses, self.particles.weights
        count = self._count_for(poses)
        if count > len(poses):
            self.particles = Particles.of(resampled(poses, weights, count, self._rng))

    def keep_cluster(self) -> None:
        """Drop the particles outside the heaviest cluster."""
        self.particles = self.particles.near(self.estimate().pose)

    def update(self, points: Points, *, is_localized: bool = False) -> None:
        """Weight by a scan's points (M, 2), base frame; resample when due.

        ``is_localized``: beams that most particles contradict may be skipped, and no
        candidates of other places are added.
        """
        if self.params.do_beamskip and is_localized:
            points = self._agreed(points)
        if not len(points):
            return
        poses, before = self.particles.poses, self.particles.weights
        scores = self._field.scores(poses, points)
        self._best = float(scores.max())
        likelihood = np.exp(scores)  # geometric mean of the beams
        self._note_quality(float(before @ likelihood))
        beams = min(self.params.independent_beams, float(len(points)))
        log_weights = np.log(before + 1e-300) + beams * (scores - scores.max())
        weights = np.exp(log_weights - log_weights.max())
        self.particles = Particles(poses, weights / weights.sum())
        self._updates += 1
        if self._updates % self.params.resample_interval == 0:
            self._resample()
            if not is_localized:
                self._recover_if_worse(points)

    def estimate(self) -> ParticleEstimate:
        """Return the heaviest cluster."""
        return self.particles.estimate

    def match(self, pose: Pose2, points: Points) -> float:
        """Return the share of points that end at obstacles of the map; 0 … 1."""
        within_m = max(2.0 * self.params.sigma_hit, 1.5 * self._field.spec.resolution)
        return self._field.share_within(np.array(pose), points, within_m)

    def candidates(self, points: Points) -> Candidates:
        """Return the poses of the map from which points (M, 2), base, fit."""
        return search_map(self._field, points)

    def refined(self, pose: Pose2, points: Points) -> tuple[Pose2, float]:
        """Return a pose moved uphill, and the mean log likelihood of points there."""
        poses, scores = self._field.refined(np.array([pose]), points, 0.1, 0.05)
        return Pose2(*poses[0].tolist()), float(scores[0])

    def rivals(self, pose: Pose2, scans: Sequence[Seen]) -> Candidates:
        """Return places with notable evidence along the path against a pose."""
        return rivals(self._field, scans, pose)

    def recover(self, found: Candidates, share: float) -> None:
        """Replace a share of the particles by candidates of a search of the map."""
        count = round(share * len(self.particles))
        if not count or not len(found.poses):
            return
        poses = self.particles.poses.copy()
        order = self._rng.permutation(len(poses))[:count]
        poses[order] = self._around(found, count)
        self.particles = Particles.of(poses)

    def hypotheses(self, pose: Pose2, points: Points) -> Candidates:
        """Return the poses of the map that explain points as well as ``pose`` does."""
        return hypotheses(self._field, points, pose)

    def spread_over(self, found: Candidates) -> None:
        """Continue with equally many particles around each of some poses."""
        count = self.params.max_particles
        chosen = np.arange(count) % len(found.poses)
        noise = self._rng.normal(size=(count, 3)) * _SEED_STDDEV
        self.particles = Particles.of(found.poses[chosen] + noise)

    def _agreed(self, points: Points) -> Points:
        """Return the points with which enough particles agree; else all."""
        params = self.params
        poses = self.particles.poses
        near = self._field.agreement(poses, points, params.beam_skip_distance)
        kept = near > params.beam_skip_threshold
        skipped = len(points) - np.count_nonzero(kept)
        is_wrong = skipped >= params.beam_skip_error_threshold * len(points)
        return points if is_wrong else points[kept]

    def _forget_means(self) -> None:
        self._slow = self._fast = 0.0
        self._best = -math.inf
        self._updates = self._searched = 0

    def _note_quality(self, mean: float) -> None:
        params = self.params
        if not self._slow:
            self._slow = self._fast = mean
            return
        # It rises fast: at first the particles are spread, and most of them are wrong.
        rises = mean > self._slow
        slow = params.recovery_alpha_fast if rises else params.recovery_alpha_slow
        self._slow += slow * (mean - self._slow)
        self._fast += params.recovery_alpha_fast * (mean - self._fast)

    def _resample(self) -> None:
        poses, weights = self.particles.poses, self.particles.weights
        drawn = resampled(poses, weights, self.params.max_particles, self._rng)
        count = self._count_for(drawn)
        if count < len(drawn):
            drawn = resampled(poses, weights, count, self._rng)
        self.particles = Particles.of(drawn)

    def _count_for(self, poses: NDArray[np.float64]) -> int:
        """Return the number of particles for the spread of poses (N, 3)."""
        params = self.params
        needed = kld_limit(occupied_bins(poses), params.pf_err, params.pf_z)
        return min(max(needed, params.min_particles), params.max_particles)

    def _recover_if_worse(self, points: Points) -> None:
        """Add candidates of the whole map if the weights fall."""
        params = self.params
        ratio = self._fast / self._slow if self._slow else 1.0
        due = self._updates - self._searched >= _SEARCH_EVERY
        is_worse = ratio < _RECOVERY_RATIO and self._best < GOOD_FIT
        if params.recovery_alpha_slow and is_worse and due:
            self._searched = self._updates
            share = min(_MOST_REPLACED, 1.0 - ratio)
            self.recover(self.candidates(points), share)

    def _around(self, found: Candidates, count: int) -> NDArray[np.float64]:
        """Return ``count`` particles around candidates, drawn by their likelihood."""
        weights = np.exp(_SEED_BEAMS * (found.scores - found.scores.max()))
        drawn = resampled(found.poses, weights, count, self._rng)
        noisy: NDArray[np.float64] = drawn + self._rng.normal(size=(count, 3)) * (
            _SEED_STDDEV
        )
        return noisy
