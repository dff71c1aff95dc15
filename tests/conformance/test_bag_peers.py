"""Other tools read Navette's bags and count the same messages."""

import json
import re
import shutil
import subprocess
from collections import Counter
from pathlib import Path

import pytest
from check_bags import differences
from mcap.reader import make_reader
from rosbags.highlevel import AnyReader

from bag_samples import sample, write_sample
from navette.bags import open_bag
from navette.bags.editing import copy
from navette.bags.writing import open_writer
from navette.navigation.stack import RunOptions
from navette.navigation.stack.simulation import Simulation

pytestmark = pytest.mark.long


@pytest.fixture(scope="module")
def drive(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Record every topic of the whole stack for two seconds."""
    path = tmp_path_factory.mktemp("drive") / "drive.mcap"
    simulation = Simulation(
        RunOptions(headless=True, goals=((3.0, 0.0),), record=path, max_time_s=2.0)
    )
    simulation.run()
    simulation.close()
    return path


def counts_of(path: Path) -> Counter[str]:
    with open_bag(path) as reader:
        return Counter(message.topic.name for message in reader.messages())


@pytest.mark.slow
@pytest.mark.parametrize("suffix", ["mcap", "bag", "db3"])
def test_rosbags_reads_the_same_drive_in_every_format(
    drive: Path, tmp_path: Path, suffix: str
) -> None:
    path = tmp_path / f"drive.{suffix}"
    with open_bag(drive) as reader:
        copy(reader, open_writer(path))
    assert differences(path) == []
    assert counts_of(path) == counts_of(drive)


def test_a_folder_as_of_rosbag2(tmp_path: Path) -> None:
    writer = open_writer(tmp_path / "run", storage="sqlite3", compression="zstd")
    for message in sample(50):
        writer.write(message)
    writer.close()
    assert differences(tmp_path / "run") == []
    with AnyReader([tmp_path / "run"]) as reader:
        assert reader.message_count == 50


@pytest.mark.parametrize("compression", ["zstd", "lz4", "none"])
def test_mcap_counts_the_same(tmp_path: Path, compression: str) -> None:
    path = write_sample(tmp_path / "a.mcap", 50, compression=compression)
    with path.open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        found = Counter(channel.topic for _, channel, _ in reader.iter_messages())
    assert found == counts_of(path) == {"/chatter": 25, "/point": 25}


@pytest.mark.slow
def test_rosbag_info_counts_the_same(drive: Path, tmp_path: Path) -> None:
    """ROS 1's own tool, from Debian's package python3-rosbag."""
    rosbag = shutil.which("rosbag")
    if rosbag is None:
        pytest.skip(_why_not())
    path = tmp_path / "drive.bag"
    with open_bag(drive) as reader:
        copy(reader, open_writer(path, compression="lz4"))
    run = subprocess.run(
        [rosbag, "info", str(path)], capture_output=True, text=True, timeout=60
    )
    assert run.returncode == 0, run.stderr
    counts = dict(re.findall(r"(/\S+) +(\d+) msgs? ", run.stdout))
    assert {topic: int(n) for topic, n in counts.items()} == counts_of(drive)
    assert re.search(r"compression: +lz4", run.stdout)
    # ROS 1's own checksums: its programs accept the messages.
    for name, checksum in (
        ("sensor_msgs/LaserScan", "90c7ef2dc6895d81024acba2ac42f369"),
        ("nav_msgs/Odometry", "cd5e73d190d741a2f92e81eda573aca7"),
    ):
        assert re.search(rf"{name} +\[{checksum}\]", run.stdout)


def _why_not() -> str:
    """Skip only on machines without the Debian package."""
    cache = shutil.which("apt-cache")
    if cache is not None:
        run = subprocess.run(
            [cache, "show", "python3-rosbag"], capture_output=True, timeout=60
        )
        if run.returncode == 0:
            return "rosbag is not installed: apt-get install python3-rosbag"
    return "rosbag cannot be installed: there is no package (not permitted here)"


def test_info_as_json_describes_the_file(
    drive: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from click.testing import CliRunner

    from navette.cli.bag import bag

    result = CliRunner().invoke(bag, ["info", str(drive), "--json"])
    assert result.exit_code == 0, result.output
    counts = json.loads(result.stdout)
    assert {t["name"]: t["messages"] for t in counts["topics"]} == counts_of(drive)
