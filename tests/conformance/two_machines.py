"""Two simulated machines: network namespaces with a wire between them that can fail.

Each namespace has a TUN device. A thread carries the IP packets between them with a
delay, a limited rate and a random loss, or not at all while the wire is cut.
"""

import fcntl
import heapq
import math
import os
import select
import struct
import subprocess
import threading
import time
from types import TracebackType

import numpy as np

ROBOT, LAPTOP = "10.77.0.1", "10.77.0.2"

_TUNSETIFF, _IFF_TUN, _IFF_NO_PI = 0x400454CA, 0x0001, 0x1000
_MTU = 1500
# Longest queue of a slow wire; further packets are lost, as in a router.
_MAX_QUEUE_S = 0.2


def why_not() -> str:
    """Return why namespaces cannot be created here; empty if they can."""
    try:
        with Machines():
            return ""
    except (OSError, subprocess.CalledProcessError) as error:
        return f"network namespaces are not permitted here: {error}"


def _now() -> float:
    return time.monotonic()  # noqa: TID251 - packets are late in real time


class Wire:
    """Carries packets between two TUN devices with configurable faults."""

    def __init__(self, ends: tuple[int, int], *, seed: int = 0) -> None:
        self.delay_s = 0.0
        self.loss = 0.0
        self.bytes_per_s = math.inf
        self.is_cut = False
        self.carried = self.lost = 0
        self._ends = ends
        self._free_at = [0.0, 0.0]
        self._rng = np.random.default_rng(seed)
        self._stop_read, self._stop_write = os.pipe()
        self._thread = threading.Thread(target=self._carry, name="wire")
        self._thread.start()

    def restore(self) -> None:
        """Remove all faults."""
        self.delay_s, self.loss, self.is_cut = 0.0, 0.0, False
        self.bytes_per_s = math.inf

    def close(self) -> None:
        os.write(self._stop_write, b"x")
        self._thread.join()
        os.close(self._stop_read)
        os.close(self._stop_write)

    def _carry(self) -> None:
        waiting: list[tuple[float, int, int, bytes]] = []
        number = 0
        while True:
            now = _now()
            while waiting and waiting[0][0] <= now:
                _, _, end, packet = heapq.heappop(waiting)
                os.write(end, packet)
            timeout = waiting[0][0] - now if waiting else None
            ready, _, _ = select.select([*self._ends, self._stop_read], [], [], timeout)
            if self._stop_read in ready:
                return
            for end in ready:
                packet = os.read(end, _MTU + 100)
                arrival = self._arrival(self._ends.index(end), len(packet))
                if arrival is None:
                    self.lost += 1
                    continue
                self.carried += 1
                number += 1
                other = self._ends[1 - self._ends.index(end)]
                heapq.heappush(waiting, (arrival, number, other, packet))

    def _arrival(self, direction: int, size: int) -> float | None:
        """Return the arrival time of a packet that is sent now; None: lost."""
        now = _now()
        start = max(now, self._free_at[direction])
        is_lost = self.is_cut or self._rng.random() < self.loss
        if is_lost or start - now > _MAX_QUEUE_S:
            return None
        self._free_at[direction] = start + size / self.bytes_per_s
        return self._free_at[direction] + self.delay_s


class Machines:
    """A robot and a laptop with a wire between them; ``with`` creates and removes them.

    Args:
        hasty: TCP gives up after 3 s without an acknowledgement, instead of a quarter
            of an hour. Zenoh's close of a lost link waits for that, up to 10 s
            (SO_LINGER).
    """

    def __init__(self, *, seed: int = 0, hasty: bool = False) -> None:
        self._seed = seed
        self._is_hasty = hasty
        self._names: list[str] = []
        self._devices: list[int] = []

    def __enter__(self) -> "Machines":
        try:
            tag = f"{os.getpid() % 100_000}"
            self.robot = self._make(f"nvr{tag}", ROBOT)
            self.laptop = self._make(f"nvl{tag}", LAPTOP)
            if self._is_hasty:
                for name in self._names:
                    _hurry(name)
        except BaseException:
            self._end()
            raise
        self.wire = Wire((self._devices[0], self._devices[1]), seed=self._seed)
        return self

    def __exit__(
        self,
        exc_type: type[BaseException] | None,
        exc: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.wire.close()
        self._end()

    def _make(self, name: str, address: str) -> str:
        device = os.open("/dev/net/tun", os.O_RDWR)
        self._devices.append(device)
        request = struct.pack("16sH", name.encode(), _IFF_TUN | _IFF_NO_PI)
        fcntl.ioctl(device, _TUNSETIFF, request)
        _ip("netns", "add", name)
        self._names.append(name)
        _ip("link", "set", name, "netns", name)
        _ip("-n", name, "link", "set", "lo", "up")
        _ip("-n", name, "address", "add", f"{address}/24", "dev", name)
        _ip("-n", name, "link", "set", name, "mtu", str(_MTU), "up")
        return name

    def _end(self) -> None:
        for device in self._devices:
            os.close(device)
        for name in self._names:
            _ip("netns", "delete", name)


def _hurry(name: str) -> None:
    """Shorten TCP's retries; without write access to /proc/sys tests take longer."""
    write = ["sh", "-c", "echo 3 > /proc/sys/net/ipv4/tcp_retries2"]
    words = ["ip", "netns", "exec", name, *write]
    subprocess.run(words, check=False, capture_output=True)


def _ip(*words: str) -> None:
    subprocess.run(["ip", *words], check=True, capture_output=True)
