"""Take the pictures of the live view: ``python docs/screenshot.py [NAME]``. Needs
chromium.

Runs the demo for each picture and captures the page during the drive: the workbench,
the scene in 3D, a phone, and a moving picture. The demo runs in real time: nothing else
may load the machine, or the page displays a lower speed.
"""

import base64
import io
import itertools
import json
import re
import subprocess
import sys
import tempfile
import urllib.request
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from PIL import Image
from websockets.sync.client import ClientConnection, connect

IMAGES = Path(__file__).parent / "images"
FILM = IMAGES / "page.webp"
FILM_SIZE, FILM_S, FILM_HZ = (960, 600), 14, 4


class Shot(NamedTuple):
    """A picture of a drive of its own, when the robot's clock shows ``moment``.

    ``script`` runs at the beginning.
    """

    name: str
    moment: str
    width: int
    height: int
    scale: float
    script: str = ""


SHOTS = (
    Shot(
        "page.png", "0:20", 1440, 900, 1.5, "navette.open('plot'); navette.open('tree')"
    ),
    Shot(
        "page-3d.png",
        "0:26",
        1280,
        720,
        1.5,
        "navette.scene.setThreeDimensional(true)",
    ),
    Shot("page-phone.png", "0:32", 390, 780, 2.0),
)


class Browser:
    """A headless browser, controlled by the Chrome DevTools Protocol."""

    def __init__(self, socket: ClientConnection) -> None:
        self._socket = socket
        self._ids = itertools.count(1)

    def call(self, method: str, **params: Any) -> dict[str, Any]:
        number = next(self._ids)
        request = {"id": number, "method": method, "params": params}
        self._socket.send(json.dumps(request))
        while True:
            reply = json.loads(self._socket.recv())
            if reply.get("id") == number:
                return dict(reply.get("result", {}))  # none while the page loads

    def evaluate(self, expression: str) -> Any:
        result = self.call("Runtime.evaluate", expression=expression, awaitPromise=True)
        return result.get("result", {}).get("value")


def capture(folder: str, work: Callable[[Browser], None]) -> None:
    """Start a browser and take a picture."""
    command = ["chromium", "--headless", "--no-sandbox", "--hide-scrollbars"]
    command += ["--enable-unsafe-swiftshader", "--remote-debugging-port=0"]
    command += [f"--user-data-dir={folder}", "about:blank"]
    browser = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    assert browser.stderr is not None
    try:
        address = next(
            found[1]
            for line in browser.stderr
            if (found := re.search(r"ws://([\w.]+:\d+)/", line))
        )
        with urllib.request.urlopen(f"http://{address}/json") as reply:
            page = next(each for each in json.load(reply) if each["type"] == "page")
        with connect(page["webSocketDebuggerUrl"], max_size=None) as socket:
            work(Browser(socket))
    finally:
        browser.terminate()
        browser.wait()


def _open(browser: Browser, address: str, size: tuple[int, int], scale: float) -> None:
    width, height = size
    metrics = {"width": width, "height": height, "deviceScaleFactor": scale}
    browser.call("Emulation.setDeviceMetricsOverride", **metrics, mobile=width < 700)
    browser.call("Page.navigate", url="about:blank")
    browser.call(
        "Storage.clearDataForOrigin", origin=address, storageTypes="local_storage"
    )
    browser.call("Page.navigate", url=address)


def _picture(browser: Browser) -> bytes:
    while True:
        answer = browser.call("Page.captureScreenshot", format="png")
        if "data" in answer:  # none while the page loads
            return base64.b64decode(answer["data"])


def _pause(browser: Browser, seconds: float) -> None:
    browser.evaluate(f"new Promise(done => setTimeout(done, {1000 * seconds}))")


def _take(browser: Browser, address: str, shot: Shot) -> None:
    _open(browser, address, (shot.width, shot.height), shot.scale)
    _pause(browser, 3.0)
    browser.evaluate(shot.script)
    clock = "document.querySelector('#clock')?.textContent ?? ''"
    while (browser.evaluate(clock) or "") < shot.moment:
        _pause(browser, 0.2)
    (IMAGES / shot.name).write_bytes(_picture(browser))


def _film(browser: Browser, address: str) -> None:
    """Record the first seconds: the map grows while the robot drives."""
    _open(browser, address, FILM_SIZE, 1.0)
    frames = []
    for _ in range(FILM_S * FILM_HZ):
        _pause(browser, 1.0 / FILM_HZ)
        picture = Image.open(io.BytesIO(_picture(browser)))
        frames.append(picture.convert("RGB"))
    first, *others = frames
    first.save(
        FILM,
        save_all=True,
        append_images=others,
        duration=1000 // FILM_HZ,
        loop=0,
        quality=60,
        method=4,
    )


def with_demo(work: Callable[[Browser, str], None]) -> None:
    """Run the demo from its beginning, with a browser."""
    command = [sys.executable, "-u", "-m", "navette", "demo", "--port", "0"]
    demo = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    assert demo.stderr is not None
    try:
        address = next(
            found[0]
            for line in demo.stderr
            if (found := re.search(r"http://127\.0\.0\.1:\d+", line))
        )
        with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
            capture(folder, lambda browser: work(browser, address))
    finally:
        demo.terminate()
        demo.wait()


def main() -> None:
    """Take all pictures, or those whose name has the argument."""
    wanted = sys.argv[1] if len(sys.argv) > 1 else ""
    if wanted in FILM.name:
        with_demo(_film)
    for shot in SHOTS:
        if wanted in shot.name:
            with_demo(partial(_take, shot=shot))


if __name__ == "__main__":
    main()
