"""The cells of a map, from its image."""

import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from navette.errors import FileFormatError
from navette.geometry import Pose2
from navette.geometry.map_files.description import MapDescription, read_description

if TYPE_CHECKING:
    from PIL.Image import Image

# The largest map of the map memory: 500 m wide at 5 cm.
MAX_PIXELS = 10_000**2
_UNKNOWN, _FREE, _OCCUPIED = -1, 0, 100
_FORMATS = ("PPM", "PNG", "BMP")  # Pillow's names; PPM includes PGM and PBM


@dataclass(frozen=True, eq=False)
class OccupancyMap:
    """Cells (H, W), row 0 at the bottom: −1 unknown, 0 free … 100 occupied.

    ``origin`` is the pose of the outer corner of cell (0, 0), ``resolution`` the edge
    of a cell in metres.
    """

    cells: NDArray[np.int8]
    resolution: float
    origin: Pose2


def read_occupancy_map(path: Path) -> OccupancyMap:
    """Read a map.

    Raises:
        FileFormatError: the YAML file or its image is invalid, missing or too large.
    """
    described = read_description(path)
    return OccupancyMap(read_cells(described), described.resolution, described.origin)


def read_cells(described: MapDescription) -> NDArray[np.int8]:
    """Return the cells (H, W) of a map, row 0 at the bottom.

    A pixel p of 0 … 1, the mean of its colours, has the occupancy 1 − p, with
    ``negate`` p. ``trinary``: from ``occupied_thresh`` on occupied, up to
    ``free_thresh`` free, unknown in between. ``scale``: in between 0 … 100. ``raw``:
    255 p is the cell; above 100 unknown. Transparent pixels are unknown, except in
    ``raw`` mode.

    Raises:
        FileFormatError: the image is invalid, missing or too large.
    """
    grey, white, alpha = _pixels(described)
    cells = _table(described, white)[grey]
    if alpha is not None and described.mode != "raw":
        cells[alpha < 255] = _UNKNOWN
    return np.ascontiguousarray(np.flipud(cells))


def _table(described: MapDescription, white: int) -> NDArray[np.int8]:
    """Return (white + 1,) the cell of each grey value 0 … ``white``."""
    shade = np.arange(white + 1) / white
    if described.mode == "raw":
        grey = np.rint(255 * shade)
        return np.where(grey > _OCCUPIED, _UNKNOWN, grey).astype(np.int8)
    share = shade if described.negate else 1.0 - shade
    free, occupied = described.free_threshold, described.occupied_threshold
    cells = np.full(white + 1, _UNKNOWN, np.int8)
    if described.mode == "scale":
        cells[:] = np.rint(np.clip((share - free) / (occupied - free), 0, 1) * 100)
    cells[share >= occupied] = _OCCUPIED
    cells[share <= free] = _FREE
    return cells


def _opened(path: Path) -> "Image":
    """Open an image.

    Raises:
        OSError: it cannot be read, or is of another format.
        ValueError: it has too many pixels.
    """
    from PIL import Image  # every start imports this module, and few read a map

    with warnings.catch_warnings():
        # Pillow warns of fewer pixels than are allowed here.
        warnings.simplefilter("ignore", Image.DecompressionBombWarning)
        try:
            return Image.open(path, formats=_FORMATS)
        except Image.DecompressionBombError as error:
            raise ValueError(str(error)) from None


def _pixels(
    described: MapDescription,
) -> tuple[NDArray[np.integer[Any]], int, NDArray[np.uint8] | None]:
    """Return grey values (H, W), that of white, and opacities (H, W), 0 … 255.

    The opacities are None if all pixels are opaque.
    """
    try:
        with _opened(described.image) as image:
            if image.width * image.height > MAX_PIXELS:
                raise FileFormatError(
                    described.path,
                    f"image of {image.width} x {image.height} pixels; "
                    f"at most {MAX_PIXELS}",
                )
            if image.mode.startswith("I"):  # Pillow's modes of 16-bit images
                return np.asarray(image).astype(np.uint16), 0xFFFF, None
            alpha = None
            if image.has_transparency_data:
                alpha = np.asarray(image.convert("RGBA"))[:, :, 3]
            if image.mode in ("1", "L", "LA"):
                return np.asarray(image.convert("L")), 0xFF, alpha
            colours = np.asarray(image.convert("RGB"))
            return colours.sum(axis=2, dtype=np.uint16), 3 * 0xFF, alpha
    except FileNotFoundError:
        raise FileFormatError(
            described.path,
            f"image {str(described.image)!r} cannot be read: no such file",
        ) from None
    except (OSError, ValueError, SyntaxError) as error:  # the last: a damaged PNG
        name = described.image.name
        raise FileFormatError(
            described.path,
            f"image {name!r} cannot be read as PGM, PNG or BMP: {error}",
        ) from None
