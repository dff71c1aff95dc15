"""Large grids of a client that applies updates to them itself, as RViz does.

Updates (``map_msgs/OccupancyGridUpdate``) of a grid are on ``<topic>_updates``.
Publishers such as the map memory publish the whole grid after each of them, with the
same stamp, and announce a grid that replaces the one before with an update without
cells. A client that subscribes to both gets the grid only if updates did not suffice.
"""

from typing import NamedTuple

from navette.errors import DecodeError
from navette.msgs import deserialize
from navette.msgs.map_msgs.msg import OccupancyGridUpdate
from navette.viewer.large_grid import STAMP, LargeGrid
from navette.viewer.outbox import MessageFrame, Outbox
from navette.viewer.replies import Channel

_TYPE = "map_msgs/msg/OccupancyGridUpdate"
_SUFFIX = "_updates"


class _Update(NamedTuple):
    """The newest update of a topic that was queued for the client."""

    subscription_id: int
    stamp: bytes


class _Copy(NamedTuple):
    """What must be unchanged so that updates keep the client's grid complete."""

    geometry: tuple[str, bytes]
    updates_id: int
    grids_lost: int
    updates_lost: int


class GridCopies:
    """Queues the messages of a client, without grids that it can make itself.

    A grid is needed if it is the first of a subscription, has another extent than the
    one before or no update with its stamp, or if the outbox dropped an update.
    """

    def __init__(self, outbox: Outbox) -> None:
        self._outbox = outbox
        self._updates: dict[str, _Update] = {}
        self._copies: dict[int, _Copy] = {}

    def put(self, channel: Channel, frame: MessageFrame) -> None:
        """Queue a message, unless it is a grid that the client has."""
        stream, payload = frame.subscription_id, frame.payload
        if isinstance(payload, LargeGrid):
            update = self._updates.get(channel.topic)
            if not self._has(stream, payload, update):
                self._outbox.put_data(stream, frame)
                if update is not None and update.stamp == payload.stamp:
                    self._copies[stream] = self._copy(stream, payload, update)
            return
        self._outbox.put_data(stream, frame)
        if channel.type_name == _TYPE:
            grids = channel.topic.removesuffix(_SUFFIX)
            if _has_cells(payload):
                self._updates[grids] = _Update(stream, payload[STAMP])
            else:  # the next grid replaces the one before
                self._updates.pop(grids, None)

    def forget(self, subscription_id: int) -> None:
        """Note that a subscription has ended."""
        self._copies.pop(subscription_id, None)

    def clear(self) -> None:
        """Note that the client drops its grids: time went back."""
        self._copies.clear()

    def _has(self, stream: int, grid: LargeGrid, update: _Update | None) -> bool:
        if update is None or update.stamp != grid.stamp:
            return False
        return self._copies.get(stream) == self._copy(stream, grid, update)

    def _copy(self, stream: int, grid: LargeGrid, update: _Update) -> _Copy:
        lost, updates_id = self._outbox.lost, update.subscription_id
        return _Copy(grid.geometry, updates_id, lost(stream), lost(updates_id))


def _has_cells(update: bytes) -> bool:
    try:
        return len(deserialize(update, OccupancyGridUpdate).data) > 0
    except DecodeError:  # the client cannot apply it either
        return False
