"""Pairs of transports for the conformance suites."""

import itertools
import os
import threading
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any

import zenoh

from free_ports import free_endpoint
from navette.files.runs import PrivateRun
from navette.runtime.clock import Stopwatch, VirtualClock
from navette.transports import (
    Encoded,
    Endpoint,
    Expiring,
    InProcessTransport,
    Item,
    NodeInfo,
    Transport,
    TransportObserver,
)
from navette.transports.zenoh import Settings, ZenohTransport

LIMIT_S = 60.0


def until(condition: Callable[[], bool], what: str = "the condition") -> None:
    """Wait until the condition holds; fail after a limit that only a defect reaches."""
    watch, pause = Stopwatch(), threading.Event()
    while not condition():
        assert watch.elapsed_s < LIMIT_S, f"{what} was not reached"
        pause.wait(0.001)


def zenoh_environment(router: str, **more: str) -> dict[str, str]:
    """Return the environment of a process on the network of ``router``."""
    kept = {k: v for k, v in os.environ.items() if k != "PYTEST_CURRENT_TEST"}
    return {**kept, "NAVETTE_TRANSPORT": "zenoh", "NAVETTE_ROUTER": router, **more}


def message_of(item: Item) -> Any:
    """Return the message of a delivered sample, decoded if it arrived as bytes."""
    message = item[0]
    if isinstance(message, Expiring):
        message = message.message
    return message.decode() if isinstance(message, Encoded) else message


class Pair(ABC):
    """Two ends of a network; in process both are one transport."""

    near: Transport
    far: Transport
    #: Whether lost samples of every reliable topic are sent again.
    retransmits = False

    @abstractmethod
    def settle(self) -> None:
        """Wait until everything done so far has had its effect at both ends."""

    def observe(self, observer: TransportObserver) -> None:
        """Report changes at the near end."""
        self.near.observe(observer)

    def endpoints(self) -> list[Endpoint]:
        return self.near.endpoints()

    def service_endpoints(self) -> list[Endpoint]:
        return self.near.service_endpoints()

    @abstractmethod
    def close(self) -> None: ...


class InProcessPair(Pair):
    """One transport, without delays."""

    def __init__(self) -> None:
        self.near = self.far = InProcessTransport()

    def settle(self) -> None:
        return

    def close(self) -> None:
        self.near.close()


class ZenohPair(Pair):
    """Two sessions, one of which is the router."""

    def __init__(self, **settings: Any) -> None:
        chosen = Settings(router=(free_endpoint(),), **settings)
        self.retransmits = bool(chosen.retransmit)
        self.near = self.near_zenoh = ZenohTransport(
            7, VirtualClock(5), self._of(chosen)
        )
        self.far = self.far_zenoh = ZenohTransport(7, VirtualClock(6), self._of(chosen))
        self._count = itertools.count(1)
        self._pongs: list[int] = []
        near, far = self.near_zenoh.session.zenoh, self.far_zenoh.session.zenoh
        self._ping = near.declare_publisher("fence/ping")
        self._pong = far.declare_publisher("fence/pong")
        far.declare_subscriber("fence/ping", _direct(self._on_ping))
        near.declare_subscriber("fence/pong", _direct(self._on_pong))

    def _of(self, chosen: Settings) -> Settings:
        """Return the settings of one end."""
        return chosen

    def settle(self) -> None:
        # Each link keeps the order of tokens and the order of samples: what was sent
        # before a fence has arrived before it.
        number = next(self._count)
        fences = NodeInfo(f"near_{number}", "/fence"), NodeInfo(f"far_{number}", "/f")
        self.near.announce(fences[0])
        self.far.announce(fences[1])
        until(lambda: fences[0] in self.far.remote_nodes(), "the near end's token")
        until(lambda: fences[1] in self.near.remote_nodes(), "the far end's token")
        for _ in range(2):
            ping = next(self._count)

            def has_come_back(wanted: int = ping) -> bool:
                self._ping.put(str(wanted))
                return wanted in self._pongs

            until(has_come_back, "the fence")

    def endpoints(self) -> list[Endpoint]:
        return [*self.far.endpoints(), *self.near.endpoints()]

    def service_endpoints(self) -> list[Endpoint]:
        return [*self.far.service_endpoints(), *self.near.service_endpoints()]

    def close(self) -> None:
        self.far.close()
        self.near.close()

    def _on_ping(self, sample: zenoh.Sample) -> None:
        self._pong.put(sample.payload)

    def _on_pong(self, sample: zenoh.Sample) -> None:
        self._pongs.append(int(sample.payload.to_string()))


def _direct(callback: Callable[[zenoh.Sample], None]) -> Any:
    return zenoh.handlers.Callback(callback, indirect=False)


class PrivatePair(ZenohPair):
    """Two sessions of a private run: sockets in a folder."""

    def __init__(self) -> None:
        self._run = PrivateRun.claim("pair")
        super().__init__()

    def _of(self, chosen: Settings) -> Settings:
        info = self._run.info
        return chosen.within(info.router, info.new_endpoint())

    def close(self) -> None:
        super().close()
        self._run.close()


PAIRS: dict[str, Callable[[], Pair]] = {
    "in-process": InProcessPair,
    "zenoh": ZenohPair,
    "zenoh in a private run": PrivatePair,
    "zenoh with retransmission": lambda: ZenohPair(retransmit=("*",)),
}
