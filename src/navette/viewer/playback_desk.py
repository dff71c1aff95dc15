"""What clients ask of a recording that is played, and are told of it.

All methods but :meth:`PlaybackDesk.position_ns` belong to the executor's thread;
answers go to the hub by its ``call``.
"""

from functools import partial

from navette.viewer.frames import ControlPlayback
from navette.viewer.hub import Hub
from navette.viewer.parameter_desk import Call
from navette.viewer.playback import Playback


class PlaybackDesk:
    """Does what playback bars ask for; without a recording, nothing."""

    def __init__(self, playback: Playback | None, hub: Hub, call: Call) -> None:
        self._playback = playback
        self._hub = hub
        self._call = call
        self._request_id = ""  # of whoever is answered by the next report

    def begin(self) -> None:
        """Report every change from now on."""
        if self._playback is not None:
            self._playback.on_change(self._report)

    def control(self, request: ControlPlayback) -> None:
        """Do what a client's playback bar asks for; all clients hear of it."""
        if self._playback is None:
            return
        self._request_id = request.request_id
        try:
            self._playback.control(
                play=request.play, speed=request.speed, seek_ns=request.seek_ns
            )
        finally:
            if self._request_id:  # nothing changed: say how it is all the same
                self._report(False)

    def step(self) -> None:
        """The recording's next message."""
        if self._playback is not None:
            self._playback.step()

    def position_ns(self) -> int | None:
        """Where the recording is, if there is one; from any thread."""
        return None if self._playback is None else self._playback.state().position_ns

    def _report(self, jumped: bool) -> None:
        if self._playback is not None:
            request_id, self._request_id = self._request_id, ""
            report = partial(
                self._hub.set_playback, did_seek=jumped, request_id=request_id
            )
            self._call(report, self._playback.state())
