"""Start-up in a new process: imports, the command line, the demo.

The demo is timed until the robot moves (real-time clock, live view on): with the
kernels in Numba's cache, and with an empty cache as on the very first run.
"""

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from harness import Benchmark, Figure, Run

HERE = Path(__file__).parent
RUN_CLI = "from navette.cli import main; main()"
NAVETTE = (sys.executable, "-c", RUN_CLI)


def process(*command: str, cache: str | None = None) -> str:
    """Run a command to its end; return its output."""
    environment = dict(os.environ)
    if cache is not None:
        environment["NUMBA_CACHE_DIR"] = cache
    done = subprocess.run(
        command, check=True, capture_output=True, text=True, env=environment
    )
    return done.stdout


def python(code: str) -> Run:
    return lambda: process(sys.executable, "-c", code)


def cli(*arguments: str) -> Run:
    return lambda: process(*NAVETTE, *arguments)


def seconds_to_motion(cache: str | None = None) -> float:
    """Return the wall time from process start until the robot moves."""
    start = time.perf_counter()
    process(sys.executable, str(HERE / "first_motion.py"), cache=cache)
    return time.perf_counter() - start


def first_run() -> Figure:
    with tempfile.TemporaryDirectory() as empty:
        seconds = seconds_to_motion(empty)
    note = "empty kernel cache; one run"
    return Figure(
        "demo to a moving robot, very first run", seconds, "s", 20.0, False, note
    )


def main() -> None:
    bench = Benchmark("start-up", __doc__)
    alone = python("pass")
    bench.case(
        "import navette",
        {
            "navette": python("import navette"),
            "python alone": alone,
            "import numpy": python("import numpy"),
        },
    )
    bench.case(
        "from navette import Node",
        {"navette": python("from navette import Node"), "python alone": alone},
    )
    bench.case("navette --version", {"navette": cli("--version")}, target_ms=300)
    assert "Usage" in process(*NAVETTE, "--help")
    bench.case("navette --help", {"navette": cli("--help")}, target_ms=300)
    bench.case("navette sim --help", {"navette": cli("sim", "--help")}, target_ms=300)
    bench.case(
        "demo to a moving robot, warm",
        {"navette": seconds_to_motion},
        "kernels cached on disk, live view on",
        target_ms=3000,
    )
    bench.figure(first_run)
    bench.main()


if __name__ == "__main__":
    main()
