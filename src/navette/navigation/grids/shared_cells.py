"""Cells that several readers use until one of them changes its own."""

from navette.navigation.grids.sparse import copied
from navette.navigation.grids.spec import Cells


class SharedCells:
    """Cells of a grid, copied before they change if others may use the array.

    Attributes:
        cells: (H, W) the present array; write to :meth:`writable` only.
    """

    def __init__(self, cells: Cells, *, is_own: bool = False) -> None:
        """Args: cells; whether nothing else uses the array."""
        self.replace(cells, is_own=is_own)

    def replace(self, cells: Cells, *, is_own: bool = False) -> None:
        """Use another array, as from the start."""
        self.cells, self._is_own = cells, is_own

    def share(self) -> None:
        """Leave the array to others that still use it."""
        self._is_own = False

    def writable(self) -> Cells:
        """Return the array to change, a copy if others may use the present one."""
        if not self._is_own:
            self.replace(copied(self.cells), is_own=True)
        return self.cells
