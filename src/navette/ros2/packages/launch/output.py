"""Output of processes: labelled lines on the terminal and in log files."""

import os
import sys
from pathlib import Path
from typing import IO

from navette.ros2.packages.launch.logging import launch_config
from navette.ros2.packages.launch.logging.outputs import STREAMS, places_of_stream
from navette.supervisor import LineSplitter

_COLOURS = (36, 32, 35, 33, 34, 96)  # cyan, green, magenta, yellow, blue, bright cyan


def _shown(label: str) -> str:
    """Return ``[talker-1]``, coloured on a terminal."""
    if not sys.stdout.isatty() or "NO_COLOR" in os.environ:
        return f"[{label}]"
    number = label.rpartition("-")[2]
    colour = _COLOURS[int(number) % len(_COLOURS) if number.isdigit() else 0]
    return f"\x1b[{colour}m[{label}]\x1b[0m"


class LabelledOutput:
    """Writes the output of a process line by line, with its label.

    Args:
        label: such as ``talker-1``.
        places: result of :func:`launch.logging.output_places`.
    """

    def __init__(self, label: str, places: dict[str, set[str]]) -> None:
        self._label = label
        self._places = places
        self._cutters = {stream: LineSplitter() for stream in STREAMS}
        self._log: IO[str] | None = None

    def write(self, stream: str, data: bytes) -> None:
        """Print the complete lines, keep the rest."""
        self._print(stream, self._cutters[stream].feed(data))

    def close(self) -> None:
        """Print incomplete last lines."""
        for stream in STREAMS:
            self._print(stream, self._cutters[stream].finish())
        if self._log is not None:
            self._log.close()
            self._log = None

    def _print(self, stream: str, texts: list[str]) -> None:
        if not texts:
            return
        places = places_of_stream(self._places, stream)
        if "screen" in places:
            terminal = sys.stdout if stream == "stdout" else sys.stderr
            terminal.write("".join(f"{_shown(self._label)} {text}\n" for text in texts))
            terminal.flush()
        if places & {"log", "own_log"}:
            log = self._open_log()
            log.write("".join(text + "\n" for text in texts))
            log.flush()

    def _open_log(self) -> IO[str]:
        if self._log is None:
            folder = Path(launch_config.log_dir)
            folder.mkdir(parents=True, exist_ok=True)
            self._log = (folder / f"{self._label}.log").open("a", encoding="utf-8")
        return self._log
