"""navette bag plot: numbers out of a recording, and a picture of them."""

import math
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from navette.bags import open_bag
from navette.bags.bag import BagMessage, BagTopic
from navette.bags.writing import open_writer
from navette.cli.app import app
from navette.cli.bag.drawing import draw
from navette.cli.bag.series import PlotField, read_series
from navette.errors import (
    FileFormatError,
    InvalidValueError,
    MessageError,
    MissingPartError,
    UnknownNameError,
)
from navette.geometry import quaternion_from_yaw
from navette.msgs import definition_text, serialize, type_hash
from navette.msgs.nav_msgs.msg import Odometry
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.runtime import ns_to_stamp

START_NS = 1_000_000_000_000
PNG = b"\x89PNG\r\n\x1a\n"


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    """Ten odometries, a second apart, and two scans of which one is empty."""
    path = tmp_path / "run.mcap"
    writer = open_writer(path)
    for tick in range(10):
        stamp_ns = START_NS + tick * 10**9
        odometry = Odometry()
        odometry.header.stamp = ns_to_stamp(stamp_ns + 500_000_000)
        odometry.pose.pose.position.x, odometry.pose.pose.position.y = tick, tick**2
        q = odometry.pose.pose.orientation
        q.x, q.y, q.z, q.w = quaternion_from_yaw(tick)
        writer.write(message("/odom", stamp_ns, odometry))
    for stamp_ns, ranges in ((START_NS, [2.5]), (START_NS + 10**9, [])):
        writer.write(message("/scan", stamp_ns, LaserScan(ranges=ranges)))
    writer.close()
    return path


def message(name: str, stamp_ns: int, msg: object) -> BagMessage:
    kind = type(msg)._type_name_
    topic = BagTopic(name, kind, definition_text(kind), type_hash(kind))
    return BagMessage(topic, stamp_ns, serialize(msg))


def numbers(bag: Path, *texts: str) -> list[tuple[list[float], list[float]]]:
    with open_bag(bag) as reader:
        series = read_series(reader, [PlotField.read(text) for text in texts])
    return [(list(each.x), list(each.y)) for each in series]


def test_a_field_over_time_since_the_start(bag: Path) -> None:
    ((x, y),) = numbers(bag, "/odom.pose.pose.position.y")
    assert x == [float(tick) for tick in range(10)]
    assert y == [tick**2 for tick in range(10)]


@pytest.mark.parametrize("second", ["y", "pose.pose.position.y"])
def test_a_field_over_another(bag: Path, second: str) -> None:
    ((x, y),) = numbers(bag, f"odom.pose.pose.position.x:{second}")
    assert x == [float(tick) for tick in range(10)]
    assert y == [tick**2 for tick in range(10)]


def test_stamps_become_seconds_quaternions_yaw_and_missing_elements_nan(
    bag: Path,
) -> None:
    stamps, yaws, ranges = numbers(
        bag, "/odom.header.stamp", "/odom.pose.pose.orientation", "/scan.ranges[0]"
    )
    assert stamps[1][:2] == [1000.5, 1001.5]
    assert yaws[1] == pytest.approx([float(tick) for tick in range(10)])
    assert ranges[1][0] == 2.5
    assert math.isnan(ranges[1][1])


@pytest.mark.parametrize(
    ("text", "error", "reason"),
    [
        ("/odom", InvalidValueError, "is not TOPIC.FIELD"),
        ("/odom.", InvalidValueError, "is not TOPIC.FIELD"),
        ("/odom.a:b:c", InvalidValueError, "is not TOPIC.FIELD"),
        ("/odom.pose:", InvalidValueError, "is not TOPIC.FIELD"),
        ("/oddom.pose", UnknownNameError, "'/oddom'; known: /odom, /scan"),
        ("/odom.pose.x", MessageError, "no such field"),
        ("/odom.pose.pose.position", MessageError, "is not a number"),
        ("/odom.child_frame_id", MessageError, "string is not a number"),
        ("/scan.ranges", MessageError, "is an array; add an index"),
    ],
)
def test_fields_that_are_not_numbers_are_errors(
    bag: Path, text: str, error: type, reason
) -> None:
    with pytest.raises(error, match=reason):
        numbers(bag, text)


def series_of(bag: Path, *texts: str):
    with open_bag(bag) as reader:
        return read_series(reader, [PlotField.read(text) for text in texts])


@pytest.mark.slow
def test_the_verb_draws_over_time_and_over_each_other(
    bag: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    fields = ["/odom.pose.pose.position.x", "/odom.pose.pose.orientation"]
    done = CliRunner().invoke(app, ["bag", "plot", str(bag), *fields])
    assert done.exit_code == 0, done.output
    assert done.output == "run.png: 2 lines, 20 points\n"
    first = (tmp_path / "run.png").read_bytes()
    assert first.startswith(PNG)
    CliRunner().invoke(app, ["bag", "plot", str(bag), *fields])
    assert (tmp_path / "run.png").read_bytes() == first
    way = "/odom.pose.pose.position.x:y"
    done = CliRunner().invoke(app, ["bag", "plot", str(bag), way, "-o", "way.svg"])
    assert done.output == "way.svg: 1 line, 10 points\n"
    assert "<svg" in (tmp_path / "way.svg").read_text(encoding="utf-8")


def test_what_cannot_be_drawn_is_an_error(bag: Path, tmp_path: Path) -> None:
    x, way = "/odom.pose.pose.position.x", "/odom.pose.pose.position.x:y"
    with pytest.raises(InvalidValueError, match=r"the suffix is not .png"):
        draw(series_of(bag, x), "run", tmp_path / "run.mcap")
    with pytest.raises(InvalidValueError, match="cannot be in one"):
        draw(series_of(bag, x, way), "run", tmp_path / "run.png")
    with pytest.raises(FileFormatError, match="cannot be written"):
        draw(series_of(bag, x), "run", tmp_path / "nowhere" / "run.png")


def test_without_matplotlib_the_error_names_the_package(
    bag: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    lines = series_of(bag, "/odom.pose.pose.position.x")
    with pytest.raises(MissingPartError, match="pip install matplotlib"):
        draw(lines, "run", tmp_path / "run.png")


def test_help_names_the_package() -> None:
    shown = CliRunner().invoke(app, ["bag", "plot", "--help"]).output
    assert "pip install matplotlib" in shown
