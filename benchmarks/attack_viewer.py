"""Attack the live view of a driving robot, and measure what the robot notices.

    python benchmarks/attack_viewer.py [--only TEXT] [--seconds S] [--json]

Starts a simulation with its live view in one process (the robot drives all the time),
then runs one attack after the other from other processes. For each attack the table
shows, over its duration, the real-time factor (1 without an attack), the longest wall
time between two messages on /odom/filtered (nominal 0.1 s divided by the factor), the
longest time that the program did not run a 100 Hz timer, the peak memory of the
process above that before the attack, and whether a second, well-behaved client still
received a reply.
"""

import argparse
import json
import multiprocessing
import os
import random
import socket
import struct
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing, suppress
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any

GOALS = ((-6.0, -12.0), (6.0, -12.0), (12.0, 0.0), (-6.0, 0.0))
TEXT, BINARY, CONTINUATION, PING = 1, 2, 0, 9
TIMEOUT_S = 5.0  # of a client that sends


# -- the robot's process ---------------------------------------------------------------


def serve() -> None:
    """Run the simulation; print its port, then one report per line of input."""
    from navette.msgs.nav_msgs.msg import Odometry
    from navette.navigation.stack.options import RunOptions
    from navette.navigation.stack.simulation import Simulation
    from navette.runtime import Node

    simulation = Simulation(RunOptions(world="course", port=0, goals=GOALS * 50))
    odometry, timer = _Gaps(), _Gaps()
    probe = Node("probe", context=simulation.context)
    probe.create_subscription(Odometry, "/odom/filtered", lambda _: odometry.note(), 10)
    probe.create_timer(0.01, timer.note)
    simulation.executor.add_node(probe)
    viewer = simulation.viewer
    assert viewer is not None
    print(viewer.port, flush=True)

    def report() -> None:
        for _ in sys.stdin:
            now_s = simulation.context.clock.now_ns / 1e9
            figures = {
                "sim_s": now_s,
                "wall_s": time.monotonic(),
                "odometry_gap_s": odometry.take(),
                "timer_gap_s": timer.take(),
                "memory_mb": _memory_mb(),
                "threads": threading.active_count(),
                "files": len(list(Path("/proc/self/fd").iterdir())),
            }
            print(json.dumps(figures), flush=True)
        os._exit(0)

    threading.Thread(target=report, daemon=True).start()
    simulation.run()


class _Gaps:
    """The longest wall time between two calls."""

    def __init__(self) -> None:
        self._last_s: float | None = None
        self._longest_s = 0.0

    def note(self) -> None:
        now_s = time.monotonic()
        if self._last_s is not None:
            self._longest_s = max(self._longest_s, now_s - self._last_s)
        self._last_s = now_s

    def take(self) -> float:
        """Return the longest gap so far, the present one included, and reset it."""
        now_s = time.monotonic()
        longest_s = max(self._longest_s, now_s - (self._last_s or now_s))
        self._longest_s = 0.0
        return longest_s


def _memory_mb() -> float:
    pages = Path("/proc/self/statm").read_text().split()[1]
    return int(pages) * os.sysconf("SC_PAGE_SIZE") / 2**20


# -- clients ---------------------------------------------------------------------------


class Wire:
    """A WebSocket client without rules of its own: sends any bytes."""

    def __init__(self, port: int, *, reads: bool = True) -> None:
        self._socket = socket.create_connection(("127.0.0.1", port), timeout=TIMEOUT_S)
        try:
            self._open(port)
        except OSError:
            self._socket.close()
            raise
        if reads:
            threading.Thread(target=self._read, daemon=True).start()

    def _open(self, port: int) -> None:
        self._socket.sendall(handshake(port))
        head = b""
        while b"\r\n\r\n" not in head:
            received = self._socket.recv(1 << 16)
            if not received:
                raise ConnectionError("refused")
            head += received
        if b" 101 " not in head.split(b"\r\n")[0]:
            raise ConnectionError(head.split(b"\r\n")[0].decode())

    def send_raw(self, data: bytes) -> None:
        self._socket.sendall(data)

    def text(self, **document: Any) -> None:
        self.send_raw(text_frame(document))

    def close(self) -> None:
        self._socket.close()

    def _read(self) -> None:
        with suppress(OSError):
            while self._socket.recv(1 << 20):
                pass


