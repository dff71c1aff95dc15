"""A publisher and a subscription on a network that drops what it is told to."""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from transport_benches import ZenohPair, message_of, until

from navette.msgs.std_msgs.msg import String
from navette.transports import (
    Endpoint,
    EndpointKind,
    EndpointQos,
    Item,
    TransportObserver,
)
from navette.transports.zenoh import ZenohTransport
from navette.transports.zenoh.recovery import hub, starts

DEPTH = 20
QOS = EndpointQos(depth=DEPTH)


@contextmanager
def hurried_pair(monkeypatch: pytest.MonkeyPatch) -> Iterator[ZenohPair]:
    """Two sessions whose seconds are short; a first letter is waited for as long."""
    monkeypatch.setattr(hub, "_TICK_S", 0.02)
    monkeypatch.setattr(starts, "_LETTER_TICKS", 1000)
    monkeypatch.setattr(starts, "_TOKEN_TICKS", 1000)
    pair = ZenohPair()
    yield pair
    pair.close()


class Speaker:
    """A publisher at the far end, on a network that drops what it is told to."""

    def __init__(self, pair: ZenohPair, qos: EndpointQos = QOS) -> None:
        end = topic_end(EndpointKind.PUBLISHER, qos)
        self.port: Any = pair.far_zenoh.advertise(end, String)
        self._put = self.port._put
        self.number = 0
        self.puts = 0

    def say(self, count: int, *, drop: Iterable[int] = ()) -> None:
        """Publish the next ``count`` numbers; those of ``drop`` do not arrive."""
        dropped = set(drop)
        for _ in range(count):
            self.number += 1
            self.port._put = self._drop if self.number in dropped else self._carry
            self.port.send(String(data=str(self.number)), 0, self.number)

    def _carry(self, data: Any, attachment: bytes) -> None:
        self.puts += 1
        self._put(data, attachment=attachment)

    def _drop(self, data: Any, attachment: bytes) -> None:
        self.puts += 1


class Ear(TransportObserver):
    """A subscription at the near end."""

    def __init__(self, pair: ZenohPair, qos: EndpointQos = QOS) -> None:
        self.items: list[Item] = []
        self.lost = 0
        pair.near.observe(self)
        self.endpoint = topic_end(EndpointKind.SUBSCRIPTION, qos)
        self.port: Any = pair.near_zenoh.subscribe(
            self.endpoint, String, self.items.append, shared=False
        )

    def message_lost(self, subscription: Endpoint, count: int) -> None:
        if subscription is self.endpoint:
            self.lost += count

    @property
    def numbers(self) -> list[int]:
        return [int(message_of(item).data) for item in self.items]

    def await_loss(self, count: int) -> None:
        """It is told after what comes then has been delivered."""
        until(lambda: self.lost >= count, f"{count} lost")
        assert self.lost == count

    def await_(self, *numbers: int) -> None:
        until(lambda: len(self.items) >= len(numbers), f"samples {numbers}")
        assert self.numbers == list(numbers)


def topic_end(kind: EndpointKind, qos: EndpointQos) -> Endpoint:
    return Endpoint(kind, "/t", "std_msgs/msg/String", qos, "n", "/", b"")


def acquaint(pair: ZenohPair, speaker: Speaker, *ears: Ear) -> None:
    """Wait until these know from where on they are owed something, and by whom."""
    pair.settle()
    gid = speaker.port._gid
    until(lambda: all(gid in e.port.arrivals._lanes for e in ears), "the first letter")


def part(transport: ZenohTransport) -> list[str]:
    """What the loss of a link is for one end: all tokens are gone."""
    graph = transport.session.graph
    keys = [*graph._nodes, *graph._endpoints]
    graph.on_tokens((key, False) for key in keys)
    return keys


def meet(transport: ZenohTransport, keys: list[str]) -> None:
    """The link is back."""
    transport.session.graph.on_tokens((key, True) for key in keys)


def mute(pair: ZenohPair, monkeypatch: pytest.MonkeyPatch) -> None:
    """The near end's asks get no answer, ever."""
    recovery = pair.near_zenoh._recovery
    assert recovery is not None
    monkeypatch.setattr(recovery.wants, "_get", lambda *_: None)
