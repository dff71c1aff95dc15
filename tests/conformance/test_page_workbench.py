"""The page of `navette demo` in Chromium: goals, panels, run control, sizes, themes."""

import json
import os
import shutil
import subprocess
import sys
import urllib.error
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import pytest
from fleet import until
from test_viewer_javascript import JAVASCRIPT

from free_ports import free_port

pytestmark = pytest.mark.long


class Demo:
    """`navette demo` on a port; it can be ended and started again."""

    def __init__(self, folder: Path, port: int) -> None:
        self._folder, self.port = folder, port
        self._process: subprocess.Popen[bytes] | None = None

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.port}"

    def start(self) -> None:
        command = [sys.executable, "-m", "navette", "demo", "--port", str(self.port)]
        with (self._folder / "demo.txt").open("ab") as output:
            self._process = subprocess.Popen(
                command,
                cwd=self._folder,
                env={**os.environ, "XDG_RUNTIME_DIR": str(self._folder)},
                stdout=output,
                stderr=output,
            )
        until(self._answers, "the live view")

    def stop(self) -> None:
        if self._process is not None:
            self._process.kill()
            self._process.wait()

    def _answers(self) -> bool:
        try:
            with urllib.request.urlopen(f"{self.url}/health", timeout=5.0) as answer:
                return bool(json.load(answer)["topics"])
        except (urllib.error.URLError, ConnectionError, TimeoutError):
            return False


@pytest.fixture
def demo(tmp_path: Path) -> Iterator[Demo]:
    tmp_path.chmod(0o700)
    running = Demo(tmp_path, free_port())
    running.start()
    yield running
    running.stop()


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_a_person_at_the_page_of_the_demo(demo: Demo, tmp_path: Path) -> None:
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    node = shutil.which("node")
    if chromium is None or node is None or not (JAVASCRIPT / "node_modules").is_dir():
        pytest.skip("needs Chromium, Node.js and npm ci --prefix tests/conformance/js")
    script = str(JAVASCRIPT / "workbench.mjs")
    with subprocess.Popen(
        [node, script, demo.url, chromium, str(tmp_path)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    ) as page:
        assert page.stdin is not None
        assert page.stdout is not None
        assert page.stdout.readline() == "end\n"
        demo.stop()
        demo.start()
        page.stdin.write("back\n")
        page.stdin.flush()
        seen = json.loads(page.stdout.readline())
    assert seen["problems"] == []
    first, last = seen["known"]
    assert last > first
    assert "sent" in seen["clicked"]
    assert "sent" in seen["withHeading"]
    assert seen["missed"] < 0.6
    assert seen["log"]
    assert "Odometry" in seen["raw"]
    # While paused time does not advance; a step of the panel is 100 ms.
    assert seen["whilePaused"] == 0
    assert seen["step"] == 100_000_000
    for name in ("desktop-dark", "tablet-light", "phone-dark", "phone-light"):
        assert max(seen[name]) <= 0, f"{name} scrolls"
    assert {name: found for name, found in seen["axe"].items() if found} == {}
    assert seen["lost"]