def _tcp(port: int) -> socket.socket:
    return socket.create_connection(("127.0.0.1", port), timeout=TIMEOUT_S)


def handshake(port: int) -> bytes:
    return (
        f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\n"
        "Connection: Upgrade\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
        "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Protocol: foxglove.sdk.v1\r\n"
        "\r\n"
    ).encode()


def frame(opcode: int, data: bytes, *, fin: bool = True, bits: int = 0) -> bytes:
    """A masked frame (RFC 6455, 5.2); a mask of zeros changes nothing."""
    first = opcode | bits | (0x80 if fin else 0)
    if len(data) < 126:
        head = struct.pack(">BB", first, 0x80 | len(data))
    elif len(data) < 1 << 16:
        head = struct.pack(">BBH", first, 0x80 | 126, len(data))
    else:
        head = struct.pack(">BBQ", first, 0x80 | 127, len(data))
    return head + bytes(4) + data


def text_frame(document: Any) -> bytes:
    return frame(TEXT, json.dumps(document, separators=(",", ":")).encode())


# -- attacks ---------------------------------------------------------------------------

Attack = Callable[[int, random.Random], Iterator[None]]
"""Given a port, sends until it is stopped; yields between two sends."""

ATTACKS: dict[str, Attack] = {}
LARGE, SMALL = 15_000_000, 60_000  # bytes


def attack(name: str) -> Callable[[Attack], Attack]:
    def register(function: Attack) -> Attack:
        ATTACKS[name] = function
        return function

    return register


def _flood(make: Callable[[], bytes], *, reads: bool = True) -> Attack:
    """Send the same bytes again and again, and reconnect when the server refuses."""

    def run(port: int, _random: random.Random) -> Iterator[None]:
        data = make()
        while True:
            try:
                with closing(Wire(port, reads=reads)) as wire:
                    while True:
                        wire.send_raw(data)
                        yield
            except OSError:
                time.sleep(0.01)
                yield

    return run


