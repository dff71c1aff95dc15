"""The page applies updates to a large map, from above and in 3D."""

import shutil
import sys
from pathlib import Path

import numpy as np
import pytest
from test_viewer_javascript import run_node

from navette.msgs.map_msgs.msg import OccupancyGridUpdate
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.msgs.std_msgs.msg import Empty, Header
from navette.runtime import Context, Node
from navette.runtime.qos import QoSDurabilityPolicy, QoSProfile

sys.path.append(str(Path(__file__).parents[1] / "unit" / "viewer"))

from viewer_harness import Program

pytestmark = pytest.mark.long

LATCHED = QoSProfile(depth=1, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
EDGE, UPDATES, PERIOD_S = 600, 40, 0.05
LAST = 77
"""the value of the last cell after the updates"""


class Mapper(Node):
    """Changes parts of a map on request, each with an update and the whole map."""

    def __init__(self, context: Context) -> None:
        super().__init__("mapper", context=context)
        self._random = np.random.default_rng(4)
        self._cells = np.zeros((EDGE, EDGE), np.int8)
        self._left = 0
        self._map = self.create_publisher(OccupancyGrid, "/map", LATCHED)
        self._updates = self.create_publisher(OccupancyGridUpdate, "/map_updates", 10)
        self.create_subscription(Empty, "/begin", self._begin, 10)
        self.create_timer(PERIOD_S, self._on_timer)
        self._publish_map()

    def _begin(self, _: Empty) -> None:
        self._left = UPDATES

    def _on_timer(self) -> None:
        if self._left == 0:
            return
        self._left -= 1
        height, width = self._random.integers(20, 200, 2)
        row, column = self._random.integers(0, [EDGE - height, EDGE - width])
        if self._left == 0:
            row, column = EDGE - height, EDGE - width
        part = self._random.integers(0, 101, (height, width), np.int8)
        part[-1, -1] = LAST
        self._cells[row : row + height, column : column + width] = part
        update = OccupancyGridUpdate(header=self._header(), data=part.ravel())
        update.x, update.y = int(column), int(row)
        update.width, update.height = int(width), int(height)
        self._updates.publish(update)
        self._publish_map(update.header)

    def _header(self) -> Header:
        return Header(frame_id="map", stamp=self.get_clock().now().to_msg())

    def _publish_map(self, header: Header | None = None) -> None:
        grid = OccupancyGrid(header=header or self._header(), data=self._cells.ravel())
        grid.info.width, grid.info.height, grid.info.resolution = EDGE, EDGE, 0.05
        self._map.publish(grid)


@pytest.mark.slow
def test_a_page_that_applied_updates_shows_what_a_new_page_shows(
    tmp_path: Path,
) -> None:
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None:
        pytest.skip("Chromium is not installed")
    last = str(EDGE * EDGE - 1)
    with Program(Mapper) as program:
        url = program.viewer.url
        seen = run_node("grids.mjs", url, chromium, last, str(tmp_path))
    # The first map, and one whose update came before the page's subscription.
    assert seen.pop("wholes") <= 3
    assert seen == {"isSame2d": True, "isSame3d": True, "problems": []}, tmp_path
