"""``navette bag play`` as a person has it: a terminal, keys, an end."""

import os
import pty
import re
import select
import signal
import subprocess
import sys
import termios
from collections.abc import Iterator
from pathlib import Path

import pytest
from click.testing import CliRunner

from navette.bags import BagWriter
from navette.cli.app import app
from navette.cli.arguments import fill_values
from navette.cli.keyboard import split_keys
from navette.errors import NavetteError
from navette.msgs import definition_text, serialize
from navette.msgs.std_msgs.msg import String
from navette.runtime import Stopwatch

S = 1_000_000_000
LONGEST_S = 30.0


def write_bag(path: Path, count: int = 601, period_s: float = 0.1) -> Path:
    writer = BagWriter(path)
    kind = "std_msgs/msg/String"
    channel = writer.add_channel("/chatter", kind, definition_text(kind))
    for i in range(count):
        data = serialize(String(data=f"{i}"))
        writer.write(channel, round((100 + i * period_s) * S), data)
    writer.close()
    return path


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    return write_bag(tmp_path / "talk.mcap")


def command(*words: object) -> list[str]:
    return [sys.executable, "-m", "navette", "bag", "play", *map(str, words)]


def environment() -> dict[str, str]:
    return {**os.environ, "NAVETTE_TRANSPORT": "inprocess", "TERM": "xterm"}


# The first terminal that a session's leader opens is the one that controls it.
_ON_TERMINAL = """
import os, sys
terminal = os.open(sys.argv[1], os.O_RDWR)
for descriptor in range(3):
    os.dup2(terminal, descriptor)
os.execv(sys.argv[2], sys.argv[2:])
"""


class Terminal:
    """A command on a terminal of its own, as a shell's foreground job."""

    def __init__(self, *words: object) -> None:
        self.descriptor, self._inner = pty.openpty()
        termios.tcsetwinsize(self._inner, (40, 140))
        self.before = self.settings
        self._unread = ""
        name = os.ttyname(self._inner)
        self.process = subprocess.Popen(
            [sys.executable, "-c", _ON_TERMINAL, name, *command(*words)],
            env=environment(),
            start_new_session=True,
        )

    def press(self, keys: bytes) -> None:
        os.write(self.descriptor, keys)

    def wait_for(self, pattern: str) -> re.Match[str]:
        """Read until it is shown, after what was found before."""
        watch = Stopwatch()
        while (found := re.search(pattern, self._unread)) is None:
            left_s = max(0.0, LONGEST_S - watch.elapsed_s)
            ready, _, _ = select.select([self.descriptor], [], [], left_s)
            assert ready, f"{pattern!r} was not shown: {self._unread[-300:]!r}"
            self._unread += os.read(self.descriptor, 65536).decode(errors="replace")
        self._unread = self._unread[found.end() :]
        return found

    def wait_for_end(self) -> int:
        return self.process.wait(LONGEST_S)

    @property
    def settings(self) -> object:
        return termios.tcgetattr(self._inner)

    def close(self) -> None:
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        os.close(self.descriptor)
        os.close(self._inner)


@pytest.fixture
def terminal(bag: Path) -> Iterator[Terminal]:
    shown = Terminal(bag, "--pause")
    yield shown
    shown.close()


@pytest.mark.slow
def test_keys_on_a_real_terminal(terminal: Terminal) -> None:
    terminal.wait_for("paused.* 0.0 / 60.0 s")
    assert terminal.settings != terminal.before  # keys come without Enter
    terminal.press(b"s")
    terminal.wait_for(r"m1 message\x1b")
    terminal.press(b"\x1b[C")
    terminal.wait_for(" 0.1 / 60.0 s.*2 messages")
    terminal.press(b"\x1b[A\x1b[A")
    terminal.wait_for("×1.21")
    terminal.press(b"\x1bOB")
    terminal.wait_for(r"×1\.1\b")
    terminal.press(b" ")
    terminal.wait_for("playing")
    terminal.wait_for(r" (0\.[3-9]|[1-9][\d.]*) / 60\.0 s")
    terminal.press(b" ")
    terminal.wait_for("paused")
    terminal.press(b"\x1b[D")
    terminal.wait_for(" 0.0 / 60.0 s")
    terminal.press(b"q")
    terminal.wait_for(r"played: .*messages, 0.0 s")
    assert terminal.wait_for_end() == 0
    assert terminal.settings == terminal.before