def _list(item: Any, size: int) -> list[Any]:
    return [item] * (size // (len(json.dumps(item, separators=(",", ":"))) + 1))


#: Each operation with the name and an entry of its list.
_LISTS: dict[str, tuple[str, Any]] = {
    "subscribe": ("subscriptions", {"id": 1, "channelId": 1}),
    "unsubscribe": ("subscriptionIds", 1),
    "advertise": (
        "channels",
        {"id": 1, "topic": "/a", "encoding": "json", "schemaName": "a/msg/B"},
    ),
    "unadvertise": ("channelIds", 1),
    "getParameters": ("parameterNames", "/a"),
    "setParameters": ("parameters", {"name": "/planner.x", "value": 1}),
    "subscribeParameterUpdates": ("parameterNames", "/a.b"),
}


def _request(operation: str, size: int) -> bytes:
    name, item = _LISTS[operation]
    return text_frame({"op": operation, name: _list(item, size)})


def _large_request(operation: str) -> bytes:
    return _request(operation, LARGE)


for _operation in _LISTS:
    ATTACKS[f"15 MB {_operation}"] = _flood(partial(_large_request, _operation))
    ATTACKS[f"60 kB {_operation}, flood"] = _flood(
        partial(_request, _operation, 60_000)
    )

_GET_ALL = {"op": "getParameters", "parameterNames": [], "id": "a"}
_ASSET = {"op": "fetchAsset", "uri": "package://navette/" + "a/" * 99, "requestId": 1}


def _graph() -> bytes:
    operations = ("subscribeConnectionGraph", "unsubscribeConnectionGraph")
    return b"".join(text_frame({"op": each}) for each in operations) * 100


def _random_binary() -> bytes:
    frames = (random.Random(i).randbytes(i) for i in range(1, 200))
    return b"".join(frame(BINARY, each) for each in frames)


def _fragments(first: bytes, more: bytes) -> bytes:
    begin = frame(TEXT, first, fin=False)
    return begin + frame(CONTINUATION, more, fin=False) * 10_000


ATTACKS |= {
    "15 MB of [": _flood(lambda: frame(TEXT, b"[" * LARGE)),
    "60 kB of [], flood": _flood(lambda: frame(TEXT, b"[" + b"[]," * 20_000 + b"1]")),
    "60 kB of digits, flood": _flood(lambda: frame(TEXT, b"1" * 60_000)),
    "random text, flood": _flood(lambda: frame(TEXT, b"\xc3\xa4{" * 20)),
    "random binary, flood": _flood(_random_binary),
    "service calls, flood": _flood(
        lambda: frame(BINARY, struct.pack("<BIII", 2, 1, 1, 4) + b"json{}") * 200
    ),
    "assets, flood": _flood(lambda: text_frame(_ASSET) * 100),
    "graph, flood": _flood(_graph),
    "nodes, flood": _flood(lambda: text_frame({"op": "subscribeNodes"}) * 100),
    "all parameters, flood": _flood(lambda: text_frame(_GET_ALL) * 100),
    "all parameters, never read": _flood(
        lambda: text_frame(_GET_ALL) * 100, reads=False
    ),
    "nonsense, never read": _flood(lambda: text_frame({"op": "?"}) * 1000, reads=False),
    "playback control, flood": _flood(
        lambda: frame(BINARY, struct.pack("<BBfBQI", 3, 0, 1.0, 1, 5, 0)) * 200
    ),
    "pings, flood": _flood(lambda: frame(PING, b"p" * 125) * 1000),
    "pings, never read": _flood(lambda: frame(PING, b"p" * 125) * 1000, reads=False),
    "tiny fragments": _flood(lambda: _fragments(b"a", b"a")),
    "empty fragments": _flood(lambda: _fragments(b"", b"")),
    "fragments without a beginning": _flood(
        lambda: frame(CONTINUATION, b"", fin=False) * 10_000
    ),
    "compressed bomb": _flood(lambda: frame(TEXT, b"\0" * 60_000, bits=0x40)),
    "16 MB binary, flood": _flood(lambda: frame(BINARY, b"\1" + bytes(16_000_000))),
}


def _publishing(
    topic: str, schema: str, encoding: str, make: Callable[[], bytes]
) -> Attack:
    channel = {"id": 1, "topic": topic, "encoding": encoding, "schemaName": schema}

    def publications() -> bytes:
        opening = text_frame({"op": "advertise", "channels": [channel]})
        return opening + frame(BINARY, struct.pack("<BI", 1, 1) + make()) * 2

    return _flood(publications)


def _cdr_path(size: int) -> bytes:
    """Return a path whose poses have 72 bytes each."""
    from navette.msgs import serialize
    from navette.msgs.geometry_msgs.msg import PoseStamped
    from navette.msgs.nav_msgs.msg import Path as PathMessage

    two, three = (serialize(PathMessage(poses=[PoseStamped()] * n)) for n in (2, 3))
    count = size // 72
    data = bytearray(two + three[len(two) :] * (count - 2))
    struct.pack_into("<I", data, 20, count)
    return bytes(data)


def _json_array() -> bytes:
    return json.dumps({"data": [0] * 20_000}, separators=(",", ":")).encode()


_ARRAY = "std_msgs/msg/Float64MultiArray"
ATTACKS["published strings, flood"] = _publishing(
    "/noise", "std_msgs/msg/String", "json", lambda: b'{"data": "a"}'
)
ATTACKS["published 60 kB JSON, flood"] = _publishing(
    "/noise", _ARRAY, "json", _json_array
)
for _name, _size in (("60 kB", 60_000), ("1 MB", 10**6), ("4 MB", 4 * 10**6)):
    ATTACKS[f"published {_name} paths, flood"] = _publishing(
        "/noise", "nav_msgs/msg/Path", "cdr", partial(_cdr_path, _size)
    )


@attack("new topics, flood")
def new_topics(port: int, generator: random.Random) -> Iterator[None]:
    while True:
        try:
            with closing(Wire(port)) as wire:
                while True:
                    name = f"/t{generator.getrandbits(60)}"
                    channel = {"id": 1, "topic": name, "encoding": "json",
                               "schemaName": "std_msgs/msg/String"}  # fmt: skip
                    wire.text(op="advertise", channels=[channel])
                    wire.text(op="unadvertise", channelIds=[1])
                    yield
        except OSError:
            time.sleep(0.01)
            yield


@attack("subscribe and unsubscribe, flood")
def subscriptions(port: int, _random: random.Random) -> Iterator[None]:
    every = [{"id": i, "channelId": i} for i in range(1, 100)]
    data = text_frame({"op": "subscribe", "subscriptions": every}) + text_frame(
        {"op": "unsubscribe", "subscriptionIds": list(range(1, 100))}
    )
    yield from _flood(lambda: data)(port, _random)


@attack("subscribed to everything, never reads")
def non_readers(port: int, _random: random.Random) -> Iterator[None]:
    every = [{"id": i, "channelId": i} for i in range(1, 100)]
    with ExitStack() as stack:
        for _ in range(20):
            with suppress(OSError):
                wire = stack.enter_context(closing(Wire(port, reads=False)))
                wire.text(op="subscribe", subscriptions=every)
            yield
        while True:
            time.sleep(0.1)
            yield


@attack("connect and disconnect, storm")
def storm(port: int, _random: random.Random) -> Iterator[None]:
    while True:
        with suppress(OSError):
            Wire(port, reads=False).close()
        yield


@attack("TCP connections, storm")
def tcp_storm(port: int, _random: random.Random) -> Iterator[None]:
    while True:
        with suppress(OSError):
            socket.create_connection(("127.0.0.1", port), timeout=1.0).close()
        yield


@attack("slow HTTP requests (slowloris)")
def slowloris(port: int, _random: random.Random) -> Iterator[None]:
    with ExitStack() as stack:
        opened: list[socket.socket] = []
        while True:
            try:
                address = ("127.0.0.1", port)
                opened.append(socket.create_connection(address, timeout=0.2))
                stack.enter_context(opened[-1])
                opened[-1].sendall(b"GET / HTTP/1.1\r\nX: ")
            except OSError:
                time.sleep(0.01)
            for each in opened[-50:]:
                with suppress(OSError):
                    each.sendall(b"a")
            yield


@attack("HTTP requests, flood")
def http_flood(port: int, generator: random.Random) -> Iterator[None]:
    paths = ("/", "/layout.json", "/health", "/view.js", "/nothing")
    while True:
        with suppress(OSError):
            request = f"GET {generator.choice(paths)} HTTP/1.1\r\nHost: localhost\r\n"
            with _tcp(port) as client:
                client.sendall(f"{request}\r\n".encode())
                while client.recv(1 << 16):
                    pass
        yield


@attack("HTTP headers of 1 MB, flood")
def http_headers(port: int, _random: random.Random) -> Iterator[None]:
    head = b"GET / HTTP/1.1\r\n" + (b"X: " + b"a" * 8000 + b"\r\n") * 127
    while True:
        with suppress(OSError), _tcp(port) as client:
            client.sendall(head + b"\r\n")
            client.recv(1 << 16)
        yield


@attack("random bytes instead of HTTP")
def garbage(port: int, generator: random.Random) -> Iterator[None]:
    while True:
        with suppress(OSError), _tcp(port) as client:
            client.sendall(generator.randbytes(generator.randrange(1, 5000)))
        yield


@attack("random WebSocket frames")
def random_frames(port: int, generator: random.Random) -> Iterator[None]:
    while True:
        with suppress(OSError), closing(Wire(port)) as wire:
            while True:
                wire.send_raw(generator.randbytes(generator.randrange(1, 2000)))
                yield
        yield


def run_attack(name: str, port: int, seed: int, seconds: float) -> None:
    """Attack with several connections from this process."""
    end_s = time.monotonic() + seconds

    def work(index: int) -> None:
        for _ in ATTACKS[name](port, random.Random(seed * 100 + index)):
            if time.monotonic() > end_s:
                return

    for index in range(4):
        threading.Thread(target=work, args=(index,), daemon=True).start()
    time.sleep(seconds)
    os._exit(0)


# -- figures ---------------------------------------------------------------------------


@dataclass(frozen=True)
class Result:
    """What the robot noticed of one attack."""

    name: str
    real_time_factor: float
    odometry_gap_s: float
    timer_gap_s: float
    memory_mb: float
    reply_s: float | None


class Target:
    """The robot's process."""

    def __init__(self) -> None:
        self._process = subprocess.Popen(
            [sys.executable, __file__, "--serve"],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
        )  # fmt: skip
        assert self._process.stdout is not None
        self.port = int(self._process.stdout.readline())

    def report(self) -> dict[str, Any]:
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write("\n")
        self._process.stdin.flush()
        report: dict[str, Any] = json.loads(self._process.stdout.readline())
        return report

    def close(self) -> None:
        assert self._process.stdin is not None
        self._process.stdin.close()
        self._process.wait()


def measure(target: Target, name: str, seconds: float) -> Result:
    before = target.report()
    attacker = multiprocessing.get_context("fork").Process(
        target=run_attack, args=(name, target.port, 1, seconds)
    )
    if name in ATTACKS:
        attacker.start()
    time.sleep(seconds * 0.75)
    reply_s = reply_time_s(target.port)
    after = target.report()
    if name in ATTACKS:
        attacker.join()
    return Result(
        name,
        (after["sim_s"] - before["sim_s"]) / (after["wall_s"] - before["wall_s"]),
        after["odometry_gap_s"],
        after["timer_gap_s"],
        after["memory_mb"] - before["memory_mb"],
        reply_s,
    )


def reply_time_s(port: int) -> float | None:
    """Return how long a new client waits for a parameter's value."""
    from websockets.exceptions import WebSocketException
    from websockets.sync.client import connect
    from websockets.typing import Subprotocol

    begin_s = time.monotonic()
    name = "/planner.goal_tolerance_m"
    try:
        with connect(
            f"ws://127.0.0.1:{port}", subprotocols=[Subprotocol("foxglove.sdk.v1")],
            open_timeout=5.0, close_timeout=0.1,
        ) as client:  # fmt: skip
            client.send(
                json.dumps({"op": "getParameters", "parameterNames": [name], "id": "a"})
            )
            while "parameterValues" not in str(client.recv(timeout=5.0))[:40]:
                pass
    except (OSError, TimeoutError, WebSocketException):
        return None
    return time.monotonic() - begin_s


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", default="", help="attacks whose name has this")
    parser.add_argument("--seconds", type=float, default=6.0, help="of each attack")
    parser.add_argument("--json", action="store_true", help="one JSON object per line")
    parser.add_argument("--serve", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.serve:
        serve()
        return
    names = ["no attack", *(name for name in ATTACKS if options.only in name)]
    target = Target()
    time.sleep(3.0)
    target.report()
    if not options.json:
        print(f"{'attack':<40} {'factor':>6} {'odom gap':>9} {'timer gap':>9} "
              f"{'memory':>9} {'reply':>8}")  # fmt: skip
    try:
        for name in names:
            result = measure(target, name, options.seconds)
            print(json.dumps(asdict(result)) if options.json else row(result))
            sys.stdout.flush()
            time.sleep(1.0)
            target.report()
    finally:
        target.close()


def row(result: Result) -> str:
    reply = "none" if result.reply_s is None else f"{result.reply_s * 1e3:.0f} ms"
    return (
        f"{result.name:<40} {result.real_time_factor:6.2f} "
        f"{result.odometry_gap_s:7.3f} s {result.timer_gap_s:7.3f} s "
        f"{result.memory_mb:+6.0f} MB {reply:>8}"
    )


if __name__ == "__main__":
    main()
