"""The newest map of a reader: whole, and then the parts that changed."""

from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import islice
from typing import NamedTuple

import numpy as np

from navette.errors import InvalidInputError, InvalidValueError
from navette.geometry.messages import stamp_of
from navette.msgs.map_msgs.msg import OccupancyGridUpdate
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.navigation.grids.checks import check_frame
from navette.navigation.grids.messages import grid_from_message, window_from_message
from navette.navigation.grids.shared_cells import SharedCells
from navette.navigation.grids.spec import Cells, GridSpec
from navette.navigation.grids.windows import NO_CELLS, CellWindow

# Updates that are kept for a whole map from before them, which arrives after them.
_MOST_UPDATES = 20


class MapPart(NamedTuple):
    """New cells (h, w) of a window of the map."""

    cells: Cells
    window: CellWindow
    whole: Cells | None = None
    """(H, W) the map with these cells, if it has arrived as a whole, too"""


NO_PART = MapPart(np.empty((0, 0), np.int8), NO_CELLS)
"""Nothing has changed."""


class ReceivedMap(SharedCells):
    """A map of a message.

    Attributes:
        cells: (H, W) −1 unknown, 0 free … 100 occupied.
        spec: their geometry.
    """

    def __init__(self, cells: Cells, spec: GridSpec) -> None:
        super().__init__(cells)
        self.spec = spec

    def update(self, part: MapPart | None) -> CellWindow:
        """Change a part; return what has changed."""
        if part is None:
            return NO_CELLS
        if part.whole is not None:
            self.replace(part.whole)
        elif not part.window.is_empty:
            self.writable()[part.window.slices] = part.cells
        return part.window


class _Update(NamedTuple):
    """An update, its place in the sequence of its publisher, and its stamp."""

    number: int | None
    stamp_ns: int
    message: OccupancyGridUpdate

    @property
    def is_empty(self) -> bool:
        """Whether the whole map of this stamp replaces the map."""
        return bool(self.message.width * self.message.height == 0)

    def follows(self, other: "_Update") -> bool:
        """Return whether no update is missing in between; stamps may go back."""
        return (
            self.number is not None
            and other.number is not None
            and self.number == other.number + 1
            and self.stamp_ns > other.stamp_ns
        )


class _Whole(NamedTuple):
    """A whole map as a part of the one before, and its stamp."""

    part: MapPart
    stamp_ns: int


class MapReader:
    """Reads a map from whole maps and from updates, and detects missing updates.

    The publisher numbers its updates. Each map has one, with the stamp of the map: the
    new cells, or none if the whole map replaces the one before. Thus a map is followed
    by the update after that of its own stamp. Other updates do not change it: the map
    is behind until a whole map arrives, which the later updates follow.

    Attributes:
        map: the newest map, for :meth:`ReceivedMap.update` with each of
            :meth:`next_part`; None before the first one.
        stamp_ns: its stamp, with the parts taken so far.
    """

    def __init__(self) -> None:
        self.forget()

    def forget(self) -> None:
        """Drop the map; the next one must be whole."""
        self.map: ReceivedMap | None = None
        self.stamp_ns = 0
        # The newest ones, without a gap.
        self._updates = deque[_Update](maxlen=_MOST_UPDATES)
        self._is_outdated = False  # updates between the map and these are missing
        self._next_whole: _Whole | None = None  # that the next updates lead to

    @property
    def is_behind(self) -> bool:
        """Whether updates arrived that cannot be applied to the map."""
        later = self._later()
        if later is None:
            return bool(self._updates)
        return any(each.is_empty for each in later)

    def receive_map(self, msg: OccupancyGrid, map_frame: str) -> bool:
        """Replace the map by a whole one, unless the present one is as new.

        A whole map to which updates lead that were not taken yet becomes the
        :meth:`next_part`: where it differs is known.

        Returns:
            Whether the map was replaced.

        Raises:
            InvalidInputError: another frame, or invalid values.
        """
        check_frame("map", msg.header.frame_id, map_frame)
        stamp_ns = stamp_of(msg.header)
        if stamp_ns <= self.stamp_ns and self._later() is not None:
            return False
        with out_of_range():
            cells, spec = grid_from_message(msg)
        self._next_whole = self._reached(cells, spec, stamp_ns)
        if self._next_whole is not None:
            return False
        self.map = ReceivedMap(cells, spec)
        self.stamp_ns, self._is_outdated = stamp_ns, False
        return True

    def _reached(self, cells: Cells, spec: GridSpec, stamp_ns: int) -> "_Whole | None":
        """Return a whole map with the part that the next updates change to reach it.

        None: they do not lead to it.
        """
        if self.map is None or spec != self.map.spec:
            return None
        window = NO_CELLS
        for each in self._later() or ():
            if each.is_empty:
                return None
            try:
                changed = window_from_message(each.message, spec)[1]
            except InvalidValueError:
                return None
            window = window.union(changed)
            if each.stamp_ns == stamp_ns:
                part = MapPart(cells[window.slices], window, cells)
                return _Whole(part, stamp_ns)
        return None

    def receive_update(
        self, msg: OccupancyGridUpdate, number: int | None, map_frame: str
    ) -> None:
        """Store an update for :meth:`next_part`.

        Args:
            msg: the update.
            number: its place in the sequence of its publisher; None: not known.
            map_frame: frame in which the map is expected.

        Raises:
            InvalidInputError: another frame.
        """
        check_frame("map update", msg.header.frame_id, map_frame)
        update = _Update(number, stamp_of(msg.header), msg)
        if self._updates and not update.follows(self._updates[-1]):
            self._updates.clear()
            self._is_outdated = True
        self._updates.append(update)

    def next_part(self) -> MapPart | None:
        """Return the next part of the map that changed; None if there is none.

        Raises:
            InvalidInputError: invalid values; the map is behind.
        """
        whole, self._next_whole = self._next_whole, None
        if whole is not None:
            self.stamp_ns = whole.stamp_ns
            return whole.part
        later = self._later()
        if self.map is None or not later or later[0].is_empty:
            return None
        try:
            part = MapPart(*window_from_message(later[0].message, self.map.spec))
        except InvalidValueError as error:
            self._is_outdated = True
            raise InvalidInputError("out_of_range", str(error)) from None
        self.stamp_ns = later[0].stamp_ns
        return part

    def _later(self) -> list[_Update] | None:
        """Return the updates after that of the map; None if that one is not known."""
        if self.map is None or self._is_outdated:
            return None
        for k, each in enumerate(self._updates):
            if each.stamp_ns == self.stamp_ns:
                return [*islice(self._updates, k + 1, None)]
        return None


@contextmanager
def out_of_range() -> Iterator[None]:
    """Convert the error of an invalid value to that of a message to drop."""
    try:
        yield
    except InvalidValueError as error:
        raise InvalidInputError("out_of_range", str(error)) from None
