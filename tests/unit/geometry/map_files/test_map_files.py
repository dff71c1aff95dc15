"""Reading and writing of map_server's maps."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import yaml
from PIL import Image

from navette.errors import FileFormatError, InvalidValueError
from navette.geometry import Pose2
from navette.geometry.map_files import (
    OccupancyMap,
    read_occupancy_map,
    write_occupancy_map,
)

ORIGIN = Pose2(-3.5, 2.25, 0.5)


def described(folder: Path, pixels: np.ndarray, **values: object) -> Path:
    Image.fromarray(pixels.astype(np.uint8)).save(folder / "map.png")
    text = {"image": "map.png", "resolution": 0.05, "origin": [1.0, 2.0, 0.0], **values}
    path = folder / "map.yaml"
    path.write_text(yaml.safe_dump(text))
    return path


def test_a_pgm_of_map_server(tmp_path: Path) -> None:
    (tmp_path / "hall.pgm").write_bytes(
        b"P5\n# CREATOR: map_saver\n3 2\n255\n" + bytes([0, 205, 254, 254, 0, 254])
    )
    (tmp_path / "hall.yaml").write_text(
        "image: hall.pgm\nmode: trinary\nresolution: 0.05\n"
        "origin: [-1.5, 2, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
    )
    found = read_occupancy_map(tmp_path / "hall.yaml")
    assert found.cells.tolist() == [[0, 100, 0], [100, -1, 0]]  # row 0: the bottom
    assert (found.resolution, found.origin) == (0.05, Pose2(-1.5, 2.0, 0.0))


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        ("reslution", "resolution"),
        ("free_threshold", "free_thresh"),
        ("occupied_treshold", "occupied_thresh"),
        ("negated", "negate"),
    ],
)
def test_a_misspelt_key_is_refused_with_the_nearest_known_one(
    tmp_path: Path, wrong: str, right: str
) -> None:
    path = described(tmp_path, np.zeros((1, 1)), **{wrong: 0.1})
    expected = f"unknown key '{wrong}'; did you mean '{right}'"
    with pytest.raises(FileFormatError, match=expected):
        read_occupancy_map(path)


@pytest.mark.parametrize("key", ["image", "resolution"])
def test_a_missing_key_is_named(tmp_path: Path, key: str) -> None:
    path = described(tmp_path, np.zeros((1, 1)))
    values = yaml.safe_load(path.read_text())
    del values[key]
    path.write_text(yaml.safe_dump(values))
    with pytest.raises(FileFormatError, match=f"'{key}' is missing"):
        read_occupancy_map(path)


def test_modes_thresholds_and_negation(tmp_path: Path) -> None:
    pixels = np.array([[0, 64, 128, 192, 255]])
    thresholds = {"occupied_thresh": 0.75, "free_thresh": 0.25}

    def cells(**values: object) -> list[int]:
        path = described(tmp_path, pixels, **thresholds, **values)
        return list(read_occupancy_map(path).cells[0].tolist())

    assert cells() == [100, -1, -1, 0, 0]
    assert cells(negate=1) == [0, -1, -1, 100, 100]
    assert cells(mode="scale") == [100, 100, 50, 0, 0]
    assert cells(mode="raw") == [0, 64, -1, -1, -1]


def test_a_map_of_200_m_is_read_as_it_was_written(tmp_path: Path) -> None:
    cells = np.zeros((4040, 4100), np.int8)
    cells[0], cells[:, 0] = 100, 100
    write_occupancy_map(tmp_path / "hall", OccupancyMap(cells, 0.05, ORIGIN))
    found = read_occupancy_map(tmp_path / "hall.yaml")
    np.testing.assert_array_equal(found.cells, cells)


@pytest.mark.parametrize(("height", "is_read"), [(9_999, True), (10_001, False)])
def test_the_number_of_pixels_is_bounded(
    height: int, is_read: bool, tmp_path: Path
) -> None:
    """The header alone is given, so that no memory is required."""
    path = described(tmp_path, np.zeros((1, 1)), image="large.pgm")
    (tmp_path / "large.pgm").write_bytes(b"P5 10000 %d 255\n" % height)
    expected = "truncated" if is_read else "at most 100000000"
    with pytest.raises(FileFormatError, match=expected):
        read_occupancy_map(path)


def test_transparent_pixels_are_unknown(tmp_path: Path) -> None:
    pixels = np.array([[[0, 255], [0, 0], [255, 255]]])
    path = described(tmp_path, pixels)
    assert read_occupancy_map(path).cells.tolist() == [[100, -1, 0]]


#: Grey values of an image, top row first, and its cells in three modes.
GREY = np.array([[0, 205, 254], [100, 128, 255]], np.uint8)
CELLS_OF_GREY = {
    "trinary": [[-1, -1, 0], [100, -1, 0]],
    "scale": [[91, 67, 0], [100, 0, 0]],
    "raw": [[100, -1, -1], [0, -1, -1]],
}


def wide_png(path: Path) -> None:
    Image.fromarray(GREY.astype(np.uint16) * 257).save(path)


def wide_pgm(path: Path) -> None:
    pixels = (GREY.astype(">u2") * 257).tobytes()
    path.write_bytes(b"P5\n# two bytes a pixel\n3 2\n65535\n" + pixels)


def text_pgm(path: Path) -> None:
    path.write_text(f"P2 # as text\n3 2\n255\n{' '.join(map(str, GREY.ravel()))}\n")


def commented_pgm(path: Path) -> None:
    path.write_bytes(b"P5 # map_saver\n# 0.050 m/pix\n3 2\n#\n255\n" + GREY.tobytes())


def colours_png(path: Path) -> None:
    Image.fromarray(np.dstack([GREY] * 3)).save(path)


def palette_png(path: Path) -> None:
    Image.fromarray(GREY).convert("P").save(path)


@pytest.mark.parametrize("mode", CELLS_OF_GREY)
@pytest.mark.parametrize(
    "write", [wide_png, wide_pgm, text_pgm, commented_pgm, colours_png, palette_png]
)
def test_kinds_of_images(
    tmp_path: Path, write: Callable[[Path], None], mode: str
) -> None:
    write(tmp_path / "map.png")
    path = tmp_path / "map.yaml"
    path.write_text(
        f"image: map.png\nmode: {mode}\nresolution: 0.05\norigin: [0, 0, 0]\n"
        "occupied_thresh: 0.65\nfree_thresh: 0.196\n"
    )
    assert read_occupancy_map(path).cells.tolist() == CELLS_OF_GREY[mode]


def test_the_mean_of_the_colours_counts(tmp_path: Path) -> None:
    """As in map_server: a zone painted in a pure colour is occupied."""
    pixels = np.array([[[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 255]]])
    path = described(tmp_path, pixels)
    assert read_occupancy_map(path).cells.tolist() == [[100, 100, 100, 0]]


@pytest.mark.parametrize("place", ["images/map.png", "../map.png", "absolute", "home"])
def test_the_image_lies_elsewhere(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, place: str
) -> None:
    folder = tmp_path / "maps"
    (folder / "images").mkdir(parents=True)
    monkeypatch.setenv("HOME", str(tmp_path))
    named = {"absolute": str(tmp_path / "map.png"), "home": "~/map.png"}
    image = named.get(place, place)
    target = folder / image if place in (image, "absolute") else tmp_path / "map.png"
    Image.fromarray(GREY).save(target)
    path = described(folder, GREY, image=image)
    assert read_occupancy_map(path).cells.tolist() == CELLS_OF_GREY["trinary"]


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ({"negate": "maybe"}, "'negate' is 'maybe'; expected 0 or 1"),
        ({"negate": 2}, "expected 0 or 1"),
        ({"image": "gone.png"}, r"gone\.png' cannot be read: no such file"),
        ({"origin": [1.0, 2.0]}, r"expected \[x, y, yaw\]"),
        ({"mode": "grey"}, "trinary, scale, raw"),
        ({"occupied_thresh": 0.1, "free_thresh": 0.2}, "free_thresh < occupied"),
    ],
)
def test_invalid_values_are_named(
    tmp_path: Path, values: dict[str, object], text: str
) -> None:
    path = described(tmp_path, GREY, **values)
    with pytest.raises(FileFormatError, match=text):
        read_occupancy_map(path)


@pytest.mark.parametrize("image_format", ["pgm", "png", "bmp"])
@pytest.mark.parametrize("mode", ["trinary", "scale", "raw"])
def test_what_is_written_is_read(tmp_path: Path, mode: str, image_format: str) -> None:
    if mode == "scale" and image_format != "png":
        return
    cells = np.arange(-1, 101, dtype=np.int8).reshape(6, 17)
    if mode == "trinary":
        cells = np.random.default_rng(0).choice([-1, 0, 100], (6, 17)).astype(np.int8)
    (tmp_path / "deep").mkdir()
    path = write_occupancy_map(
        tmp_path / "deep" / "v1.2",
        OccupancyMap(cells, 0.1, ORIGIN),
        mode=mode,
        image_format=image_format,
    )
    assert path == tmp_path / "deep" / "v1.2.yaml"
    found = read_occupancy_map(path)
    assert found.cells.tolist() == cells.tolist()
    assert (found.resolution, found.origin) == (0.1, ORIGIN)
    assert sorted(each.name for each in path.parent.iterdir()) == [
        f"v1.2.{image_format}",
        "v1.2.yaml",
    ]


def test_trinary_thresholds_decide_what_is_written(tmp_path: Path) -> None:
    cells = np.array([[0, 25, 26, 64, 65, 100, -1]], np.int8)
    occupancy = OccupancyMap(cells, 0.1, ORIGIN)
    found = read_occupancy_map(write_occupancy_map(tmp_path / "m", occupancy))
    assert found.cells.tolist() == [[0, 0, -1, -1, 100, 100, -1]]


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ({"mode": "grey"}, "trinary, scale, raw"),
        ({"image_format": "gif"}, "pgm, png, bmp"),
        ({"mode": "scale", "image_format": "pgm"}, "use png"),
        ({"free_threshold": 0.7}, "free_thresh 0.7"),
        ({"occupied_threshold": 1.5}, "occupied_thresh 1.5"),
    ],
)
def test_invalid_options_write_nothing(
    tmp_path: Path, options: dict[str, object], text: str
) -> None:
    occupancy = OccupancyMap(np.zeros((2, 2), np.int8), 0.1, ORIGIN)
    with pytest.raises(InvalidValueError, match=text):
        write_occupancy_map(tmp_path / "m", occupancy, **options)  # type: ignore[arg-type]
    assert list(tmp_path.iterdir()) == []


def test_a_damaged_image_is_named(tmp_path: Path) -> None:
    path = described(tmp_path, np.zeros((20, 20)))
    image = tmp_path / "map.png"
    for damaged in (image.read_bytes()[:40], b"no image", b""):
        image.write_bytes(damaged)
        with pytest.raises(FileFormatError, match=r"map\.png"):
            read_occupancy_map(path)
    image.unlink()
    with pytest.raises(FileFormatError, match=r"map\.png"):
        read_occupancy_map(path)
