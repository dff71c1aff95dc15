"""``navette bag play``: publish the messages of recordings in real time."""

import signal
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import click

from navette.cli.interruption import INTERRUPTED, sigterm_as_interrupt
from navette.cli.options import Argument, Option
from navette.cli.session import FAILED

if TYPE_CHECKING:
    from navette.bags.play import PlayOptions
    from navette.bags.play.node import PlayerNode
    from navette.navigation.stack.playback import BagPlayback

_BACK_NS = 5_000_000_000
_FASTER = 1.1

Files = Annotated[
    list[Path],
    Argument(
        metavar="FILE...",
        help=".mcap, .bag or .db3 files, or rosbag2 folders. Several are merged.",
    ),
]
Loop = Annotated[bool, Option("-l", "--loop", help="Restart at the end.")]
Paused = Annotated[
    bool, Option("-p", "--pause", "--start-paused", help="Start paused.")
]
Rate = Annotated[
    float, Option("-r", "--rate", metavar="X", help="Factor of real time.")
]
Start = Annotated[
    float,
    Option("-s", "--start-offset", metavar="S", help="Skip the first S seconds."),
]
Length = Annotated[
    float | None,
    Option("-u", "--duration", metavar="S", help="Play S seconds."),
]
Topics = Annotated[
    list[str] | None,
    Option(
        "--topics",
        metavar="TOPIC...",
        help="Play only these topics.",
        takes_words=True,
    ),
]
Regex = Annotated[
    str,
    Option("-e", "--regex", metavar="REGEX", help="Play only matching topics."),
]
Exclude = Annotated[
    str,
    Option("-x", "--exclude", metavar="REGEX", help="Omit matching topics."),
]
Remap = Annotated[
    list[str] | None,
    Option(
        "-m",
        "--remap",
        metavar="FROM:=TO...",
        help="Rename topics.",
        takes_words=True,
    ),
]
Clock = Annotated[
    float | None,
    Option(
        metavar="[HZ]",
        help="Publish the time of the recording on /clock (default: 40 Hz).",
    ),
]
With = Annotated[
    list[str] | None,
    Option(
        "--with",
        metavar="'PROGRAM [ARGS]'",
        help="Run a program in the same process, as navette run does; it ends with"
        " the bag.",
    ),
]
View = Annotated[
    bool,
    Option("--view", help="Open the live view with playback controls."),
]
Port = Annotated[
    int, Option(min=0, max=65535, help="Port of the live view on 127.0.0.1.")
]


def play(
    files: Files,
    loop: Loop = False,
    paused: Paused = False,
    rate: Rate = 1.0,
    start_offset: Start = 0.0,
    duration: Length = None,
    topics: Topics = None,
    regex: Regex = "",
    exclude: Exclude = "",
    remap: Remap = None,
    clock: Clock = None,
    programs: With = None,
    view: View = False,
    port: Port = 8765,
) -> None:
    """Play recordings: publish their messages with the recorded timing.

    Damaged parts are left out; the exit code is then 1.

    Keys: space pauses and resumes, s or → plays the next message, ← goes back 5 s,
    ↑ and ↓ change the rate, q quits.
    """
    from navette.bags.play import PlayOptions
    from navette.files.runs import stay_shared

    stay_shared()  # recorded sensor data and commands would disturb a run's robot
    options = PlayOptions(
        rate=rate,
        loop=loop,
        paused=paused,
        start_offset_s=start_offset,
        duration_s=duration,
        topics=tuple(topics or ()),
        regex=regex,
        exclude=exclude,
    )

    def run() -> int:
        return _play(files, options, tuple(remap or ()), clock, port if view else None)

    raise click.exceptions.Exit(_play_with(programs, run) if programs else run())


def _play(
    files: list[Path],
    options: "PlayOptions",
    remap: tuple[str, ...],
    clock_rate_hz: float | None,
    port: int | None,
) -> int:
    from navette.cli.bag.play_screen import PlayScreen
    from navette.cli.keyboard import listening_to_keys
    from navette.errors import CallbackError
    from navette.navigation.stack.playback import BagPlayback

    with ExitStack() as stack:
        stack.enter_context(sigterm_as_interrupt())
        playback = BagPlayback(
            files, options, remap=remap, clock_rate_hz=clock_rate_hz, view_port=port
        )
        stack.callback(playback.close)
        screen = PlayScreen(playback)
        screen.show_head(files, len(playback.player.player.names), playback.url)
        word = "played"
        try:
            keys = stack.enter_context(listening_to_keys(_keyboard(playback)))
            with screen.watching(keys=keys):
                playback.run()
        except KeyboardInterrupt:
            word = "interrupted"
        except CallbackError as error:
            screen.report_failure(f"stopped: {error}")
            return FAILED
        screen.report(word)
        screen.report_losses(playback.losses)
    if word == "interrupted":
        return INTERRUPTED
    return FAILED if playback.losses else 0


def _keyboard(playback: "BagPlayback") -> Callable[[str], None]:
    def on_key(key: str) -> None:
        if key == "q":
            playback.stop()
        elif key in _ACTIONS:
            playback.do(_ACTIONS[key])

    return on_key


def _multiply_rate(player: "PlayerNode", factor: float) -> None:
    from navette.bags.play.options import MAX_RATE, MIN_RATE

    rate = round(player.player.rate * factor, 3)
    player.set_rate(min(MAX_RATE, max(MIN_RATE, rate)))


_ACTIONS: dict[str, Callable[["PlayerNode"], object]] = {
    " ": lambda player: player.toggle_paused(),
    "s": lambda player: player.step(),
    "right": lambda player: player.step(),
    "left": lambda player: player.seek_by(-_BACK_NS),
    "up": lambda player: _multiply_rate(player, _FASTER),
    "down": lambda player: _multiply_rate(player, 1 / _FASTER),
}


def _play_with(words: list[str], run: Callable[[], int]) -> int:
    """Run the playback and programs in threads; the end of the bag ends all of them."""
    import shlex

    from navette.ros2.names import install
    from navette.ros2.names.process import run_together
    from navette.ros2.names.program import Program
    from navette.ros2.names.targets import read_programs
    from navette.ros2.workspace import activate

    def play_and_end() -> int:
        code = run()
        signal.raise_signal(signal.SIGTERM)
        return code

    install(instead_of_ros=True)
    activate()
    programs = [p for each in words for p in read_programs(shlex.split(each))]
    return run_together([*programs, Program("navette bag play", (), play_and_end)])
