"""Verbs that overwrite what they printed, on a real terminal."""

import os
import pty
import re
import signal
import termios
from contextlib import suppress
from functools import partial
from pathlib import Path

import pytest

from navette.cli.app import app
from navette.cli.session import connect
from navette.msgs.std_msgs.msg import String
from navette.runtime import (
    DurabilityPolicy,
    Node,
    QoSProfile,
)

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
HOSTILE = "\x1b[2J\x1b[5F\x9b1A\x1b]0;title\x07"


@pytest.fixture(autouse=True)
def joined(talker: Node, monkeypatch: pytest.MonkeyPatch) -> None:
    """The verbs join the talker's context."""
    for module in ("session", "topic.verbs"):
        join = partial(connect, talker.context)
        monkeypatch.setattr(f"navette.cli.{module}.connect", join)


def shown(*words: str) -> str:
    """Return what a verb writes to a terminal of 24 rows and 80 columns."""
    here, there = pty.openpty()
    termios.tcsetwinsize(there, (24, 80))
    with (
        Path(os.ttyname(there)).open("w", encoding="utf-8") as out,
        pytest.MonkeyPatch.context() as patch,
    ):
        for name in ("NO_COLOR", "COLUMNS", "LINES"):
            patch.delenv(name, raising=False)
        patch.setattr("sys.stdout", out)
        patch.setattr("sys.__stdout__", out)  # its size is the terminal's
        with suppress(SystemExit):  # of Ctrl-C
            app(list(words), standalone_mode=False)
    os.close(there)
    data = b""
    with suppress(OSError):  # EIO: the other end is closed
        while part := os.read(here, 65536):
            data += part
    os.close(here)
    return data.decode()


@pytest.mark.parametrize(
    ("words", "codes"),
    [
        (("tree",), ("\x1b[2J\x1b[H", "\x1b[K", "\x1b[J")),
        (("topic", "hz", "a", "b", "--count", "2"), ("\x1b[5F", "\x1b[K", "\x1b[J")),
        (("topic", "hz", "--all", "--count", "2"), ("\x1b[6F", "\x1b[K", "\x1b[J")),
        (("topic", "bw", "a", "b", "--count", "2"), ("\x1b[5F", "\x1b[K", "\x1b[J")),
        (
            ("topic", "echo", "a", "--clear", "--count", "2"),
            ("\x1b[2J\x1b[H", "\x1b[K", "\x1b[J"),
        ),
    ],
    ids=lambda value: "-".join(value[:3]) if value[0].isalpha() else "",
)
def test_own_codes_act_and_received_ones_do_not(
    talker: Node, words: tuple[str, ...], codes: tuple[str, ...]
) -> None:
    publishers = [talker.create_publisher(String, name, 10) for name in ("a", "b")]
    tree = talker.create_publisher(String, "/behavior_tree", LATCHED)

    def publish() -> None:
        tree.publish(String(data=f"{{o}} {HOSTILE} [*]"))
        for publisher in publishers:
            publisher.publish(String(data=HOSTILE))

    talker.create_timer(0.2, publish)
    if words[0] == "tree":  # runs until Ctrl-C
        talker.create_timer(0.5, lambda: signal.raise_signal(signal.SIGINT))
    text = shown(*words)
    for code in codes:
        assert code in text, text
    for received in ("\x1b[5F\x9b", "\x9b", "\x1b]", "\x07"):
        assert received not in text, text
    if words[0] == "tree":
        assert "{o} \\x1b[2J\\x1b[5F\\x9b1A\\x1b]0;title\\x07" in text
    else:
        assert "\\x1b" not in text


def test_a_table_of_many_topics_fits_the_screen(talker: Node) -> None:
    names = [f"/local_costmap/published/{'x' * i}/t{i}" for i in range(1, 31)]
    publishers = [talker.create_publisher(String, name, 10) for name in names]
    talker.create_timer(0.2, lambda: [each.publish(String()) for each in publishers])
    text = shown("topic", "hz", "--all", "--count", "2")
    lines = re.sub(r"\x1b\[\d*[mKJ]", "", text.split("\x1b[23F")[1]).split("\r\n")
    assert len(lines) == 24  # the cursor is in the last
    assert max(map(len, lines)) <= 80
    assert lines[0].split()[-1] == "window"
    assert lines[2].startswith("/local_costmap/published/x/t1   ")
    assert lines[20].split()[0].endswith("x/t19")
    assert lines[20].startswith("…")
    assert lines[21:] == ["… 11 more on a taller terminal", "", ""]
