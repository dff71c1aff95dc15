"""The planner's inputs about space: map, keep-out zones, moving obstacles."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidInputError, InvalidValueError
from navette.msgs.map_msgs.msg import OccupancyGridUpdate
from navette.msgs.nav2_dynamic_msgs.msg import ObstacleArray
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.msgs.sensor_msgs.msg import PointCloud2
from navette.navigation.grids import (
    NO_DISCS,
    HitPoints,
    MovingDiscs,
    discs_from_message,
    grid_from_message,
    window_from_message,
)
from navette.navigation.grids.checks import check_frame
from navette.navigation.grids.zones import KeepOutZones
from navette.navigation.planning.navigator import Navigator
from navette.navigation.planning.planning_grid import NO_HITS
from navette.navigation.planning.received_map import MapPart, NewMap, ReceivedMap

# Age of the moving obstacles from which they are obsolete.
_MOVING_TIMEOUT_S = 0.5


class MapChange(NamedTuple):
    """A map and what changed in it; kept until the navigator can take it."""

    received: ReceivedMap
    part: MapPart | None
    hits: NDArray[np.float64]

    def apply(self, navigator: Navigator, *, is_shared: bool) -> None:
        """Update the map of the navigator.

        Args:
            navigator: it changes.
            is_shared: whether a computation still uses the arrays.
        """
        if is_shared:
            navigator.planner.map.detach()
            self.received.share()
        changed = self.received.update(self.part)
        cells, spec = self.received.cells, self.received.spec
        navigator.set_map(NewMap(cells, spec, self.hits, changed))


class MapInputs:
    """The newest map, keep-out zones and moving obstacles, converted from messages.

    The ``receive_…`` methods raise InvalidInputError for an invalid message.
    """

    def __init__(self) -> None:
        self._map: ReceivedMap | None = None
        self._map_ns = 0
        self._updated_ns: int | None = None  # stamp of the newest update
        self._hits = HitPoints()
        self._zones: KeepOutZones | None = None
        self._moving = MovingDiscs(NO_DISCS, 0)

    @property
    def has_map(self) -> bool:
        """Whether a map has arrived."""
        return self._map is not None

    def receive_map(self, msg: OccupancyGrid, stamp_ns: int, map_frame: str) -> bool:
        """Store the map; return whether it is new: an update may have preceded it."""
        check_frame("map", msg.header.frame_id, map_frame)
        with _out_of_range():
            occupancy, spec = grid_from_message(msg)
        known = self._map
        if known is not None and known.spec == spec and stamp_ns == self._updated_ns:
            return False
        self._map, self._map_ns = ReceivedMap(occupancy, spec), stamp_ns
        return True

    def receive_update(
        self, msg: OccupancyGridUpdate, stamp_ns: int, map_frame: str
    ) -> MapPart | None:
        """Return the part that changed; None if the whole map is newer, or follows."""
        check_frame("map update", msg.header.frame_id, map_frame)
        if self._map is None or stamp_ns <= self._map_ns:
            return None
        with _out_of_range():
            part = MapPart(*window_from_message(msg, self._map.spec))
        self._map_ns = self._updated_ns = stamp_ns
        return part

    def receive_points(self, msg: PointCloud2) -> bool:
        """Store where beams ended; return whether that belongs to the newest map."""
        with _out_of_range():
            stamp_ns = self._hits.receive(msg)
        return self._map is not None and stamp_ns == self._map_ns

    def receive_zones(self, msg: OccupancyGrid, map_frame: str) -> KeepOutZones:
        """Store and return the keep-out zones."""
        check_frame("keep-out zones", msg.header.frame_id, map_frame)
        with _out_of_range():
            self._zones = KeepOutZones(*grid_from_message(msg))
        return self._zones

    def receive_moving(self, msg: ObstacleArray, map_frame: str) -> None:
        """Store the moving obstacles."""
        self._moving = discs_from_message(msg, map_frame)

    def moving_at(self, now_ns: int) -> NDArray[np.float64]:
        """Return the moving obstacles (M, 5) at a time; none if they are obsolete."""
        return self._moving.at(now_ns, _MOVING_TIMEOUT_S)

    def change(self, part: MapPart | None) -> MapChange:
        """Return the change from the map before to the newest; None: all is new."""
        assert self._map is not None, "called with a map"
        return MapChange(self._map, part, self._newest_hits())

    def restore(self, navigator: Navigator) -> None:
        """Give a new navigator the map and zones that arrived so far."""
        if self._map is not None:
            known = self._map
            navigator.set_map(NewMap(known.cells, known.spec, self._newest_hits()))
        if self._zones is not None:
            navigator.keep_out(self._zones)

    def _newest_hits(self) -> NDArray[np.float64]:
        hits = self._hits.at(self._map_ns)
        return NO_HITS if hits is None else hits


@contextmanager
def _out_of_range() -> Iterator[None]:
    """Convert the error of an invalid value to that of a message to drop."""
    try:
        yield
    except InvalidValueError as error:
        raise InvalidInputError("out_of_range", str(error)) from None
