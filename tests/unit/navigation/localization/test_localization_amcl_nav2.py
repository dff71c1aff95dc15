"""Parameters of Nav2's AMCL: all names of its files, and beam skipping."""

from pathlib import Path

import numpy as np

from navette.geometry import Pose2
from navette.msgs.nav_msgs.msg import OccupancyGrid, Odometry
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.navigation.grids import GridSpec
from navette.navigation.localization.amcl import AmclParams
from navette.navigation.localization.amcl.likelihood_field import LikelihoodField
from navette.navigation.localization.amcl.node import AmclNode
from navette.navigation.localization.amcl.particle_filter import ParticleFilter
from navette.runtime import Context, VirtualClock, ns_to_stamp
from navette.runtime.testing import GraphHarness

#: The section amcl of Nav2's nav2_params.yaml, with other values.
FILE = """
amcl:
  ros__parameters:
    alpha1: 0.1
    alpha2: 0.1
    alpha3: 0.1
    alpha4: 0.1
    alpha5: 0.1
    base_frame_id: "base_footprint"
    beam_skip_distance: 0.4
    beam_skip_error_threshold: 0.8
    beam_skip_threshold: 0.2
    do_beamskip: true
    freespace_downsampling: false
    global_frame_id: "map"
    lambda_short: 0.2
    laser_likelihood_max_dist: 1.5
    laser_max_range: 50.0
    laser_min_range: -1.0
    laser_model_type: "likelihood_field_prob"
    max_beams: 40
    max_particles: 1000
    min_particles: 300
    odom_frame_id: "odom"
    pf_err: 0.04
    pf_z: 0.98
    random_seed: 7
    recovery_alpha_fast: 0.0
    recovery_alpha_slow: 0.0
    resample_interval: 2
    robot_model_type: "nav2_amcl::DifferentialMotionModel"
    save_pose_rate: 0.25
    sigma_hit: 0.1
    tf_broadcast: true
    transform_tolerance: 0.5
    update_min_a: 0.1
    update_min_d: 0.2
    z_hit: 0.6
    z_max: 0.1
    z_rand: 0.4
    z_short: 0.1
    scan_topic: scan
    map_topic: map
    always_reset_initial_pose: false
    first_map_only: false
    set_initial_pose: true
    initial_pose: {x: 1.0, y: 2.0, z: 0.0, yaw: 0.5}
"""


def test_a_parameter_file_of_nav2_loads_and_its_topics_are_used(tmp_path: Path) -> None:
    path = tmp_path / "nav2_params.yaml"
    path.write_text(FILE)
    context = Context(clock=VirtualClock())
    with context:
        context.overrides.add_file(path)
        node = AmclNode(context=context)
        context.check_overrides()
        topics = dict(node.get_topic_names_and_types())
        assert topics["/scan"] == ["sensor_msgs/msg/LaserScan"]
        assert topics["/map"] == ["nav_msgs/msg/OccupancyGrid"]
        assert "/lidar" not in topics
        assert node.params.used_seed == 7
        assert node.params.beam_skip_distance == 0.4


def corridor() -> LikelihoodField:
    cells = np.zeros((80, 200), np.int8)
    cells[[0, -1], :] = cells[:, [0, -1]] = 100
    spec = GridSpec(0.05, 200, 80, Pose2(0.0, 0.0, 0.0))
    return LikelihoodField.of(cells, spec, sigma=0.1, random=0.1, reach_m=2.0)


def walls_seen(at: Pose2) -> np.ndarray:
    """Return what a robot sees: walls on both sides and at the end."""
    along = np.linspace(2.0, 9.0, 15)
    ends = [(x, y) for x in along for y in (0.025, 3.975)]
    ends += [(9.975, y) for y in np.linspace(0.5, 3.5, 10)]
    return at.inverse().apply(np.array(ends))


def test_beams_at_people_are_skipped_while_enough_of_the_others_agree() -> None:
    true = Pose2(3.0, 2.0, 0.0)
    walls = walls_seen(true)
    people = np.array([[1.0, 0.0], [1.0, 0.1], [1.1, 0.1], [1.2, 0.0]])
    points = np.concatenate([walls, people])
    params = AmclParams(do_beamskip=True, beam_skip_error_threshold=0.5)
    found = ParticleFilter(params, corridor(), np.random.default_rng(0))
    found.set_pose(true, np.diag([0.01, 0.01, 0.001]))
    assert np.array_equal(found._agreed(points), walls)
    far = Pose2(8.0, 1.0, 2.0)  # a wrong pose: nothing agrees, all beams count
    found.set_pose(far, np.diag([1e-4, 1e-4, 1e-4]))
    assert len(found._agreed(points)) == len(points)


def test_a_missing_map_is_reported_once() -> None:
    with GraphHarness() as graph:
        graph.add(AmclNode(context=graph.context))
        logs = graph.collect("/rosout", "rcl_interfaces/msg/Log")
        scan = LaserScan(angle_increment=0.1, range_max=10.0, ranges=[1.0] * 9)
        for _ in range(50):
            graph.publish("/lidar", scan)
            graph.run_for(0.1)
        texts = [log.msg for log in logs.messages if "no map" in log.msg]
        assert len(texts) == 1, texts
        assert texts[0].startswith("no map has arrived on /static_map")
        assert "--map FILE.yaml" in texts[0]


def test_a_pose_that_is_not_found_at_rest_is_reported_once() -> None:
    """From the middle of a square room four headings fit."""
    cells = np.zeros((120, 120), np.int8)
    cells[:2], cells[-2:], cells[:, :2], cells[:, -2:] = 100, 100, 100, 100
    angles = np.arange(120) * (2 * np.pi / 120)
    ranges = 2.9 / np.maximum(np.abs(np.cos(angles)), np.abs(np.sin(angles)))
    with GraphHarness() as graph:
        graph.add(AmclNode(context=graph.context))
        logs = graph.collect("/rosout", "rcl_interfaces/msg/Log")
        known = OccupancyGrid(data=cells.ravel())
        known.header.frame_id = "map"
        known.info.width, known.info.height, known.info.resolution = 120, 120, 0.05
        graph.publish("/static_map", known, latched=True)
        for _ in range(100):
            stamp = ns_to_stamp(graph.now_ns)
            odometry = Odometry(child_frame_id="base_link")
            odometry.header.frame_id, odometry.header.stamp = "odom", stamp
            odometry.pose.pose.orientation.w = 1.0
            scan = LaserScan(
                angle_increment=2 * np.pi / 120, range_max=10.0, ranges=ranges
            )
            scan.header.frame_id, scan.header.stamp = "base_link", stamp
            graph.publish("/odom/filtered", odometry)
            graph.publish("/lidar", scan)
            graph.run_for(0.1)
        texts = [log.msg for log in logs.messages if "Drive the robot" in log.msg]
        assert len(texts) == 1, [log.msg for log in logs.messages]
        assert texts[0].startswith("localizing: the pose on the map is unknown")
