"""Parameters of the Monte Carlo localization, under the names of Nav2's AMCL."""

from dataclasses import dataclass

from navette.errors import ParameterError
from navette.msgs import topics
from navette.params import Params, param


def _noise(meaning: str) -> float:
    found: float = param(0.2, meaning, at_least=0.0, at_most=100.0)
    return found


def _beam_model(default: float) -> float:
    found: float = param(
        default,
        "of the beam model only: no effect on the likelihood field, as in Nav2",
        at_least=0.0,
    )
    return found


@dataclass(frozen=True, kw_only=True)
class AmclParams(Params):
    """Frames, particles, models of motion and sensor, recovery.

    The names are Nav2's and carry no unit: lengths are metres, angles radians.
    """

    base_frame_id: str = param("base_link", "frame of the robot's base")
    odom_frame_id: str = param("odom", "frame of the odometry")
    global_frame_id: str = param("map", "frame of the map")
    tf_broadcast: bool = param(True, "whether map → odom is published")
    transform_tolerance: float = param(
        1.0, "how far ahead map → odom is stamped, seconds", at_least=0.0, at_most=10.0
    )
    scan_topic: str = param(topics.LIDAR.name, "topic of the scans")
    map_topic: str = param(topics.STATIC_MAP.name, "topic of the known map")
    rate_hz: float = param(
        20.0, "scans that are used per second, at most", at_least=1.0, at_most=200.0
    )
    seed: int = param(0, "seed of the particles", at_least=0)
    random_seed: int = param(-1, "seed instead of the other one; -1: none", at_least=-1)

    set_initial_pose: bool = param(
        False,
        "whether to start at initial_pose.x, .y, .yaw; false: anywhere on the map, "
        "by global localization",
    )
    always_reset_initial_pose: bool = param(
        False, "whether a new map resets the pose to initial_pose, too"
    )
    first_map_only: bool = param(False, "whether later maps are ignored")
    initial_stddev_m: float = param(
        0.3,
        "stddev of x and y of an initial pose without covariance",
        at_least=1e-3,
        at_most=100.0,
    )
    initial_stddev_rad: float = param(
        0.2,
        "stddev of the heading of an initial pose without covariance",
        at_least=1e-3,
        at_most=10.0,
    )

    robot_model_type: str = param(
        "nav2_amcl::DifferentialMotionModel",
        "model of the odometry's errors",
        choices=("nav2_amcl::DifferentialMotionModel", "nav2_amcl::OmniMotionModel"),
    )
    alpha1: float = _noise("noise of the rotation, by rotation")
    alpha2: float = _noise("noise of the rotation, by translation")
    alpha3: float = _noise("noise of the translation, by translation")
    alpha4: float = _noise("noise of the translation, by rotation")
    alpha5: float = _noise("noise of the motion to the side, by translation (omni)")
    update_min_d: float = param(
        0.1, "translation after which the filter is updated", at_least=0.0
    )
    update_min_a: float = param(
        0.1, "rotation after which the filter is updated", at_least=0.0
    )

    laser_model_type: str = param(
        "likelihood_field",
        "sensor model; both names are the product of the beams' likelihoods",
        choices=("likelihood_field", "likelihood_field_prob"),
    )
    laser_likelihood_max_dist: float = param(
        2.0,
        "distance from an obstacle beyond which all places are equal",
        at_least=0.01,
        at_most=100.0,
    )
    laser_max_range: float = param(
        100.0, "ranges from here on are not used; -1: the scanner's limit", at_least=-1
    )
    laser_min_range: float = param(
        -1.0, "ranges up to this are not used; -1: the scanner's limit", at_least=-1
    )
    max_beams: int = param(
        60, "beams of a scan that are used", at_least=2, at_most=10_000
    )
    sigma_hit: float = param(
        0.15,
        "stddev of a range, with the error of the map",
        at_least=1e-3,
        at_most=10.0,
    )
    z_hit: float = param(
        0.9, "weight of beams that hit the map", at_least=1e-3, at_most=1e3
    )
    z_rand: float = param(
        0.1, "weight of beams that hit something else", at_least=1e-6, at_most=1e3
    )
    z_short: float = _beam_model(0.05)
    z_max: float = _beam_model(0.05)
    lambda_short: float = _beam_model(0.1)
    do_beamskip: bool = param(
        False,
        "whether beams that most particles contradict, as at people, are not used "
        "while the robot is localized",
    )
    beam_skip_distance: float = param(
        0.5,
        "a particle contradicts a beam that ends farther from the map's obstacles",
        above=0.0,
        at_most=100.0,
    )
    beam_skip_threshold: float = param(
        0.3,
        "a beam is skipped if at most this share of the particles agrees with it",
        at_least=0.0,
        at_most=1.0,
    )
    beam_skip_error_threshold: float = param(
        0.9,
        "all beams are used if at least this share of them would be skipped: the pose "
        "is wrong",
        above=0.0,
        at_most=1.0,
    )
    independent_beams: float = param(
        15.0,
        "beams that the used ones count for: neighbours have the same errors",
        at_least=0.1,
        at_most=1e5,
    )

    max_particles: int = param(
        2000, "largest number of particles", at_least=10, at_most=100_000
    )
    min_particles: int = param(
        400, "least number of particles", at_least=10, at_most=100_000
    )
    pf_err: float = param(
        0.05, "KLD sampling: error of the distribution", at_least=1e-3, below=1.0
    )
    pf_z: float = param(
        0.99, "KLD sampling: quantile of the error", above=0.5, below=1.0
    )
    resample_interval: int = param(
        1, "updates between two resamplings", at_least=1, at_most=1000
    )
    recovery_alpha_fast: float = param(
        0.1, "decay of the short-term mean of the weights", at_least=0.0, below=1.0
    )
    recovery_alpha_slow: float = param(
        0.001, "decay of the long-term mean; 0: no recovery", at_least=0.0, below=1.0
    )

    save_pose_rate: float = param(
        0.5,
        "no effect: the pose is not stored, as in Nav2 without a file",
        at_least=0.0,
    )
    freespace_downsampling: bool = param(
        False, "no effect: the search of the map always has a coarse spacing"
    )

    lost_match: float = param(
        0.35,
        "the robot is lost when less than this share of the beams ends at obstacles of "
        "the map",
        at_least=0.0,
        at_most=1.0,
    )
    localized_match: float = param(
        0.55, "share of such beams from which it is localized again", above=0.0
    )
    lost_stddev_m: float = param(
        0.7, "the robot is lost when its position is less certain than this", above=0.0
    )
    localized_stddev_m: float = param(
        0.35, "uncertainty up to which it is localized again", above=0.0
    )
    lost_time_s: float = param(
        1.0, "how long that must last", at_least=0.0, at_most=60.0
    )

    @property
    def used_seed(self) -> int:
        """Seed of the particles, under either name."""
        return self.seed if self.random_seed < 0 else self.random_seed

    def check(self) -> None:
        if self.min_particles > self.max_particles:
            raise ParameterError(
                f"parameter 'min_particles': {self.min_particles}; must be at most "
                f"max_particles, {self.max_particles}"
            )
        if self.localized_match < self.lost_match:
            raise ParameterError(
                f"parameter 'localized_match': {self.localized_match}; must be at "
                f"least lost_match, {self.lost_match}"
            )
