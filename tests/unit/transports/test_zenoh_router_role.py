"""Taking over from a lost router, and the end of doing so."""

import threading
from typing import Any

import zenoh

from navette.transports.zenoh.router import RouterRole, alone
from navette.transports.zenoh.settings import Settings


class Role(RouterRole):
    """Counts the searches for a router instead of searching."""

    def __init__(self) -> None:
        super().__init__(Settings())
        self.searches = 0
        self.has_searched = threading.Event()

    def find_or_serve(self) -> None:
        self.searches += 1
        self.has_searched.set()

    def begin(self) -> threading.Thread:
        session: Any = NoSession()
        self.watch(session)
        assert self._thread is not None
        return self._thread

    def lose(self) -> None:
        self._lost.set()


class NoSession:
    """Stands in for Zenoh's session; reports no events."""

    @property
    def info(self) -> "NoSession":
        return self

    def declare_transport_events_listener(
        self, handler: zenoh.handlers.Callback
    ) -> None:
        return


class CloseDuringLoss(threading.Event):
    """Lets the process close while the loss of its router is being handled."""

    def __init__(self, role: Role) -> None:
        super().__init__()
        self._role = role

    def clear(self) -> None:
        self._role.stop_watching()
        super().clear()


def test_a_close_during_the_loss_of_the_router_ends_the_thread() -> None:
    """At the end of a lock-step all processes close, also the one with the router."""
    role = Role()
    role._lost = CloseDuringLoss(role)
    thread = role.begin()
    role.lose()
    thread.join(60.0)
    assert not thread.is_alive()
    role.close()
    assert role.searches == 0


def test_each_loss_of_the_router_starts_a_search_until_the_close() -> None:
    role = Role()
    role.begin()
    for count in (1, 2):
        role.lose()
        assert role.has_searched.wait(60.0)
        role.has_searched.clear()
        assert role.searches == count
    role.close()
    assert role.searches == 2


def test_the_warning_names_why_there_is_no_router() -> None:
    far = "tls/192.0.2.7:7447"
    cannot = f"{far}: Can not bind: Cannot assign requested address (os error 99)"
    assert "on another machine: the machine is off" in alone([far], [cannot])
    assert "none can be started: no key" in alone([far], ["no key"])