@pytest.mark.slow
@pytest.mark.parametrize("end", ["Ctrl-C", "SIGTERM"])
def test_the_terminal_is_put_back(terminal: Terminal, end: str) -> None:
    terminal.wait_for("paused.* 0.0 / 60.0 s")
    if end == "Ctrl-C":
        terminal.press(b"\x03")
    else:
        terminal.process.send_signal(signal.SIGTERM)
    terminal.wait_for("interrupted")
    assert terminal.wait_for_end() == 130
    assert terminal.settings == terminal.before


@pytest.mark.slow
def test_piped_it_is_plain(bag: Path) -> None:
    done = subprocess.run(
        command(bag, "-r", "1000", "-s", "1", "-u", "10"),
        env=environment(),
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=LONGEST_S,
        check=False,
    )
    assert (done.returncode, done.stdout) == (0, "")
    assert done.stderr.splitlines() == [
        "Playing  talk.mcap · 10.0 s · 1 topic",
        "played: 101 messages, 10.0 s",
    ]


@pytest.mark.parametrize(
    ("words", "printed"),
    [
        (["--topics", "/scan"], "unknown topic '/scan'; known: /chatter"),
        (["-r", "0"], "rate 0.0: expected"),
        (["-s", "99"], "start offset 99 s: the bag has only 60.000 s"),
    ],
)
def test_mistakes_are_named(bag: Path, words: list[str], printed: str) -> None:
    done = CliRunner().invoke(app, ["bag", "play", str(bag), *words])
    assert isinstance(done.exception, NavetteError)
    assert printed in str(done.exception)


def test_keys_are_distinguished() -> None:
    assert split_keys("s \x1b[A\x1bOBq") == ["s", " ", "up", "down", "q"]
    assert split_keys("\x1b[C\x1b[D\x1b") == ["right", "left", "escape"]
    assert split_keys("\x1b[1;5A\x1b[3~x") == ["up", "x"]
    assert split_keys("") == []
    assert split_keys("\x1b[") == ["escape", "["]


def test_the_clock_needs_no_number() -> None:
    assert fill_values(["--clock", "a.mcap"]) == ["--clock", "40", "a.mcap"]
    assert fill_values(["--clock", "100"]) == ["--clock", "100"]
    assert fill_values(["a", "--clock"]) == ["a", "--clock", "40"]


def test_the_sound_part_of_a_damaged_bag_is_played_and_the_exit_code_is_1(
    tmp_path: Path,
) -> None:
    path = tmp_path / "damaged.mcap"
    writer = BagWriter(path)
    kind = "std_msgs/msg/String"
    channel = writer.add_channel("/chatter", kind, definition_text(kind))
    for i in range(100):
        writer.write(channel, i * S // 1000, serialize(String(data=f"{i:040}")))
        if i % 10 == 9:
            writer.flush()
    writer.close()
    data = bytearray(path.read_bytes())
    frame = data.index(b"\x28\xb5\x2f\xfd", len(data) // 2)  # zstd's magic number
    data[frame + 8 : frame + 12] = b"\xff\xff\xff\xff"
    path.write_bytes(data)
    done = subprocess.run(
        command(path), env=environment(), capture_output=True, text=True, check=False
    )
    assert done.returncode == 1, done.stderr
    played = re.search(r"played: (\d+) messages", done.stderr)
    assert played is not None, done.stderr
    assert 50 < int(played[1]) < 100
    assert "not played: 1 damaged part" in done.stderr
    assert re.search(r"damaged.mcap: byte \d+: chunk: damaged zstd data", done.stderr)
