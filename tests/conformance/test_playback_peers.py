"""Playback control: frames compared with the Foxglove SDK, and the page's bar."""

import json
import shutil
import struct
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import foxglove
import foxglove.websocket
import pytest
from test_viewer_javascript import run_node

from navette.bags import BagWriter
from navette.bags.play import PlayOptions
from navette.msgs import definition_text, serialize
from navette.msgs.std_msgs.msg import String
from navette.navigation.stack.playback import BagPlayback
from navette.viewer.playback import PlaybackState, PlaybackStatus
from navette.viewer.replies import playback_state, server_info

sys.path.append(str(Path(__file__).parents[1] / "unit" / "viewer"))

from viewer_harness import Client

pytestmark = pytest.mark.long

S = 1_000_000_000
RANGE = 100 * S + 5, 160 * S + 7


class Answers(foxglove.websocket.ServerListener):
    """Responds with a state that has a number in every field."""

    def on_playback_control_request(
        self, request: foxglove.websocket.PlaybackControlRequest
    ) -> foxglove.websocket.PlaybackState:
        return foxglove.websocket.PlaybackState(
            current_time=request.seek_time or 0,
            playback_speed=request.playback_speed,
            status=foxglove.websocket.PlaybackStatus.Paused,
            did_seek=True,
            request_id=request.request_id,
        )


def test_frames_are_those_of_the_sdk() -> None:
    server = foxglove.start_server(
        host="127.0.0.1",
        port=0,
        capabilities=[foxglove.Capability.PlaybackControl],
        server_listener=Answers(),
        playback_time_range=RANGE,
    )
    try:
        with Client(f"127.0.0.1:{server.port}", "foxglove.sdk.v1") as client:
            ours = json.loads(server_info("x", "1", RANGE))
            for name in ("dataStartTime", "dataEndTime"):
                assert client.info[name] == ours[name]
            assert "playbackControl" in client.info["capabilities"]
            request = struct.pack("<BBfBQI", 3, 1, 0.5, 1, 123 * S, 2) + b"r1"
            client.socket.send(request)
            _, theirs = client.wait_for(lambda f: isinstance(f, tuple) and f[0] == 5)
    finally:
        server.stop()
    state = PlaybackState(PlaybackStatus.PAUSED, 123 * S, 0.5)
    ours = playback_state(state, did_seek=True, request_id="r1")
    assert ours[1:] == theirs


@pytest.fixture
def playing(tmp_path: Path) -> Iterator[BagPlayback]:
    """A bag of 20 s, paused at its start, under a live view."""
    path = tmp_path / "talk.mcap"
    writer = BagWriter(path)
    kind = "std_msgs/msg/String"
    channel = writer.add_channel("/chatter", kind, definition_text(kind))
    for tick in range(201):
        writer.write(channel, 50 * S + tick * S // 10, serialize(String(data="x")))
    writer.close()
    playback = BagPlayback([path], PlayOptions(paused=True), view_port=0)
    thread = threading.Thread(target=playback.run)
    thread.start()
    yield playback
    playback.stop()
    thread.join()
    playback.close()


@pytest.mark.slow
def test_the_page_controls_a_recording(playing: BagPlayback) -> None:
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None:
        pytest.skip("Chromium is not installed")
    assert playing.url is not None
    seen = run_node("playback.mjs", playing.url, chromium)
    assert seen["problems"] == []
    assert seen["length"] == 20.0
    assert 14.0 < seen["paused"][0] < 20.0
    assert seen["ended"] == [20.0, 20.0]
    assert seen["again"][0] < 5.0
    assert seen["rate"] == "1"
