"""The program in the README runs; links of root files resolve."""

import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")
PAGES = ["README.md", "CONTRIBUTING.md", "SECURITY.md", "CODE_OF_CONDUCT.md"]


@pytest.mark.parametrize("page", PAGES)
def test_links_of_root_pages_resolve(page: str) -> None:
    text = (ROOT / page).read_text(encoding="utf-8")
    links = re.findall(r"\]\(([^)#:\s]+)(?:#([\w-]+))?\)", text)
    for target, anchor in links:
        assert (ROOT / target).exists(), target
        if anchor:
            headings = re.findall(
                r"^#+ (.*)$", (ROOT / target).read_text("utf-8"), re.MULTILINE
            )
            slugs = [
                re.sub(r"[^\w -]", "", h).lower().replace(" ", "-") for h in headings
            ]
            assert anchor in slugs, f"{target}#{anchor}"


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
