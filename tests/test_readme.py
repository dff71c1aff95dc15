"""The program in the README runs."""

import re
import signal
import subprocess
import sys
from pathlib import Path

README = (Path(__file__).parent.parent / "README.md").read_text(encoding="utf-8")


def test_the_program_runs_and_ends_on_ctrl_c() -> None:
    program = re.search(r"```python\n(.*?)```", README, re.DOTALL)
    assert program is not None
    lines = [line for line in program[1].splitlines() if line]
    assert len(lines) <= 12
    process = subprocess.Popen(
        [sys.executable, "-u", "-c", program[1]], stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    with process.stdout:
        assert process.stdout.readline() == "received: Hello, ROS 2!\n"
        assert process.stdout.readline() == "received: Hello, ROS 2!\n"
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=60) == 0
