"""Writing of maps: a YAML file and its image."""

import os
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.geometry.map_files.description import MAP_MODES
from navette.geometry.map_files.reader import OccupancyMap

IMAGE_FORMATS = {"pgm": "PPM", "png": "PNG", "bmp": "BMP"}
"""Formats of the image, and their names in Pillow."""

# Pixels and thresholds of map_server's trinary maps.
_BLACK, _WHITE, _GREY = 0, 254, 205
_TRINARY = {"occupied_thresh": 0.65, "free_thresh": 0.196}


def write_occupancy_map(
    stem: Path,
    occupancy: OccupancyMap,
    *,
    mode: str = "trinary",
    image_format: str = "",
    free_threshold: float = 0.25,
    occupied_threshold: float = 0.65,
) -> Path:
    """Write ``STEM.yaml`` and its image; return the path of the YAML file.

    Args:
        stem: path without suffix in an existing folder; files there are replaced.
        occupancy: the map.
        mode: trinary, scale or raw, as :func:`read_cells` reads them.
        image_format: pgm, png or bmp; default: pgm, and png for ``scale``, whose
            unknown cells are transparent.
        free_threshold: occupancy (0 … 1) up to which ``trinary`` writes free.
        occupied_threshold: occupancy from which ``trinary`` writes occupied.

    Raises:
        InvalidValueError: an option is invalid; nothing is written.
        OSError: a file cannot be written.
    """
    from PIL import Image  # as in reader.py

    image_format = image_format or ("png" if mode == "scale" else "pgm")
    _check(mode, image_format, free_threshold, occupied_threshold)
    pixels = _PIXELS[mode](np.flipud(occupancy.cells), free_threshold,
                           occupied_threshold)  # fmt: skip
    image, description = _with_suffix(stem, image_format), _with_suffix(stem, "yaml")
    thresholds = {"occupied_thresh": 1.0, "free_thresh": 0.0}  # scale: all in between
    text = {
        "image": image.name,
        "mode": mode,
        "resolution": float(occupancy.resolution),
        "origin": [float(value) for value in occupancy.origin],
        "negate": 0,
        **(_TRINARY if mode == "trinary" else thresholds),
    }
    with _Replacing(image) as part:
        Image.fromarray(pixels).save(part, format=IMAGE_FORMATS[image_format])
    with _Replacing(description) as part:
        part.write_text(yaml.safe_dump(text, sort_keys=False), encoding="utf-8")
    return description


def _check(mode: str, image_format: str, free: float, occupied: float) -> None:
    if mode not in MAP_MODES:
        raise InvalidValueError(f"mode {mode!r}; known: {', '.join(MAP_MODES)}")
    if image_format not in IMAGE_FORMATS:
        known = ", ".join(IMAGE_FORMATS)
        raise InvalidValueError(f"image format {image_format!r}; known: {known}")
    if mode == "scale" and image_format != "png":
        raise InvalidValueError(
            f"image format {image_format!r} has no transparency, which mode 'scale' "
            "needs for unknown cells; use png"
        )
    if not 0 <= free < occupied <= 1:
        raise InvalidValueError(
            f"free_thresh {free:g} and occupied_thresh {occupied:g}; expected "
            "0 <= free_thresh < occupied_thresh <= 1"
        )


def _trinary(cells: NDArray[np.int8], free: float, occupied: float) -> NDArray[Any]:
    pixels = np.full(cells.shape, _GREY, np.uint8)
    pixels[(cells >= 0) & (cells <= round(100 * free))] = _WHITE
    pixels[cells >= round(100 * occupied)] = _BLACK
    return pixels


def _scaled(cells: NDArray[np.int8], free: float, occupied: float) -> NDArray[Any]:
    grey = np.rint(255 * (100 - np.clip(cells, 0, 100).astype(float)) / 100)
    alpha = np.where(cells < 0, 0, 255)
    return np.stack([grey, alpha], axis=-1).astype(np.uint8)


def _raw(cells: NDArray[np.int8], free: float, occupied: float) -> NDArray[Any]:
    return np.where(cells < 0, 255, cells).astype(np.uint8)


_PIXELS = {"trinary": _trinary, "scale": _scaled, "raw": _raw}


def _with_suffix(stem: Path, suffix: str) -> Path:
    return stem.with_name(f"{stem.name}.{suffix}")


class _Replacing:
    """A file beside the target that replaces it when it is complete."""

    def __init__(self, target: Path) -> None:
        self._target = target
        self._part = target.with_name(f".{target.name}.{os.getpid()}.part")

    def __enter__(self) -> Path:
        return self._part

    def __exit__(self, kind: object, *_: object) -> None:
        if kind is None:
            self._part.replace(self._target)
        else:
            self._part.unlink(missing_ok=True)
