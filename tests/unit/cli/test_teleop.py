"""Keys become speed commands, and no key becomes rest."""

import os
import pty
import subprocess
import sys
from pathlib import Path

import pytest

from navette.cli.teleop import KeyDriver

HELD_NS = 600_000_000


@pytest.mark.parametrize(
    ("key", "command"),
    [
        ("up", (0.5, 0.0)),
        ("w", (0.5, 0.0)),
        ("s", (-0.5, 0.0)),
        ("left", (0.0, 0.8)),
        ("d", (0.0, -0.8)),
        ("u", (0.5, 0.8)),
        (".", (-0.5, -0.8)),
    ],
)
def test_a_key_drives_while_it_is_held_and_a_little_longer(
    key: str, command: tuple[float, float]
) -> None:
    driver = KeyDriver(0.5, 0.8)
    assert driver.command(0) is None
    driver.press(key, 0)
    assert driver.command(1) == command
    driver.press(key, HELD_NS - 1)
    assert driver.command(HELD_NS) == command
    assert driver.command(2 * HELD_NS) == (0.0, 0.0)
    assert driver.command(2 * HELD_NS) is None, "the zero is printed once"


@pytest.mark.parametrize("key", [" ", "x", "escape", "q"])
def test_every_other_key_stops(key: str) -> None:
    driver = KeyDriver(0.5, 0.8)
    driver.press("up", 0)
    driver.press(key, 1)
    assert driver.command(2) == (0.0, 0.0)
    assert driver.has_quit is (key in ("q", "escape"))


def test_plus_and_minus_change_both_speeds() -> None:
    driver = KeyDriver(0.5, 0.8)
    driver.press("+", 0)
    assert (driver.speed_mps, driver.turn_radps) == pytest.approx((0.55, 0.88))
    driver.press("-", 0)
    assert (driver.speed_mps, driver.turn_radps) == pytest.approx((0.5, 0.8))
    assert driver.command(0) is None


def test_without_a_terminal_the_verb_fails(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "navette", "teleop"],
        stdin=subprocess.DEVNULL,
        env={**os.environ, "NAVETTE_TRANSPORT": "inprocess"},
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode == 1
    assert "needs a terminal" in done.stderr


@pytest.mark.slow
def test_on_a_terminal_q_ends_it_and_the_terminal_is_as_before(tmp_path: Path) -> None:
    here, there = pty.openpty()
    process = subprocess.Popen(
        [sys.executable, "-m", "navette", "teleop"],
        stdin=there,
        stdout=there,
        stderr=there,
        start_new_session=True,
        preexec_fn=lambda: _take_terminal(there),
        env={**os.environ, "NAVETTE_TRANSPORT": "inprocess", "TERM": "xterm"},
    )
    shown = b""
    while b"m/s" not in shown:
        shown += os.read(here, 4096)
    os.write(here, b"\x1b[Aq")
    assert process.wait(30.0) == 0
    assert "no subscription on /cmd_vel_teleop or /cmd_vel" in shown.decode(
        errors="replace"
    )
    os.close(here)
    os.close(there)


def _take_terminal(descriptor: int) -> None:
    import fcntl
    import termios

    fcntl.ioctl(descriptor, termios.TIOCSCTTY, 0)
