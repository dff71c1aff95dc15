"""Real programs that run beside each other, and what they have printed."""

import json
import math
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any

PROGRAMS = Path(__file__).parent / "programs"
STACK = ("costmap", "map_memory", "planner", "control")
PATIENCE_S = 60.0


def until(check: Callable[[], bool], what: str) -> None:
    """Look again and again; real programs have no virtual clock."""
    pause = threading.Event()
    for _ in range(round(PATIENCE_S / 0.05)):
        if check():
            return
        pause.wait(0.05)
    raise AssertionError(f"not within {PATIENCE_S} s: {what}")


class Fleet:
    """Programs of ``navette run``, each a process; ``with`` ends them."""

    def __init__(self, folder: Path, env: Mapping[str, str]) -> None:
        self._folder = folder
        self._env = {"NAVETTE_TRANSPORT": "zenoh", "PYTHONUNBUFFERED": "1", **env}
        self.running: dict[str, subprocess.Popen[bytes]] = {}

    def start(
        self,
        name: str,
        *words: str,
        prefix: Sequence[str] = (),
        env: Mapping[str, str] | None = None,
    ) -> None:
        """``navette run WORDS…``; its output goes to a file of its name."""
        if name in self.running:  # a new one in its place
            self.running[name].wait(20.0)
        with (self._folder / name).open("wb") as file:
            self.running[name] = subprocess.Popen(
                [*prefix, sys.executable, "-m", "navette", "run", *words],
                env={**os.environ, **self._env, **(env or {})},
                stdout=file,
                stderr=subprocess.STDOUT,
            )

    def said(self, name: str) -> list[str]:
        """The whole lines that a program printed so far."""
        text = (self._folder / name).read_text(encoding="utf-8")
        return text[: text.rfind("\n") + 1].splitlines()

    def track(self, key: str) -> list[dict[str, Any]]:
        """What the program ``track.py``, started as ``track``, said of ``key``."""
        said = (line for line in self.said("track") if f'"{key}"' in line)
        return [json.loads(line) for line in said if line.startswith("{")]

    def speed(self) -> float:
        """How fast the robot is now, in m/s; not a number before it is known."""
        speeds = self.track("speed")
        return float(speeds[-1]["speed"]) if speeds else math.nan

    def __enter__(self) -> "Fleet":
        return self

    def __exit__(
        self,
        exc_type: type[BaseException] | None,
        exc: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        for process in self.running.values():
            process.send_signal(signal.SIGCONT)
            process.send_signal(signal.SIGINT)
        for process in self.running.values():
            process.wait(20.0)
