"""The planner's inputs about space: map, keep-out zones, moving obstacles."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.msgs.nav2_dynamic_msgs.msg import ObstacleArray
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.msgs.sensor_msgs.msg import PointCloud2
from navette.navigation.grids import (
    NO_CELLS,
    NO_DISCS,
    CellWindow,
    HitPoints,
    MapPart,
    MapReader,
    MovingDiscs,
    ReceivedMap,
    discs_from_message,
    grid_from_message,
)
from navette.navigation.grids.checks import check_frame
from navette.navigation.grids.received_map import out_of_range
from navette.navigation.grids.spec import Cells
from navette.navigation.grids.zones import KeepOutZones, ZonedMap
from navette.navigation.planning.navigator import Navigator
from navette.navigation.planning.new_map import NewMap
from navette.navigation.planning.planning_grid import NO_HITS

# Age of the moving obstacles from which they are obsolete.
_MOVING_TIMEOUT_S = 0.5


class MapChange(NamedTuple):
    """A map and what changed in it; kept until the navigator can take it."""

    received: ReceivedMap
    part: MapPart | None
    """None: the whole map, or zones, may be new."""
    hits: NDArray[np.float64]
    zoned: ZonedMap | None

    def apply(self, navigator: Navigator, *, is_shared: bool) -> None:
        """Update the map of the navigator.

        Args:
            navigator: it changes.
            is_shared: whether a computation still uses the arrays.
        """
        if is_shared:
            navigator.planner.map.detach()
            self.received.share()
            if self.zoned is not None:
                self.zoned.share()
        changed = None if self.part is None else self.received.update(self.part)
        cells = _with_zones(self.received, self.zoned, changed or NO_CELLS)
        navigator.set_map(NewMap(cells, self.received.spec, self.hits, changed))


def _with_zones(
    received: ReceivedMap, zoned: ZonedMap | None, changed: CellWindow = NO_CELLS
) -> Cells:
    return received.cells if zoned is None else zoned.update(received, changed)


class MapInputs:
    """The newest map, keep-out zones and moving obstacles, converted from messages.

    The ``receive_…`` methods raise InvalidInputError for an invalid message.

    Args:
        maps: reads the map.
    """

    def __init__(self, maps: MapReader) -> None:
        self._maps = maps
        self._hits = HitPoints()
        self._zoned: ZonedMap | None = None
        self._moving = MovingDiscs(NO_DISCS, 0)

    @property
    def has_map(self) -> bool:
        """Whether a map has arrived."""
        return self._maps.map is not None

    def receive_points(self, msg: PointCloud2) -> bool:
        """Store where beams ended; return whether that belongs to the newest map."""
        with out_of_range():
            stamp_ns = self._hits.receive(msg)
        return self.has_map and stamp_ns == self._maps.stamp_ns

    def receive_zones(self, msg: OccupancyGrid, map_frame: str) -> None:
        """Store the keep-out zones, for the next change of the map."""
        check_frame("keep-out zones", msg.header.frame_id, map_frame)
        with out_of_range():
            self._zoned = ZonedMap(KeepOutZones(*grid_from_message(msg)))

    def receive_moving(self, msg: ObstacleArray, map_frame: str) -> None:
        """Store the moving obstacles."""
        self._moving = discs_from_message(msg, map_frame)

    def moving_at(self, now_ns: int) -> NDArray[np.float64]:
        """Return the moving obstacles (M, 5) at a time; none if they are obsolete."""
        return self._moving.at(now_ns, _MOVING_TIMEOUT_S)

    def change(self, part: MapPart | None) -> MapChange:
        """Return the change from the map before to the newest.

        Args:
            part: None if all may be new.
        """
        assert self._maps.map is not None, "called with a map"
        return MapChange(self._maps.map, part, self._newest_hits(), self._zoned)

    def restore(self, navigator: Navigator) -> None:
        """Give a new navigator the map and zones that arrived so far."""
        known = self._maps.map
        if known is not None:
            cells = _with_zones(known, self._zoned)
            navigator.set_map(NewMap(cells, known.spec, self._newest_hits()))

    def _newest_hits(self) -> NDArray[np.float64]:
        hits = self._hits.at(self._maps.stamp_ns)
        return NO_HITS if hits is None else hits
