"""``navette bag``: info, list, check, recover, convert, filter, cut, merge."""

import json
import re
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from bag_samples import POINT, START_NS, STEP_NS, sample, write_sample
from navette.bags import BagMessage, BagTopic, BagWriter, open_bag
from navette.bags.writing import open_writer
from navette.cli.bag import bag
from navette.cli.bag.text import (
    count_text,
    duration_text,
    gap_text,
    rate_text,
    size_text,
    stamp_text,
)
from navette.errors import FileFormatError, InvalidValueError


def run(*words: object) -> Result:
    return CliRunner().invoke(bag, [str(word) for word in words])


def numbers(path: Path) -> list[int]:
    with open_bag(path) as reader:
        return [(m.stamp_ns - START_NS) // STEP_NS for m in reader.messages()]


@pytest.fixture
def sample_bag(tmp_path: Path) -> Path:
    return write_sample(tmp_path / "a.mcap", 20)


def test_info_has_the_layout_of_rosbag_info(sample_bag: Path) -> None:
    result = run("info", sample_bag)
    assert result.exit_code == 0
    head, table = result.stdout.split("\n\n")
    lines = dict(line.split(": ", 1) for line in head.splitlines())
    assert {name.strip(): value.strip() for name, value in lines.items()} | {
        "size": ""
    } == {
        "path": str(sample_bag),
        "format": "MCAP 0",
        "duration": "1.90 s",
        "start": "2023-11-14 22:13:20.000 UTC (1700000000.000)",
        "end": "2023-11-14 22:13:21.900 UTC (1700000001.900)",
        "size": "",
        "messages": "20",
        "compression": "zstd [1/1 chunks]",
    }
    assert [re.sub("  +", "|", line) for line in table.splitlines()] == [
        "topic|type|messages|rate|longest gap|qos",
        "/chatter|std_msgs/msg/String|10|5 Hz|200 ms|latched",
        "/point|geometry_msgs/msg/PointStamped|10|5 Hz|200 ms",
    ]
    assert len({line.index("5 Hz") for line in table.splitlines()[1:]}) == 1


def test_the_list_of_another_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.txt").touch()
    refused = run("list", tmp_path / "a.txt")
    assert isinstance(refused.exception, FileFormatError)
    assert "neither a folder nor a recording" in str(refused.exception)


@pytest.mark.parametrize(("verb", "rows"), [("info", 3), ("list", 2)])
def test_rows_on_a_terminal_are_coloured_and_fit(
    sample_bag: Path, monkeypatch: pytest.MonkeyPatch, verb: str, rows: int
) -> None:
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("COLUMNS", "40")
    table = run(verb, sample_bag).stdout.splitlines()[-rows:]
    assert all(line.startswith("\x1b[36m") for line in table[1:])
    plain = [re.sub(r"\x1b\[[0-9;]*m", "", line) for line in table]
    assert max(len(line) for line in plain) <= 40
    assert all("…" in line for line in plain[1:])
    assert not any("\\x1b" in line for line in plain)


def test_types_are_cut_before_figures(
    sample_bag: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("COLUMNS", "70")
    table = run("info", sample_bag).stdout.splitlines()[-2:]
    plain = [re.sub(r"\x1b\[[0-9;]*m", "", line) for line in table]
    assert [line.split()[2:5] for line in plain] == [["10", "5", "Hz"]] * 2
    assert ["…" in line.split()[1] for line in plain] == [False, True]


def test_the_rate_of_bursts_is_their_mean(tmp_path: Path) -> None:
    writer = open_writer(tmp_path / "a.mcap")
    data = sample(2)[1].data
    for second in range(0, 31, 10):
        for microsecond in range(11):
            stamp_ns = START_NS + second * 10**9 + microsecond * 1000
            writer.write(BagMessage(POINT, stamp_ns, data))
    writer.close()
    lines = run("info", tmp_path / "a.mcap").stdout.splitlines()[-1]
    assert re.split("  +", lines)[2:5] == ["44", "~1.43 Hz", "10 s"]


def test_one_figure_and_names_only(sample_bag: Path) -> None:
    assert run("info", sample_bag, "--key", "duration").stdout == "1.900000000\n"
    assert run("info", sample_bag, "-k", "messages").stdout == "20\n"
    assert run("info", sample_bag, "-t").stdout == "/chatter\n/point\n"
    assert "unknown key 'length'" in str(
        run("info", sample_bag, "-k", "length").exception
    )


def test_info_for_programs(sample_bag: Path, tmp_path: Path) -> None:
    other = write_sample(tmp_path / "b.bag", 4)
    lines = json.loads(run("info", sample_bag, other, "--json").stdout)
    assert [each["storage"] for each in lines] == ["mcap", "rosbag1"]
    assert lines[0]["topics"][0]["longest_gap_s"] == pytest.approx(0.2)
    assert lines[0]["topics"][0]["qos"][0]["durability"] == "transient_local"


def test_details(sample_bag: Path) -> None:
    printed = run("info", "-v", sample_bag).stdout
    assert (
        "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
        in printed
    )
    assert "/chatter  reliable, transient_local, keep_last 1" in printed


def test_list(sample_bag: Path, tmp_path: Path) -> None:
    (tmp_path / "broken.mcap").write_bytes(b"nothing")
    (tmp_path / "notes.txt").write_text("no bag", "utf-8")
    (tmp_path / "below").mkdir()
    write_sample(tmp_path / "below" / "c.db3", 3)
    lines = run("list", tmp_path).stdout.splitlines()
    assert [line.split()[0] for line in lines[1:]] == [
        str(sample_bag),
        str(tmp_path / "broken.mcap"),
    ]
    assert "the magic bytes are missing" in lines[2]
    lines = json.loads(run("list", "-r", "--json", tmp_path).stdout)
    assert [each["messages"] for each in lines] == [20, 3, 0]
    assert run("list", tmp_path / "below" / "..", "--json").exit_code == 0
    (tmp_path / "empty").mkdir()
    assert "no recordings in" in run("list", tmp_path / "empty").output


def test_check_and_recover(sample_bag: Path, tmp_path: Path) -> None:
    result = run("check", sample_bag)
    assert (result.exit_code, result.stdout) == (
        0,
        f"{sample_bag}: sound: 20 messages read\n",
    )
    sample_bag.write_bytes(sample_bag.read_bytes()[:-50])
    result = run("check", sample_bag)
    assert result.exit_code == 1
    assert "error   the summary cannot be read" in result.stdout
    assert "navette bag recover" in result.stdout
    lines = json.loads(run("check", "--json", sample_bag).stdout)
    assert (lines["sound"], lines["messages"]) == (False, 20)
    saved = tmp_path / "saved.mcap"
    result = run("recover", sample_bag, "-o", saved)
    assert result.exit_code == 0
    assert "damaged: the summary cannot be read" in result.output
    assert run("check", saved, "--decode").exit_code == 0
    assert numbers(saved) == list(range(20))


@pytest.mark.parametrize(
    "words",
    [
        "filter --start 100",
        "cut --start 1.5 --end 0.5",
        "cut --start 100 --duration 2",
        "cut --end -5",
        "cut --start 0.5 --duration -1",
    ],
)
def test_a_time_without_messages_is_refused(
    sample_bag: Path, tmp_path: Path, words: str
) -> None:
    verb, *options = words.split()
    refused = run(verb, sample_bag, *options, "-o", tmp_path / "b.mcap")
    assert isinstance(refused.exception, InvalidValueError)
    reason = (
        "more than 0 seconds" if options[-1] == "-1" else "which is from 0 to 1.900 s"
    )
    assert f"{options[-2]} {options[-1]}: " in str(refused.exception)
    assert reason in str(refused.exception)
    assert not (tmp_path / "b.mcap").exists()


def test_convert_filter_cut_merge(sample_bag: Path, tmp_path: Path) -> None:
    def made(*words: object) -> list[int]:
        result = run(*words, "-o", tmp_path / "b.mcap", "--overwrite")
        assert result.exit_code == 0, result.output
        return numbers(tmp_path / "b.mcap")

    assert made("convert", sample_bag, "--compression", "lz4") == list(range(20))
    assert made("filter", sample_bag, "-t", "/point") == list(range(1, 20, 2))
    assert made("filter", sample_bag, "-e", "cha", "--end", "0.5") == [0, 2, 4]
    assert made("filter", sample_bag, "--where", "m.point.x > 17", "-x", "cha") == [19]
    assert made("cut", sample_bag, "--start", "1.5") == [15, 16, 17, 18, 19]
    assert made("cut", sample_bag, "--start", "-0.2") == [17, 18, 19]
    absolute = f"{START_NS / 1e9 + 1.85:.2f}"
    assert made("cut", sample_bag, "--start", absolute) == [19]
    assert made("cut", sample_bag, "--start", "0.5", "-u", "0.2") == [5, 6, 7]
    other = write_sample(tmp_path / "c.bag", 3)
    assert made("merge", sample_bag, other) == sorted([*range(20), *range(3)])
    result = run("convert", sample_bag, "-o", tmp_path / "run", "-s", "sqlite3")
    assert result.exit_code == 0
    assert (tmp_path / "run" / "metadata.yaml").is_file()


def test_wrong_uses(sample_bag: Path) -> None:
    assert "is the input" in run("convert", sample_bag, "-o", sample_bag).output
    result = run("cut", sample_bag, "--start", "soon", "-o", "b.mcap")
    assert result.exit_code == 2
    assert "not a time in seconds" in result.output
    result = run("cut", sample_bag, "--end", "1", "-u", "1", "-o", "b.mcap")
    assert result.exit_code == 2


def test_figures_in_words() -> None:
    assert [size_text(n) for n in (999, 1000, 3_708_268, 10**13)] == [
        "999 B",
        "1.0 kB",
        "3.7 MB",
        "10.0 TB",
    ]
    assert duration_text(740.553) == "12:20 (740.55 s)"
    assert duration_text(3723.4) == "1:02:03 (3723.40 s)"
    assert stamp_text(13_960_000_000) == "13.960 s"
    rounded = "2024-05-03 12:59:24.112 UTC (1714741164.112)"
    assert stamp_text(1_714_741_164_111_822_142) == rounded
    assert stamp_text(10**30) == "1000000000000000000000.000"
    assert gap_text(None) == rate_text(None) == ""
    assert (gap_text(0.0333333), gap_text(2.04), gap_text(1234.6)) == (
        "33.3 ms",
        "2.04 s",
        "1235 s",
    )
    assert (rate_text(0.01), rate_text(104.2)) == ("every 100 s", "104 Hz")
    assert count_text(26566, grouped=True) == "26\u202f566"
    assert count_text(26566) == "26566"


ESCAPES = "/\x1b]0;owned\x07\x1b[2J\x1b[31m\u202ered\x9b31m\r\n"


@pytest.mark.parametrize("terminal", [False, True])
@pytest.mark.parametrize(
    "words", [["info"], ["info", "-v"], ["info", "-t"], ["info", "-k", "topics"]]
)
def test_recorded_names_cannot_act_on_the_terminal(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    words: list[str],
    terminal: bool,
) -> None:
    if terminal:
        monkeypatch.setattr("navette.cli.output.is_terminal", lambda: True)
    writer = open_writer(tmp_path / "a.mcap")
    writer.write(BagMessage(BagTopic(ESCAPES, ESCAPES, encoding="json"), 1, b"{}"))
    writer.close()
    shown = run(*words, tmp_path / "a.mcap").stdout
    assert "\\x1b]0;owned" in shown
    assert not set(shown) & set("\x1b\x07\x9b\u202e\r")


def test_what_a_format_cannot_hold_is_listed(tmp_path: Path) -> None:
    writer = open_writer(tmp_path / "a.mcap")
    for stamp in (1, 2):
        writer.write(BagMessage(BagTopic("/a", "A", encoding="json"), stamp, b"{}"))
    writer.write(sample(1)[0])
    writer.close()
    result = run("convert", tmp_path / "a.mcap", "-o", tmp_path / "a.bag")
    assert result.exit_code == 0
    assert (
        "not kept: 2 messages: json messages are not ROS messages (/a)" in result.stderr
    )
    assert "1 message," in result.stderr


def test_an_unfinished_recording_names_the_way_to_recover_it(tmp_path: Path) -> None:
    writer = BagWriter(tmp_path / "a.mcap")
    writer.flush()
    assert "being recorded" in run("info", tmp_path / "a.mcap").stdout
    writer.abandon()
    data = (tmp_path / "a.mcap").read_bytes()
    (tmp_path / "b.mcap").write_bytes(data[:-20])
    assert (
        f"navette bag recover {tmp_path}/b.mcap"
        in run("info", tmp_path / "b.mcap").stdout
    )
