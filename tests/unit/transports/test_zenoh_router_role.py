"""Who takes over from a router that is gone, and when it stops doing so."""

import threading
from typing import Any

import zenoh

from navette.transports.zenoh.router import RouterRole, alone
from navette.transports.zenoh.settings import Settings


class Role(RouterRole):
    """Counts how often it looks for a router, instead of doing so."""

    def __init__(self) -> None:
        super().__init__(Settings())
        self.looks = 0
        self.has_looked = threading.Event()

    def find_or_serve(self) -> None:
        self.looks += 1
        self.has_looked.set()

    def begin(self) -> threading.Thread:
        session: Any = NoSession()
        self.watch(session)
        assert self._thread is not None
        return self._thread

    def lose(self) -> None:
        self._lost.set()


class NoSession:
    """In place of Zenoh's: tells of no events."""

    @property
    def info(self) -> "NoSession":
        return self

    def declare_transport_events_listener(
        self, handler: zenoh.handlers.Callback
    ) -> None:
        return


class CloseComesBetween(threading.Event):
    """The process closes just as it is being noted that its router is gone."""

    def __init__(self, role: Role) -> None:
        super().__init__()
        self._role = role

    def clear(self) -> None:
        self._role.stop_watching()
        super().clear()


def test_a_close_just_when_the_router_is_lost_ends() -> None:
    """At the end of a lock-step all leave at once, and the router is one of them."""
    role = Role()
    role._lost = CloseComesBetween(role)
    thread = role.begin()
    role.lose()
    thread.join(60.0)
    assert not thread.is_alive()
    role.close()
    assert role.looks == 0


def test_a_lost_router_is_looked_for_each_time_until_the_close() -> None:
    role = Role()
    role.begin()
    for count in (1, 2):
        role.lose()
        assert role.has_looked.wait(60.0)
        role.has_looked.clear()
        assert role.looks == count
    role.close()
    assert role.looks == 2


def test_why_one_is_alone_is_told_in_plain_words() -> None:
    far = "tls/192.0.2.7:7447"
    cannot = f"{far}: Can not bind: Cannot assign requested address (os error 99)"
    assert "on another machine: it is off, out of reach" in alone([far], [cannot])
    assert "none can start: no key" in alone([far], ["no key"])
