"""The router among the processes: the first one serves, and another takes over.

Peers find each other at the router and talk directly from then on; whose process ends
takes its router along. Who binds the endpoint first is the next.
"""

import logging
import threading

import zenoh

from navette.errors import NetworkError
from navette.transports.zenoh.config import (
    client_config,
    router_config,
    router_endpoints,
)
from navette.transports.zenoh.settings import Settings

_log = logging.getLogger(__name__)

# While one process binds, another may neither bind nor connect: it looks again.
_LOOKS = 20
_LOOK_S = 0.05
_PATIENCE_S = 1.5  # with one that takes calls but does not answer

# What the system says of an address that is another machine's.
_NOT_HERE = "Cannot assign requested address"


class RouterRole:
    """Serves as the router where there is none, from now on until :meth:`close`."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._router: zenoh.Session | None = None
        self._lost = threading.Event()
        self._stop = threading.Event()
        self._thread: threading.Thread | None = None

    @property
    def is_serving(self) -> bool:
        """Whether this process is the router."""
        return self._router is not None

    def find_or_serve(self) -> zenoh.Session | None:
        """A client's session with the router that is there, or that is made here.

        None if there is none and none can be made here (it is to be on another
        machine, and cannot be reached).
        """
        patience = threading.Timer(_PATIENCE_S, lambda: None)
        patience.daemon = True
        patience.start()
        for _ in range(_LOOKS):
            client = self._ask()
            if client is not None:
                patience.cancel()
                return client
            if not self._serve():
                return None
            if self._stop.wait(0.0 if self.is_serving else _LOOK_S):
                return None
            if not patience.is_alive():
                break
        _log.warning(
            "%s is taken, but who listens there does not let this process in: another "
            "program, a wrong certificate or password, links with and without TLS, or "
            "one that is stopped (Ctrl-Z)",
            ", ".join(router_endpoints(self._settings)),
        )
        return None

    def watch(self, session: zenoh.Session) -> None:
        """Take over when ``session`` loses its router."""

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
        session.info.declare_transport_events_listener(
            zenoh.handlers.Callback(on_event, indirect=False)
        )

    def stop_watching(self) -> None:
        """Take over no more: where all leave at once, nobody needs another router."""
        self._stop.set()
        self._lost.set()

    def close(self) -> None:
        """Serve no more; another process takes over."""
        self.stop_watching()
        if self._thread is not None:
            self._thread.join()
        if self._router is not None:
            self._router.close()
            self._router = None

    def _take_over(self) -> None:
        while True:
            self._lost.wait()
            # Before the look at _stop: the other way round, a close that comes between
            # the two is forgotten, and waits for this thread for ever.
            self._lost.clear()
            if self._stop.is_set():
                return
            client = self.find_or_serve()
            if client is not None:
                client.close()

    def _ask(self) -> zenoh.Session | None:
        try:
            return zenoh.open(client_config(self._settings))
        except zenoh.ZError:
            return None  # nobody answers

    def _serve(self) -> bool:
        """Try to bind; False where no endpoint is of this machine."""
        if self._router is not None:
            return True
        reasons = []
        for endpoint in router_endpoints(self._settings):
            try:
                self._router = zenoh.open(router_config(self._settings, endpoint))
            except zenoh.ZError as error:
                if "in use" in str(error):
                    return True  # by who was faster
                reasons.append(f"{endpoint}: {reason_of(error)}")
            else:
                return True
        _log.warning("%s", alone(router_endpoints(self._settings), reasons))
        return False


def alone(endpoints: list[str], reasons: list[str]) -> str:
    """Why there is no router, in the user's words; ``reasons``: of each endpoint."""
    where = ", ".join(endpoints)
    if reasons and all(_NOT_HERE in reason for reason in reasons):
        return (
            f"no router answers at {where}, on another machine: it is off, out of "
            "reach, or does not let this one in (navette doctor says which)"
        )
    return f"no router answers at {where}, and none can start: {'; '.join(reasons)}"


def reason_of(error: zenoh.ZError) -> str:
    """Zenoh's words, without the place in its source."""
    return str(error).split(" at /")[0]


def refuse(settings: Settings, error: zenoh.ZError) -> NetworkError:
    """Why the network cannot be joined, in the user's words."""
    listen = ", ".join(settings.listen)
    return NetworkError(
        f"cannot join the network (router {', '.join(router_endpoints(settings))}, "
        f"listening on {listen}): {reason_of(error)}"
    )
