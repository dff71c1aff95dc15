"""An extended Kalman filter on a recorded drive: wheels, IMU and GNSS → one pose.

Wheel odometry measures 2 % too much, the IMU's turn rate is biased, and GNSS fixes have
an error of half a metre and an antenna 0.6 m ahead of the axle.

The same on the command line, with a plot::

    navette bag replay drive.mcap --node ekf --params-file ekf.yaml --record way.mcap
    navette bag plot way.mcap /odom/filtered.pose.pose.position.x:y

Prints::

    wheels:            8.38 m maximum error, 4.57 m mean error
    wheels, imu:       3.44 m maximum error, 1.08 m mean error
    wheels, imu, gps:  0.70 m maximum error, 0.25 m mean error
"""

import tempfile
from pathlib import Path

import numpy as np

import navette
from navette.bags import open_bag
from navette.msgs import deserialize
from navette.msgs.nav_msgs.msg import Odometry
from navette.navigation.localization.ekf.node import EkfNode
from navette.navigation.stack.replay import Replay

DRIVE = Path(__file__).parent / "data" / "drive.mcap"
# robot_localization's parameters. Order of the 15: x y z, roll pitch yaw, vx vy vz,
# vroll vpitch vyaw, ax ay az. Noise per second: the turn rate changes by 0.4 rad/s
# within 0.15 s, so that a filter with less than 2 lags in turns; the pose has what the
# biases of wheels and IMU add. With these values the mean NEES of x, y, yaw is 3.0 with
# all sensors, as expected.
PARAMETERS = """
ekf:
  ros__parameters:
    world_frame: odom
    odom0: /wheels/odometry
    odom0_config: [false, false, false, false, false, false,
                   true, true, false, false, false, true, false, false, false]
    process_noise_covariance: [
      0.002, 0.002, 0.0, 0.0, 0.0, 0.0002,
      0.5, 0.01, 0.0, 0.0, 0.0, 2.0, 0.01, 0.01, 0.0]
"""
IMU = """
    imu0: /imu/data
    imu0_config: [false, false, false, false, false, false,
                  false, false, false, false, false, true, false, false, false]
"""
GPS = """
    gps0: /gps/fix
    gps0_datum_deg: [45.75, -73.65]
"""


def track(path, topic):
    """Return stamps (N,) in s and positions (N, 2) in m of a topic's poses."""
    with open_bag(path) as bag:
        messages = [deserialize(m.data, Odometry) for m in bag.messages([topic])]
    stamps = [
        navette.Time.from_msg(m.header.stamp).nanoseconds * 1e-9 for m in messages
    ]
    places = [(m.pose.pose.position.x, m.pose.pose.position.y) for m in messages]
    return np.array(stamps), np.array(places)


def filtered(parameters, folder):
    """Return the filtered track."""
    file, way = folder / "ekf.yaml", folder / "way.mcap"
    file.write_text(parameters)
    arguments = ["--ros-args", "--params-file", file]
    with open_bag(DRIVE) as bag:
        replay = Replay(
            bag,
            [lambda c: EkfNode(context=c)],
            record=way,
            overwrite=True,
            arguments=arguments,
        )
        replay.run()
        replay.close()
    return track(way, "/odom/filtered")


true_stamps, true_places = track(DRIVE, "/ground_truth")
with tempfile.TemporaryDirectory() as folder:
    for name, parameters in (
        ("wheels:", PARAMETERS),
        ("wheels, imu:", PARAMETERS + IMU),
        ("wheels, imu, gps:", PARAMETERS + IMU + GPS),
    ):
        stamps, places = filtered(parameters, Path(folder))
        x, y = (np.interp(stamps, true_stamps, true_places[:, i]) for i in (0, 1))
        off = np.hypot(places[:, 0] - x, places[:, 1] - y)
        print(
            f"{name:18} {off.max():.2f} m maximum error, {off.mean():.2f} m mean error"
        )
