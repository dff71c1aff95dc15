"""Programs in processes of their own, and their output."""

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
STACK = ("costmap", "map_memory", "planner", "control", "arbiter")
PATIENCE_S = 180.0  # reached only by a defect


def until(
    check: Callable[[], bool], what: str, *, patience_s: float = PATIENCE_S
) -> None:
    """Poll until the condition holds; real programs have no virtual clock."""
    pause = threading.Event()
    for _ in range(round(patience_s / 0.05)):
        if check():
            return
        pause.wait(0.05)
    raise AssertionError(f"not within {patience_s} s: {what}")


class Fleet:
    """Programs under ``navette run``, each in a process; ``with`` ends them."""

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
        """Start ``navette run WORDS…``; its output goes to a file named ``name``."""
        if name in self.running:  # replaced by a new one
            self.running[name].wait(20.0)
        with (self._folder / name).open("wb") as file:
            self.running[name] = subprocess.Popen(
                [*prefix, sys.executable, "-m", "navette", "run", *words],
                env={**os.environ, **self._env, **(env or {})},
                stdout=file,
                stderr=subprocess.STDOUT,
            )

    def verb(self, *words: str) -> str:
        """Run another verb of ``navette`` to its end and return what it prints."""
        done = subprocess.run(
            [sys.executable, "-m", "navette", *words],
            env={**os.environ, **self._env},
            capture_output=True,
            text=True,
            timeout=PATIENCE_S,
            check=False,
        )
        return done.stdout

    def output(self, name: str) -> list[str]:
        """Return the complete lines that a program has printed."""
        text = (self._folder / name).read_text(encoding="utf-8")
        return text[: text.rfind("\n") + 1].splitlines()

    def track(self, key: str) -> dict[str, Any]:
        """Return the last record of ``track.py`` with ``key``, else an empty one."""
        for line in reversed(self.output("track")):
            if line.startswith("{") and f'"{key}"' in line:
                return dict(json.loads(line))
        return {}

    def speed(self) -> float:
        """Return the robot's speed in m/s; NaN before the first record."""
        return float(self.track("speed").get("speed", math.nan))

    def standstill(self) -> float:
        """Return the time on the robot's clock until it is stationary."""
        for _ in range(2):  # the next record may be older than this call
            count = len(self.output("track"))
            until(lambda count=count: len(self.output("track")) > count, "a record")
        begin = float(self.track("speed")["time"])
        until(lambda: abs(self.speed()) < 0.01, "the stationary robot")
        return float(self.track("speed")["time"]) - begin

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
        hung = [name for name in self.running if not self._ends(name)]
        assert not hung, f"did not end after Ctrl-C: {hung}"

    def _ends(self, name: str) -> bool:
        try:
            self.running[name].wait(PATIENCE_S)
        except subprocess.TimeoutExpired:
            self.running[name].kill()
            self.running[name].wait()
            return False
        return True
