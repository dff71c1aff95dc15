"""The live view's page: time to the first picture, frames per second, CPU time.

Usage: ``python benchmarks/bench_page.py [SECONDS]``. Needs Chromium and Node.js.

`navette demo` runs in real time in a process of its own; Chromium draws its page
without a graphics card at 1440 x 900. Server: CPU seconds of the demo's process per
second, first without a page, then with one.
"""

import json
import re
import shutil
import statistics
import subprocess
import sys
import time
from pathlib import Path

import psutil

SCRIPT = Path(__file__).parents[1] / "tests/conformance/js/measure.mjs"


def cpu_s(process: psutil.Process) -> float:
    """CPU time of a process and those it started."""
    total = 0.0
    for each in (process, *process.children(recursive=True)):
        times = each.cpu_times()
        total += times.user + times.system
    return total


def main() -> None:
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 20.0
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None or shutil.which("node") is None:
        sys.exit("Chromium or Node.js is not installed")
    command = [sys.executable, "-u", "-m", "navette", "demo", "--port", "0"]
    demo = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    assert demo.stderr is not None
    try:
        url = next(
            found[0]
            for line in demo.stderr
            if (found := re.search(r"http://[\w.]+:\d+", line))
        )
        process = psutil.Process(demo.pid)
        time.sleep(5.0)
        before, begin = cpu_s(process), time.monotonic()
        time.sleep(10.0)
        alone = (cpu_s(process) - before) / (time.monotonic() - begin)
        watching = subprocess.Popen(
            ["node", str(SCRIPT), url, chromium, str(seconds)],
            stdout=subprocess.PIPE,
            text=True,
        )
        time.sleep(15.0)  # the page is opened several times
        before, begin = cpu_s(process), time.monotonic()
        time.sleep(seconds / 2)
        watched = (cpu_s(process) - before) / (time.monotonic() - begin)
        output, _ = watching.communicate()
    finally:
        demo.terminate()
        demo.wait()
    report(json.loads(output), alone, watched)


def report(seen: dict[str, object], alone: float, watched: float) -> None:
    loads = seen["loads"]
    assert isinstance(loads, list)
    for name in ("interactiveMs", "pictureMs", "keyMs", "rendererCpuS", "bytes"):
        values = [each[name] for each in loads]
        sys.stdout.write(
            f"{name:16} median {statistics.median(values):10.2f}   "
            f"best {min(values):10.2f}   worst {max(values):10.2f}\n"
        )
    sys.stdout.write(f"{'phone':16} {json.dumps(seen['phone'])}\n")
    for name, value in seen.items():
        if isinstance(value, float | int):
            sys.stdout.write(f"{name:16} {value:.2f}\n")
    sys.stdout.write(f"server: {alone:.2f} cores alone, {watched:.2f} with a page\n")


if __name__ == "__main__":
    main()
