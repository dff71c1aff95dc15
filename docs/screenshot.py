"""Take the picture of the live view: ``python docs/screenshot.py``. Needs chromium.

Runs the demo in real time and captures the page in the middle of the drive.
"""

import base64
import itertools
import json
import re
import subprocess
import sys
import tempfile
import urllib.request
from pathlib import Path
from typing import Any

from websockets.sync.client import ClientConnection, connect

PICTURE = Path(__file__).parent / "images" / "page.png"
MOMENT = "0:42"  # as the page shows the robot's time
WIDTH, HEIGHT, SCALE = 1240, 886, 1.5
SHOW_ALL = """
[...document.querySelectorAll('button')]
  .find(button => button.textContent.trim() === 'Whole map').click()
"""


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


def capture(address: str, folder: str) -> bytes:
    """Open the page, wait for the moment and return the PNG file."""
    command = ["chromium", "--headless", "--no-sandbox", "--hide-scrollbars"]
    command += ["--remote-debugging-port=0", f"--user-data-dir={folder}", "about:blank"]
    browser = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    assert browser.stderr is not None
    try:
        for line in browser.stderr:
            found = re.search(r"ws://([\w.]+:\d+)/", line)
            if found:
                break
        with urllib.request.urlopen(f"http://{found[1]}/json") as reply:
            page = next(each for each in json.load(reply) if each["type"] == "page")
        with connect(page["webSocketDebuggerUrl"], max_size=None) as socket:
            return _capture(Browser(socket), address)
    finally:
        browser.terminate()
        browser.wait()


def _capture(browser: Browser, address: str) -> bytes:
    metrics = {"width": WIDTH, "height": HEIGHT, "deviceScaleFactor": SCALE}
    browser.call("Emulation.setDeviceMetricsOverride", **metrics, mobile=False)
    browser.call("Page.navigate", url=address)
    pause = "new Promise(done => setTimeout(done, 200))"
    while MOMENT not in (browser.evaluate("document.body.innerText") or ""):
        browser.evaluate(pause)
    browser.evaluate(SHOW_ALL)
    browser.evaluate(pause)
    image = browser.call("Page.captureScreenshot", format="png")["data"]
    return base64.b64decode(image)


def main() -> None:
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
            PICTURE.write_bytes(capture(address, folder))
    finally:
        demo.terminate()
        demo.wait()


if __name__ == "__main__":
    main()
