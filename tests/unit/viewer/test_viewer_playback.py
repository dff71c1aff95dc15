"""Playback of a recording: state reports and client requests."""

import json
import struct
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from viewer_fakes import DirectCommands, RecordingProgram, sent
from viewer_harness import Client, Program

from navette.errors import DecodeError, InvalidValueError
from navette.viewer.frames import ControlPlayback, decode
from navette.viewer.hub import Hub
from navette.viewer.outbox import Outbox
from navette.viewer.playback import PlaybackState, PlaybackStatus
from navette.viewer.replies import playback_state
from navette.viewer.session import Topic

S = 1_000_000_000
RANGE = 100 * S + 5, 160 * S


def request(
    command: int = 0, speed: float = 1.0, seek_ns: int | None = None, name: str = "r1"
) -> bytes:
    """As the Foxglove SDK writes it (playback_control_request.rs)."""
    head = struct.pack("<BBfB", 3, command, speed, seek_ns is not None)
    return head + struct.pack("<QI", seek_ns or 0, len(name)) + name.encode()


def read_state(frame: bytes) -> tuple[int, int, float, bool, str]:
    """Status, place, speed, whether it is a jump, request id (playback_state.rs)."""
    opcode, status, place, speed, jumped, length = struct.unpack_from("<BBQfBI", frame)
    assert opcode == 5
    assert len(frame) == 19 + length
    return status, place, speed, bool(jumped), frame[19:].decode()


def test_requests_are_decoded() -> None:
    assert decode(request()) == ControlPlayback(True, 1.0, None, "r1")
    assert decode(request(1, 0.5, 7, "x")) == ControlPlayback(False, 0.5, 7, "x")


@pytest.mark.parametrize(
    "frame", [b"\x03", request()[:-1], request(2), request()[:15] + b"\xff\xff\xff\xff"]
)
def test_bad_requests_are_named(frame: bytes) -> None:
    with pytest.raises(DecodeError, match="playback"):
        decode(frame)


def test_states_have_the_published_form() -> None:
    state = PlaybackState(PlaybackStatus.PAUSED, 123, 0.5)
    frame = playback_state(state, did_seek=True, request_id="r7")
    assert read_state(frame) == (1, 123, 0.5, True, "r7")


def hub_of(playback_range: tuple[int, int] | None) -> tuple[Hub, RecordingProgram]:
    program = RecordingProgram()
    hub = Hub(
        program,
        DirectCommands(),
        name="t",
        session_id="1",
        playback_range=playback_range,
    )
    return hub, program


def test_playback_control_is_declared_only_with_a_recording() -> None:
    for playback_range in (None, RANGE):
        hub, _ = hub_of(playback_range)
        info = json.loads(hub.join(Outbox()).outbox.pop())
        assert ("playbackControl" in info["capabilities"]) is bool(playback_range)
        assert ("dataStartTime" in info) is bool(playback_range)
    assert info["dataStartTime"] == {"sec": 100, "nsec": 5}
    assert info["dataEndTime"] == {"sec": 160, "nsec": 0}


def test_requests_reach_the_program_or_are_refused() -> None:
    hub, program = hub_of(RANGE)
    session = hub.join(Outbox())
    hub.receive(session, request(1, 2.0, 9))
    hub.receive(session, '{"op": "stepPlayback"}')
    assert program.take() == [
        ("playback", session.id, ControlPlayback(False, 2.0, 9, "r1")),
        ("step", session.id),
    ]
    assert session.pending == 2
    hub, program = hub_of(None)
    session = hub.join(Outbox())
    sent(session.outbox)
    hub.receive(session, request())
    assert program.take() == []
    assert "does not play a recording" in sent(session.outbox)[0]["message"]


