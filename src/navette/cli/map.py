"""``navette map``: save the running robot's map, show and convert map files."""

import shutil
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from navette.cli.commands import Group
from navette.cli.map_stem import map_stem
from navette.cli.options import Argument, Json, Option
from navette.cli.output import show, show_json
from navette.cli.service_calls import ServiceRequest, call_all
from navette.cli.session import connect, fail, service_endpoints
from navette.errors import FileFormatError
from navette.files.writing import writing

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from navette.geometry.map_files import OccupancyMap
    from navette.runtime import Node

_SAVE = "nav2_msgs/srv/SaveMap"
_SLAM_SAVER = "slam/save_map"
_SAVE_S = 10.0  # a large map of another topic
_LEAST_OCCUPIED = 65  # as map_server's occupied_thresh
_UNKNOWN, _FREE, _OCCUPIED = -1, 0, 1

map_ = Group(
    name="map",
    help="Save, show and convert maps.",
)

MapFile = Annotated[Path, Argument(metavar="FILE.yaml", help="A map file.")]
Mode = Annotated[
    str,
    Option(
        metavar="MODE",
        help="trinary: occupied, free, unknown. scale: also shares between, as a PNG."
        " raw: values as they are.",
    ),
]
Image = Annotated[
    str | None,
    Option("--image", metavar="pgm|png|bmp", help="Format. Default: pgm; scale: png."),
]


@map_.command()
def save(
    file: Annotated[
        Path, Argument(metavar="FILE", help="Name without suffix, such as office.")
    ],
    topic: Annotated[
        str, Option(metavar="TOPIC", help="The map's topic, if it is not /map.")
    ] = "",
    mode: Mode = "trinary",
    image: Image = None,
) -> None:
    """Save the map of the running robot as FILE.yaml and an image.

    The node that keeps the map writes the files, on its machine. With SLAM that is
    its map, and FILE.slam to continue it.
    """
    stem = map_stem(file)
    with connect() as node:
        service = _saver(node, topic)
        if service is None:
            fail(
                "no node has the service map_saver/save_map: is a robot with "
                "map_memory running? See navette node list"
            )
        fields = {
            "map_topic": topic,
            "map_url": str(stem.absolute()),
            "map_mode": mode,
            "image_format": image or "",
        }
        (answer,) = call_all(node, [ServiceRequest(service, _SAVE, fields)], _SAVE_S)
    if answer.response is None:
        fail(answer.reason)
    if not answer.response.result:
        fail(f"the map was not saved: the log of {service} has the reason")
    graph = f" and {stem}.slam" if service.endswith(_SLAM_SAVER) else ""
    show(f"saved {stem}.yaml{graph}")


@map_.command("show")
def show_(file: MapFile, as_json: Json = False) -> None:
    """Print size, place and content of a map file, and draw it."""
    from navette.geometry.map_files import read_description, read_occupancy_map

    occupancy, described = read_occupancy_map(file), read_description(file)
    values = {
        "file": str(file),
        "image": str(described.image),
        "mode": described.mode,
        **_values(occupancy),
    }
    if as_json:
        show_json(values)
        return
    height, width = occupancy.cells.shape
    edge = occupancy.resolution
    x, y, yaw = occupancy.origin
    show(
        f"{file}: {width} x {height} cells of {edge:g} m, {width * edge:g} x "
        f"{height * edge:g} m, corner at ({x:g}, {y:g}), {yaw:g} rad, {described.mode}"
    )
    parts = ("occupied", "free", "unknown")
    show(", ".join(f"{part} {values[part]:.1%}" for part in parts))
    show("\n".join(drawing(occupancy.cells, shutil.get_terminal_size().columns)))


@map_.command()
def convert(
    file: MapFile,
    to: Annotated[
        Path, Argument(metavar="OUT", help="Name without suffix, such as office.")
    ],
    mode: Mode = "trinary",
    image: Image = None,
    overwrite: Annotated[
        bool, Option("--overwrite", help="Replace existing files.")
    ] = False,
) -> None:
    """Write a map file in another mode or image format."""
    from navette.geometry.map_files import read_occupancy_map, write_occupancy_map

    stem = map_stem(to)
    target = stem.with_name(f"{stem.name}.yaml")
    if target.exists() and not overwrite:
        raise FileFormatError(target, "exists already; --overwrite replaces it")
    occupancy = read_occupancy_map(file)
    with writing(target):
        written = write_occupancy_map(
            stem, occupancy, mode=mode, image_format=image or ""
        )
    show(f"wrote {written}")


def drawing(cells: "NDArray[np.int8]", columns: int) -> list[str]:
    """Draw the known part of cells (H, W) in lines of at most ``columns`` characters.

    A character stands for a square of cells above another one: ``█▀▄`` are occupied,
    ``░`` is unknown, a space free.
    """
    import numpy as np

    known = _known_part(cells)
    small = _reduced(known, -(-known.shape[1] // max(1, columns)))
    if len(small) % 2:
        small = np.vstack([small, np.full((1, small.shape[1]), _UNKNOWN, np.int8)])
    upper, lower = small[::-1][0::2], small[::-1][1::2]
    return [
        "".join(_character(*pair) for pair in zip(above, below, strict=True)).rstrip()
        for above, below in zip(upper.tolist(), lower.tolist(), strict=True)
    ]


def _known_part(cells: "NDArray[np.int8]") -> "NDArray[np.int8]":
    import numpy as np

    rows, columns = np.nonzero(cells >= 0)
    if not len(rows):
        return cells
    return cells[rows.min() : rows.max() + 1, columns.min() : columns.max() + 1]


def _character(above: int, below: int) -> str:
    if _OCCUPIED in (above, below):
        return "█" if above == below else "▀" if above == _OCCUPIED else "▄"
    return "░" if above == below == _UNKNOWN else " "


def _reduced(cells: "NDArray[np.int8]", side: int) -> "NDArray[np.int8]":
    """Return the state of each square of ``side`` cells; the last ones are padded."""
    import numpy as np

    height, width = cells.shape
    padding = ((0, -height % side), (0, -width % side))
    whole = np.pad(cells, padding, constant_values=_UNKNOWN)
    squares = whole.reshape(whole.shape[0] // side, side, -1, side)
    most = squares.max(axis=(1, 3))
    state = np.where(most < 0, _UNKNOWN, _FREE)
    state[most >= _LEAST_OCCUPIED] = _OCCUPIED
    reduced: NDArray[np.int8] = state.astype(np.int8)
    return reduced


def _values(occupancy: "OccupancyMap") -> dict[str, Any]:
    cells = occupancy.cells
    height, width = cells.shape
    occupied = float((cells >= _LEAST_OCCUPIED).mean())
    unknown = float((cells < 0).mean())
    return {
        "width": width,
        "height": height,
        "resolution_m": occupancy.resolution,
        "origin": list(occupancy.origin),
        "occupied": occupied,
        "free": 1.0 - occupied - unknown,
        "unknown": unknown,
    }


def _saver(node: "Node", topic: str) -> str | None:
    """Return the full name of the service that saves the map of a topic.

    Without a topic that of a SLAM comes first: the map of map_memory is made from it.
    """
    from navette.transports import EndpointKind

    found = sorted(
        each.topic
        for each in service_endpoints(node, kind=EndpointKind.SERVICE)
        if each.type_name == _SAVE
    )
    of_slam = [each for each in found if each.endswith(_SLAM_SAVER)]
    others = [each for each in found if each not in of_slam]
    order = others if topic else [*of_slam, *others]
    return order[0] if order else None
