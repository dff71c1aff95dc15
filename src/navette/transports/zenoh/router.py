"""The router in one of the processes; another process takes over when it ends.

Peers discover each other through the router and then communicate directly. The router
ends with its process; the process that binds the endpoint first is the next router.
"""

import logging
import threading

import zenoh

from navette.errors import NetworkError
from navette.transports.zenoh.callbacks import direct
from navette.transports.zenoh.config import (
    client_config,
    router_config,
    router_endpoints,
)
from navette.transports.zenoh.settings import Settings

_log = logging.getLogger(__name__)

# While one process binds, another can neither bind nor connect: it tries again.
_ATTEMPTS = 20
_PAUSE_S = 0.05
# The errors for a port, and for the socket of a private run.
_IN_USE = ("in use", "Unable to acquire lock")
_LIMIT_S = 1.5  # for a port that accepts links but does not respond

# The system's error for an address of another machine.
_OTHER_MACHINE = "Cannot assign requested address"


class RouterRole:
    """Serves as the router if there is none, until :meth:`close`."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._router: zenoh.Session | None = None
        self._lost = threading.Event()
        self._stop = threading.Event()
        self._thread: threading.Thread | None = None

    @property
    def is_serving(self) -> bool:
        return self._router is not None

    def find_or_serve(self) -> zenoh.Session | None:
        """Return a client session with the router, which is started if there is none.

        None if the router cannot be reached and cannot be started here, because its
        endpoint belongs to another machine.
        """
        limit = threading.Timer(_LIMIT_S, lambda: None)
        limit.daemon = True
        limit.start()
        for _ in range(_ATTEMPTS):
            client = self._connect()
            if client is not None:
                limit.cancel()
                return client
            if not self._serve():
                return None
            if self._stop.wait(0.0 if self.is_serving else _PAUSE_S):
                return None
            if not limit.is_alive():
                break
        _log.warning(
            "%s is in use, but the program there does not accept this process: it is "
            "not a router, requires another certificate or password, differs in the "
            "use of TLS, or is stopped (Ctrl-Z); navette doctor reports which",
            ", ".join(router_endpoints(self._settings)),
        )
        return None

    def watch(self, session: zenoh.Session) -> None:
        """Become the router when ``session`` loses its router."""

        def on_event(event: zenoh.TransportEvent) -> None:
            if (
                event.kind == zenoh.SampleKind.DELETE
                and event.transport.whatami == zenoh.WhatAmI.ROUTER
            ):
                self._lost.set()

        self._thread = threading.Thread(
            target=self._take_over, name="navette-router", daemon=True
        )
        self._thread.start()
        session.info.declare_transport_events_listener(direct(on_event))

    def stop_watching(self) -> None:
        """Do not take over any more; processes that end together need no new router."""
        self._stop.set()
        self._lost.set()

    def close(self) -> None:
        """Stop serving; another process takes over."""
        self.stop_watching()
        if self._thread is not None:
            self._thread.join()
        if self._router is not None:
            self._router.close()
            self._router = None

    def _take_over(self) -> None:
        while True:
            self._lost.wait()
            # Before _stop is read: in the other order, a close between the two would be
            # lost, and would wait for this thread for ever.
            self._lost.clear()
            if self._stop.is_set():
                return
            client = self.find_or_serve()
            if client is not None:
                client.close()

    def _connect(self) -> zenoh.Session | None:
        try:
            return zenoh.open(client_config(self._settings))
        except zenoh.ZError:
            return None  # no router responds

    def _serve(self) -> bool:
        """Try to bind; return False if no endpoint belongs to this machine."""
        if self._router is not None:
            return True
        reasons = []
        for endpoint in router_endpoints(self._settings):
            try:
                self._router = zenoh.open(router_config(self._settings, endpoint))
            except zenoh.ZError as error:
                if any(text in str(error) for text in _IN_USE):
                    return True  # another process was faster
                reasons.append(f"{endpoint}: {reason_of(error)}")
            else:
                return True
        _log.warning("%s", alone(router_endpoints(self._settings), reasons))
        return False


def alone(endpoints: list[str], reasons: list[str]) -> str:
    """Return why there is no router; ``reasons``: one for each endpoint."""
    where = ", ".join(endpoints)
    if reasons and all(_OTHER_MACHINE in reason for reason in reasons):
        return (
            f"no router responds at {where}, on another machine: the machine is off, "
            "cannot be reached, or does not accept this one (navette doctor reports "
            "which)"
        )
    return (
        f"no router responds at {where}, and none can be started: {'; '.join(reasons)}"
    )


def reason_of(error: zenoh.ZError) -> str:
    """Return Zenoh's message without its source location."""
    return str(error).split(" at /")[0]


def refuse(settings: Settings, error: zenoh.ZError) -> NetworkError:
    """Return the error for a network that cannot be joined."""
    listen = ", ".join(settings.listen)
    return NetworkError(
        f"cannot join the network (router {', '.join(router_endpoints(settings))}, "
        f"listening on {listen}): {reason_of(error)}"
    )