def test_all_clients_receive_changes_and_new_clients_the_last() -> None:
    hub, _ = hub_of(RANGE)
    early = hub.join(Outbox())
    sent(early.outbox)
    state = PlaybackState(PlaybackStatus.PLAYING, 110 * S, 2.0)
    hub.set_playback(state, did_seek=True, request_id="r1")
    assert read_state(sent(early.outbox)[0]) == (0, 110 * S, 2.0, True, "r1")
    late = sent(hub.join(Outbox()).outbox)
    assert read_state(late[-1]) == (0, 110 * S, 2.0, False, "")


def test_a_seek_drops_queued_messages() -> None:
    hub, _ = hub_of(RANGE)
    hub.subscriptions.set_topics([Topic("/a", "std_msgs/msg/String", "string data")])
    session = hub.join(Outbox())
    pair = {"id": 1, "channelId": 1}
    hub.receive(session, json.dumps({"op": "subscribe", "subscriptions": [pair]}))
    sent(session.outbox)
    (watch,) = hub.subscriptions._watchers
    state = PlaybackState(PlaybackStatus.PLAYING, 110 * S, 1.0)
    for did_seek, wanted in ((False, 2), (True, 1)):
        hub.subscriptions.message(watch, 5, b"old")
        hub.set_playback(state, did_seek=did_seek, request_id="")
        assert len(sent(session.outbox)) == wanted


class Tape:
    """A fake recording that stores the requests."""

    begin_ns, end_ns = RANGE

    def __init__(self) -> None:
        self.asked: list[Any] = []
        self.now = PlaybackState(PlaybackStatus.PAUSED, RANGE[0], 1.0)
        self.report: Callable[[bool], None] = lambda jumped: None

    def state(self) -> PlaybackState:
        return self.now

    def control(self, *, play: bool, speed: float, seek_ns: int | None) -> None:
        if speed <= 0:
            raise InvalidValueError(f"rate {speed}: expected more")
        self.asked.append((play, speed, seek_ns))
        status = PlaybackStatus.PLAYING if play else PlaybackStatus.PAUSED
        place_ns = self.now.position_ns if seek_ns is None else seek_ns
        self.now = PlaybackState(status, place_ns, speed)
        self.report(seek_ns is not None)

    def step(self) -> None:
        self.asked.append("step")

    def on_change(self, callback: Callable[[bool], None]) -> None:
        self.report = callback


@pytest.fixture
def tape() -> Tape:
    return Tape()


@pytest.fixture
def client(tape: Tape) -> Iterator[Client]:
    with Program(playback=tape) as program, Client(program.address) as client:
        yield client


def wait_for_state(client: Client) -> tuple[int, int, float, bool, str]:
    while True:
        frame = client.socket.recv(timeout=60.0)
        if isinstance(frame, bytes) and frame[0] == 5:
            return read_state(frame)


def test_a_client_plays_seeks_and_steps(client: Client, tape: Tape) -> None:
    client.socket.send(request(0, 2.0, 120 * S, "a"))
    assert wait_for_state(client) == (0, 120 * S, 2.0, True, "a")
    client.socket.send(request(1, 2.0, None, "b"))
    assert wait_for_state(client) == (1, 120 * S, 2.0, False, "b")
    client.send(op="stepPlayback")
    client.get_parameters()  # all before it is done
    assert tape.asked == [(True, 2.0, 120 * S), (False, 2.0, None), "step"]


def test_a_refused_request_is_answered_too(client: Client, tape: Tape) -> None:
    client.socket.send(request(0, -1.0, None, "a"))
    assert wait_for_state(client) == (1, RANGE[0], 1.0, False, "a")
    assert "rate -1.0" in client.wait_for_op("status")["message"]


def test_clients_see_the_recordings_time(client: Client, tape: Tape) -> None:
    tape.now = PlaybackState(PlaybackStatus.PLAYING, 130 * S, 1.0)
    stamp = client.wait_for(lambda f: isinstance(f, tuple) and f[0] == 2)
    while stamp[1] != 130 * S:
        stamp = client.wait_for(lambda f: isinstance(f, tuple) and f[0] == 2)
