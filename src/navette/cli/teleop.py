"""``navette teleop``: drive a robot with the keyboard."""

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated

import click

from navette.cli.options import Argument, Option

if TYPE_CHECKING:
    from navette.cli.teleop_link import TeleopLink

STOP_KEY, RELEASE_KEY = " ", "r"

# A terminal reports key presses and repeats, but not releases: each press drives for
# this long, which exceeds the usual repeat delay of keyboards.
_HOLD_NS = 600_000_000
_PERIOD_S = 0.1
_STEP = 1.1

# (forward, turn) as in ROS 2's teleop_twist_keyboard, on the arrow keys and on wasd.
_DIRECTIONS = {
    **dict.fromkeys(("up", "w", "i"), (1, 0)),
    **dict.fromkeys(("down", "s", ","), (-1, 0)),
    **dict.fromkeys(("left", "a", "j"), (0, 1)),
    **dict.fromkeys(("right", "d", "l"), (0, -1)),
    "u": (1, 1),
    "o": (1, -1),
    "m": (-1, 1),
    ".": (-1, -1),
}
_HELP = (
    ("↑ ↓ ← →", "or w s a d"),
    ("u o m .", "curves"),
    ("space", "emergency stop"),
    ("r", "release it"),
    ("any other key", "halt"),
    ("+ −", "faster, slower"),
    ("q", "quit"),
)


class KeyDriver:
    """Convert key presses to velocity commands.

    Args:
        speed_mps: initial forward speed.
        turn_radps: initial turn rate.
    """

    def __init__(self, speed_mps: float, turn_radps: float) -> None:
        self.speed_mps = speed_mps
        self.turn_radps = turn_radps
        self.has_quit = False
        self._direction = (0, 0)
        self._until_ns = 0
        self._drives = False

    def press(self, key: str, now_ns: int) -> None:
        """Handle a key; an unassigned key stops the robot."""
        if key in ("+", "=", "-", "−"):
            factor = _STEP if key in "+=" else 1 / _STEP
            self.speed_mps *= factor
            self.turn_radps *= factor
            return
        self.has_quit = self.has_quit or key in ("q", "escape")
        self._direction = _DIRECTIONS.get(key, (0, 0))
        self._until_ns = now_ns + _HOLD_NS
        self._drives = True

    def command(self, now_ns: int) -> tuple[float, float] | None:
        """Return speed (m/s) and turn rate (rad/s), or None to publish nothing.

        The last command of a movement is zero.
        """
        if not self._drives:
            return None
        if now_ns >= self._until_ns or self._direction == (0, 0) or self.has_quit:
            self._drives = False
            return 0.0, 0.0
        forward, turn = self._direction
        return forward * self.speed_mps, turn * self.turn_radps


def teleop(
    topic: Annotated[
        str,
        Argument(
            metavar="[TOPIC]",
            help="Topic of velocity commands. Default: that of the arbiter's operator, "
            "or of the robot itself where no arbiter runs.",
        ),
    ] = "",
    speed: Annotated[float, Option(metavar="M/S", help="Forward speed.")] = 0.5,
    turn: Annotated[float, Option(metavar="RAD/S", help="Turn rate.")] = 0.8,
) -> None:
    """Drive a robot with the keyboard.

    The first key takes over from navigation, which resumes after you let go. The robot
    stops when no key is held. Space engages the emergency stop, r releases it.
    """
    for name, value in (("--speed", speed), ("--turn", turn)):
        if not (math.isfinite(value) and value > 0):
            raise click.BadParameter(f"{name} {value} is not above 0")
    from navette.cli.keyboard import listening_to_keys
    from navette.cli.session import connect, fail, wait_for
    from navette.cli.teleop_link import TeleopLink

    driver = KeyDriver(speed, turn)
    with connect(node_name="teleop") as node:
        link = TeleopLink(node, topic)
        clock = node.context.clock

        def send() -> None:
            command = driver.command(clock.now_ns)
            if command is not None:
                link.drive(*command)

        def press(key: str) -> None:
            driver.press(key, clock.now_ns)
            node.executor.call_soon_threadsafe(send)
            if key == STOP_KEY:
                node.executor.call_soon_threadsafe(link.stop)
            elif key == RELEASE_KEY:
                node.executor.call_soon_threadsafe(link.release)

        node.create_timer(_PERIOD_S, send)
        with listening_to_keys(press) as has_keys:
            if not has_keys:
                fail("teleop needs a terminal as standard input to read keys")
            with _shown(driver, link) as refresh:
                node.create_timer(_PERIOD_S, refresh)
                wait_for(node, lambda: driver.has_quit)
                link.drive(0.0, 0.0)


@contextmanager
def _shown(driver: KeyDriver, link: "TeleopLink") -> Iterator[Callable[[], None]]:
    """Print the keys, and update one line with the speeds and who commands."""
    from rich.console import Console
    from rich.live import Live
    from rich.text import Text

    from navette.cli.hanging_indent import in_rows

    console = Console(stderr=True, highlight=False)
    keys = [
        Text.assemble((f"{key} ", "bold"), (meaning, "dim")) for key, meaning in _HELP
    ]
    console.print(in_rows(keys, console.width), soft_wrap=True)

    def line() -> Text:
        parts = [Text(f"{driver.speed_mps:.2f} m/s  {driver.turn_radps:.2f} rad/s")]
        topic, commander = link.topic, link.commander
        if not topic:
            parts.append(Text(f"no subscription on {link.wanted}", style="yellow"))
        else:
            parts.append(Text(f"→ {topic}", style="dim"))
            if commander.is_stopped:
                parts.append(Text("EMERGENCY STOP: r releases it", style="bold red"))
            elif commander.name:
                parts.append(Text(f"{commander.text} commands", style="cyan"))
        return in_rows(parts, console.width)

    with Live(line(), console=console, auto_refresh=False, transient=True) as live:
        yield lambda: live.update(line(), refresh=True)
