"""The page of `navette demo` in Chromium and Firefox: goals, panels, run control."""

import json
import os
import shutil
import subprocess
import sys
import urllib.error
import urllib.request
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from fleet import until
from test_viewer_javascript import JAVASCRIPT

from free_ports import free_port

pytestmark = pytest.mark.long


BROWSERS = {
    "chromium": ("chromium", "chromium-browser"),
    "firefox": ("firefox-esr", "firefox"),
}


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


class Person:
    """A part of the script with the page of a demo."""

    def __init__(self, part: str, browser: str, demo: Demo, folder: Path) -> None:
        names = BROWSERS[browser]
        executable = next(filter(None, map(shutil.which, names)), None)
        node = shutil.which("node")
        if executable is None or node is None:
            pytest.skip(f"{names[0]} or Node.js is not installed")
        if not (JAVASCRIPT / "node_modules").is_dir():
            pytest.skip(
                "npm packages are missing: npm ci --prefix tests/conformance/js"
            )
        script = str(JAVASCRIPT / "workbench.mjs")
        self._process = subprocess.Popen(
            [node, script, part, demo.url, executable, str(folder)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def read(self) -> str:
        assert self._process.stdout is not None
        return self._process.stdout.readline()

    def write(self, line: str) -> None:
        assert self._process.stdin is not None
        self._process.stdin.write(f"{line}\n")
        self._process.stdin.flush()

    def seen(self) -> dict[str, Any]:
        """Return what the page displayed: no problem, and nothing serious for axe."""
        seen: dict[str, Any] = json.loads(self.read())
        assert seen["problems"] == []
        assert {name: found for name, found in seen["axe"].items() if found} == {}
        return seen

    def close(self) -> None:
        self._process.communicate()


@pytest.fixture
def person(
    request: pytest.FixtureRequest, demo: Demo, tmp_path: Path
) -> Iterator[Person]:
    made = Person(*request.param, demo, tmp_path)
    yield made
    made.close()


def part(name: str, *browsers: str) -> pytest.MarkDecorator:
    parts = [(name, browser) for browser in browsers or ("chromium",)]
    return pytest.mark.parametrize(
        "person", parts, indirect=True, ids=lambda each: each[1]
    )


@pytest.mark.slow
@part("goals", *BROWSERS)
def test_the_map_grows_and_the_robot_arrives_at_goals(person: Person) -> None:
    seen = person.seen()
    first, last = seen["known"]
    assert last > first
    assert "sent" in seen["clicked"]
    assert "sent" in seen["withHeading"]
    assert seen["missed"] < 0.6


@pytest.mark.slow
@part("panels", *BROWSERS)
def test_panels_display_data_and_control_the_run(person: Person) -> None:
    seen = person.seen()
    assert seen["log"]
    assert "Odometry" in seen["raw"]
    assert seen["cutPx"] == [0, 0], "the topic and the frame are readable"
    # While paused time does not advance; a step of the panel is 100 ms.
    assert seen["whilePaused"] == 0
    assert seen["step"] == 100_000_000
    grown, restarted = seen["afterReset"]
    assert restarted < grown


@pytest.mark.slow
@part("sizes", *BROWSERS)
def test_the_page_fits_every_size_in_both_themes(person: Person) -> None:
    seen = person.seen()
    for name in ("desktop-dark", "tablet-light", "phone-dark", "phone-light"):
        assert max(seen[name]) <= 0, f"{name} scrolls"


@pytest.mark.slow
@part("access")
def test_axe_finds_nothing_serious_in_any_panel(person: Person) -> None:
    seen = person.seen()
    kinds = {each.split()[1] for each in seen["axe"]}
    assert seen["portrait"] == seen["landscape"] == len(kinds), "all panels"


@pytest.mark.slow
@part("touch")
def test_a_thumb_takes_over_and_stops(person: Person) -> None:
    person.seen()


@pytest.mark.slow
@part("hang", *BROWSERS)
def test_a_page_that_hangs_receives_the_goal_that_was_sent_meanwhile(
    person: Person,
) -> None:
    person.seen()


@pytest.mark.slow
@part("keys", *BROWSERS)
def test_space_stops_wherever_the_focus_is(person: Person) -> None:
    seen = person.seen()
    assert [seen[what] for what in ("panel", "tab", "slider")] == [True] * 3
    assert seen["ring"] == ["2px", "solid", True]
    assert seen["tool"] == "m"


@pytest.mark.slow
@part("stop", *BROWSERS)
def test_nothing_that_is_open_covers_stop(person: Person) -> None:
    seen = person.seen()
    cards = {"shortcuts", "layout", "theme", "goal", "info", "waypoints"}
    for name in ("desktop", "laptop", "phone", "sheet", "landscape"):
        is_phone = name not in ("desktop", "laptop")
        assert set(seen["opened"][name]) == cards | (set() if is_phone else {"panels"})
        assert {
            card: above for card, above in seen["above"][name].items() if above
        } == {}


@pytest.mark.slow
@part("files", *BROWSERS)
def test_files_are_saved_and_loaded_and_refusals_have_a_reason(person: Person) -> None:
    seen = person.seen()
    header, first = seen["csv"]
    assert header == 'time_s,"/odom/filtered.twist.twist.angular.z"'
    assert len(first.split(",")) == 2
    assert bytes(seen["png"]) == b"\x89PNG"
    assert seen["parameter"] == "2", "the value in effect"
    assert "refused" in seen["goal"].lower()


@pytest.mark.slow
@part("restart", *BROWSERS)
def test_the_page_returns_with_the_server(person: Person, demo: Demo) -> None:
    assert person.read() == "end\n"
    demo.stop()
    demo.start()
    person.write("back")
    assert person.seen()["lost"]


@pytest.mark.slow
@part("offline")
def test_the_page_opens_while_the_server_is_away(person: Person, demo: Demo) -> None:
    assert person.read() == "end\n"
    demo.stop()
    person.write("ended")
    assert person.read() == "start\n"
    demo.start()
    person.write("back")
    seen = person.seen()
    assert seen["manifest"] == []
    assert seen["installability"] in ([], ["in-incognito"])
    assert seen["lost"] == ["Not connected", "Not connected"]


@pytest.mark.slow
@part("measure", *BROWSERS)
def test_lengths_are_measured_by_clicks_and_by_a_drag(person: Person) -> None:
    seen = person.seen()
    lengths = [float(seen[name].split()[0]) for name in ("clicked", "dragging")]
    assert lengths == pytest.approx([3.0, 5.0], abs=0.05)
    assert seen["dragged"] == seen["dragging"]
    assert seen["after"] is None
    assert seen["planned"] == [2, 0, 2, 0]
