"""Occupancy grids whose cells are not copied: a map of 200 m has 16 MB."""

import struct

from navette.msgs import serialize
from navette.msgs.nav_msgs.msg import MapMetaData, OccupancyGrid

_LARGE_CELLS = 2**18
# A serialised message begins with four bytes of encapsulation and the stamp of its
# header.
STAMP = slice(4, 12)


class LargeGrid:
    """A grid that its publisher does not change any more, serialised when it is sent.

    Attributes:
        head: CDR up to the cells.
        cells: the rest.
        stamp: of the header, as CDR.
        geometry: frame, extent and resolution, for comparison.
    """

    def __init__(self, message: OccupancyGrid) -> None:
        header, info = message.header, message.info
        empty = serialize(OccupancyGrid(header=header, info=info))
        self.cells = memoryview(message.data).cast("B")
        self.head = empty[:-4] + struct.pack("<I", len(self.cells))
        self.stamp = self.head[STAMP]
        extent = MapMetaData(
            resolution=info.resolution,
            width=info.width,
            height=info.height,
            origin=info.origin,
        )
        self.geometry = header.frame_id, serialize(extent)

    def __len__(self) -> int:
        return len(self.head) + len(self.cells)


Payload = bytes | LargeGrid
"""A serialised message."""


def payload_of(grid: OccupancyGrid) -> Payload:
    """Return a grid as it is sent."""
    return LargeGrid(grid) if len(grid.data) >= _LARGE_CELLS else serialize(grid)
