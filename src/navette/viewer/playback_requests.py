"""Clients' requests to a recording that is played, and reports of its state.

All methods but :meth:`PlaybackRequests.position_ns` belong to the executor's thread;
results are passed to the hub through the bridge.
"""

from functools import partial

from navette.viewer.frames import ControlPlayback
from navette.viewer.hub import Hub
from navette.viewer.playback import Playback
from navette.viewer.thread_bridge import ThreadBridge


class PlaybackRequests:
    """Executes requests of playback bars; does nothing without a recording."""

    def __init__(
        self, playback: Playback | None, hub: Hub, bridge: ThreadBridge
    ) -> None:
        self._playback = playback
        self._hub = hub
        self._bridge = bridge
        self._request_id = ""  # of the request that the next report answers

    def begin(self) -> None:
        if self._playback is not None:
            self._playback.on_change(self._report)

    def control(self, request: ControlPlayback) -> None:
        """Play, pause, seek or change the speed; all clients receive the new state."""
        if self._playback is None:
            return
        self._request_id = request.request_id
        try:
            self._playback.control(
                play=request.play, speed=request.speed, seek_ns=request.seek_ns
            )
        finally:
            if self._request_id:  # nothing changed: report the state all the same
                self._report(False)

    def step(self) -> None:
        if self._playback is not None:
            self._playback.step()

    def position_ns(self) -> int | None:
        """Position in the recording, None without one; callable from any thread."""
        return None if self._playback is None else self._playback.state().position_ns

    def _report(self, jumped: bool) -> None:
        if self._playback is not None:
            request_id, self._request_id = self._request_id, ""
            report = partial(
                self._hub.set_playback, did_seek=jumped, request_id=request_id
            )
            self._bridge.call_hub(report, self._playback.state())
