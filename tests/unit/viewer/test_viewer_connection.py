"""Bounds of a connection: fragments, control frames, number of connections."""

import asyncio
import socket
from collections.abc import Iterator
from contextlib import ExitStack, suppress

import pytest
from viewer_fakes import DirectCommands, FakeClock
from viewer_harness import PATIENCE_S, Client, NonReadingClient, Program, raw_frame
from websockets.exceptions import ConnectionClosed

from navette.runtime import Context, Node
from navette.viewer.frames import MAX_BINARY
from navette.viewer.outbox import Outbox
from navette.viewer.peer import Peer
from navette.viewer.session import Session

TEXT, CONTINUATION, PING = 1, 0, 9


def talker(context: Context) -> Node:
    node = Node("talker", context=context)
    node.declare_parameter("depth", 3)
    return node


@pytest.fixture
def program() -> Iterator[Program]:
    with Program(talker, max_clients=4) as running:
        yield running


def is_served(program: Program) -> bool:
    with Client(program.address) as client:
        return client.get_parameters("/talker.depth") == {"/talker.depth": 3}


def test_a_message_of_endless_fragments_ends_its_connection(program: Program) -> None:
    with NonReadingClient(program.address) as client:
        client.send_raw(raw_frame(TEXT, b"", fin=False))
        client.send_raw(raw_frame(CONTINUATION, b"", fin=False) * 300)
        assert b"more than 256 fragments" in client.read_to_the_end()
    assert is_served(program)


def test_a_flood_of_pings_ends_its_connection(program: Program) -> None:
    with NonReadingClient(program.address) as client:
        client.send_raw(raw_frame(PING, b"p" * 125) * 300)
        received = client.read_to_the_end()
    assert b"too many control frames" in received
    assert received.count(b"p" * 125) < 300
    assert is_served(program)


def test_a_frame_beyond_the_limit_ends_its_connection(program: Program) -> None:
    with Client(program.address) as client:
        with suppress(ConnectionClosed):
            client.socket.send(b"\1" * (MAX_BINARY + 1))
        client.read_to_the_end()
        assert client.socket.close_code in (1009, 1006)  # 1006: reset while sending
    assert is_served(program)


def test_silent_connections_do_not_shut_clients_out(program: Program) -> None:
    """The oldest connection without a request makes room for a new one."""
    with ExitStack() as stack:
        silent = [
            stack.enter_context(
                socket.create_connection(("127.0.0.1", program.viewer.port))
            )
            for _ in range(60)
        ]
        assert is_served(program)
        silent[0].settimeout(PATIENCE_S)
        with suppress(ConnectionResetError):
            assert silent[0].recv(1) == b""


def test_requests_wait_until_the_client_reads_its_responses() -> None:
    async def run() -> None:
        session = Session(1, Outbox(), DirectCommands())
        peer = Peer(None, session, hub=None, clock=FakeClock())  # type: ignore[arg-type]
        for _ in range(3):
            session.outbox.put_control(bytes(2 * 2**20))
        waiting = asyncio.create_task(peer.admit(1))
        await asyncio.wait([waiting], timeout=0)
        session.outbox.pop()
        peer.check_pending()
        await waiting

    asyncio.run(run())


def test_requests_wait_while_many_are_unfinished() -> None:
    async def run() -> None:
        session = Session(1, Outbox(), DirectCommands())
        peer = Peer(None, session, hub=None, clock=FakeClock())  # type: ignore[arg-type]
        session.pending = 16
        waiting = asyncio.create_task(peer.admit(1))
        for _ in range(3):
            peer.check_pending()
            await asyncio.wait([waiting], timeout=0)
        assert not waiting.done()
        session.pending = 15
        peer.check_pending()
        await waiting

    asyncio.run(run())


def test_closing_does_not_wait_for_idle_connections(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Browsers open connections in advance, and send nothing on them."""
    monkeypatch.setattr("navette.viewer.server._OPEN_S", 1000.0)
    with Program(talker) as program:
        idle = socket.create_connection(("127.0.0.1", program.viewer.port))
        assert is_served(program)  # connections are accepted in order
    with idle, suppress(ConnectionResetError):
        assert idle.recv(1) == b""
