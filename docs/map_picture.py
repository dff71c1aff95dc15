"""Draw the picture of tutorial 5: ``python docs/map_picture.py FOLDER``.

FOLDER has the files of the tutorial: the map and the trajectory of SLAM.
"""

import sys
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from navette.geometry.map_files import read_occupancy_map

PICTURE = Path(__file__).parent / "images" / "map.png"
SCALE, MARGIN = 2, 12
# The live view's colours.
UNKNOWN, FREE, WALL, LINE = (
    (228, 224, 216),
    (255, 253, 249),
    (28, 32, 37),
    (191, 62, 10),
)


def main() -> None:
    folder = Path(sys.argv[1])
    known = read_occupancy_map(folder / "office.yaml")
    cells = np.pad(np.flipud(known.cells), MARGIN, constant_values=-1)
    pixels = np.full((*cells.shape, 3), UNKNOWN, np.uint8)
    pixels[cells == 0], pixels[cells == 100] = FREE, WALL
    image = Image.fromarray(pixels).resize(
        (cells.shape[1] * SCALE, cells.shape[0] * SCALE), Image.Resampling.NEAREST
    )
    path = np.loadtxt(folder / "office.tum")[:, 1:3]
    columns = (path[:, 0] - known.origin.x) / known.resolution + MARGIN
    rows = cells.shape[0] - MARGIN - (path[:, 1] - known.origin.y) / known.resolution
    points = [tuple(each) for each in SCALE * np.column_stack([columns, rows])]
    drawing = ImageDraw.Draw(image)
    drawing.line(points, fill=LINE, width=3, joint="curve")
    for (x, y), radius in ((points[0], 5), (points[-1], 8)):
        drawing.ellipse((x - radius, y - radius, x + radius, y + radius), fill=LINE)
    image.convert("P", palette=Image.Palette.ADAPTIVE).save(PICTURE, optimize=True)
    sys.stdout.write(f"{PICTURE}\n")


if __name__ == "__main__":
    main()
