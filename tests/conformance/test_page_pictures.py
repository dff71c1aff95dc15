"""The page in three sizes and two themes, compared with the pictures beside this file.

After a wanted change: ``NAVETTE_WRITE_PICTURES=1 pytest -m long <this file>``.
"""

import os
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest
from test_viewer_javascript import run_node

from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from navette.msgs.geometry_msgs.msg import Pose, PoseStamped, TransformStamped
from navette.msgs.nav_msgs.msg import OccupancyGrid, Odometry
from navette.msgs.nav_msgs.msg import Path as PathMessage
from navette.msgs.std_msgs.msg import Header
from navette.msgs.tf2_msgs.msg import TFMessage
from navette.runtime import Context, Node
from navette.runtime.qos import QoSDurabilityPolicy, QoSProfile

sys.path.append(str(Path(__file__).parents[1] / "unit" / "viewer"))

from viewer_harness import Program

pytestmark = pytest.mark.long

LATCHED = QoSProfile(depth=1, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
STORED = Path(__file__).parent / "pictures"
# Of brightness; fonts differ between machines, so that text is not compared exactly.
MOST_MEAN, MOST_SHARE = 5.0, 0.06


class StillRobot(Node):
    """A robot that stands in a room with a path before it."""

    def __init__(self, context: Context) -> None:
        super().__init__("robot", context=context)
        header = Header(frame_id="map")
        grid = OccupancyGrid(header=header)
        grid.info.width, grid.info.height, grid.info.resolution = 80, 60, 0.1
        cells = np.zeros((60, 80), np.int8)
        cells[[0, 1, -1, -2], :] = cells[:, [0, 1, -1, -2]] = 100
        cells[20:30, 30:50] = 100
        cells[45:, 55:] = -1
        grid.data = cells.ravel()
        status = DiagnosticStatus(name="planner", message="following")
        status.values = [
            KeyValue(key="goal_x", value="6.0"),
            KeyValue(key="goal_y", value="1.0"),
        ]
        transform = TransformStamped(header=header, child_frame_id="base_link")
        transform.transform.translation.x, transform.transform.translation.y = 1.0, 4.0
        for topic, message in (
            ("/map", grid),
            ("/path", PathMessage(header=header, poses=_poses(header))),
            ("/planner/status", status),
            ("/tf_static", TFMessage(transforms=[transform])),
        ):
            self.create_publisher(type(message), topic, LATCHED).publish(message)
        self._odometry = self.create_publisher(Odometry, "/odom/filtered", 10)
        self.create_timer(0.1, self._publish_odometry)

    def _publish_odometry(self) -> None:
        odometry = Odometry(header=Header(frame_id="map"), child_frame_id="base_link")
        odometry.pose.pose.position.x, odometry.pose.pose.position.y = 1.0, 4.0
        self._odometry.publish(odometry)


def _poses(header: Header) -> list[PoseStamped]:
    poses = []
    for share in np.linspace(0.0, 1.0, 30):
        pose = Pose()
        pose.position.x, pose.position.y = 1.0 + 5.0 * share, 4.0 - 3.0 * share**2
        poses.append(PoseStamped(header=header, pose=pose))
    return poses


@pytest.mark.slow
def test_the_page_looks_as_stored(tmp_path: Path) -> None:
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None:
        pytest.skip("Chromium is not installed")
    mode = "write" if os.environ.get("NAVETTE_WRITE_PICTURES") else "compare"
    with Program(StillRobot) as program:
        seen = run_node(
            "pictures.mjs",
            program.viewer.url,
            chromium,
            str(STORED),
            str(tmp_path),
            mode,
        )
    assert len(seen) == 6
    if mode == "compare":
        far = {
            name: difference
            for name, difference in seen.items()
            if difference["mean"] > MOST_MEAN or difference["share"] > MOST_SHARE
        }
        assert far == {}, f"compare {tmp_path} with {STORED}"
