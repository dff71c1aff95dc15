"""The Zenoh session of a process: opened, discovery completed, closed."""

import atexit
import contextlib
import os
import threading
import weakref
from typing import Any

import zenoh

from navette.transports.shutdown import wait_for_at_end
from navette.transports.zenoh.config import peer_config
from navette.transports.zenoh.graph import RemoteGraph
from navette.transports.zenoh.last_received import LastReceived
from navette.transports.zenoh.log_once import LogOnce
from navette.transports.zenoh.router import RouterRole, refuse
from navette.transports.zenoh.session_id import new_session_id
from navette.transports.zenoh.settings import Settings
from navette.transports.zenoh.shared_memory import SharedPools
from navette.transports.zenoh.threads import provide_threads
from navette.transports.zenoh.tokens import SPACE

# The session waits so often and so long for tokens in the router's graph; their process
# may be closing, or out of reach.
_DISCOVERY_ATTEMPTS = 4
_DISCOVERY_S = 0.25
_QUERY_S = 2.0
# Closing waits for links that are being opened, also to a stopped process (Ctrl-Z).
_CLOSE_S = 1.5
# Unread tokens; a session that declares more at once waits for the reader.
_CHANNEL_SIZE = 10_000
_MIN_PAUSE_S, _MAX_PAUSE_S = 0.002, 0.128
_PAUSE_GROWTH = 4

_open: "weakref.WeakSet[ZenohSession]" = weakref.WeakSet()


class ZenohSession:
    """A peer on the network, and the router if there was none.

    Args:
        domain_id: the domain whose nodes are discovered.

    Raises:
        NetworkError: the network cannot be joined; names endpoints and reason.
    """

    def __init__(self, settings: Settings, domain_id: int) -> None:
        self.settings = settings
        self.log_once = LogOnce()
        self.last_received = LastReceived()
        self.shared_pools = SharedPools()
        self._tokens = f"{SPACE}/{domain_id}/**"
        self._role = RouterRole(settings)
        self._closing = threading.Event()
        self._reader = threading.Thread(
            target=self._read, name="navette-graph", daemon=True
        )
        provide_threads(settings)
        router = self._role.find_or_serve()
        try:
            self.zenoh = zenoh.open(peer_config(settings, new_session_id()))
        except zenoh.ZError as error:
            self._role.close()
            raise refuse(settings, error) from error
        _open.add(self)  # at once: Ctrl-C may raise in the next line
        self.zid = str(self.zenoh.zid())
        self.graph = RemoteGraph(self.zid, self.log_once)
        # A channel, because a callback would run in the thread that declares a token
        # here, and would swallow a Ctrl-C that arrives in it.
        self._samples: Any = self.zenoh.liveliness().declare_subscriber(
            self._tokens, zenoh.handlers.FifoChannel(_CHANNEL_SIZE), history=True
        )
        wait_for_at_end(self._reader)
        self._reader.start()
        self._role.watch(self.zenoh)
        if router is not None:
            self._complete_discovery(router)
            router.close()

    @property
    def serves_as_router(self) -> bool:
        return self._role.is_serving

    def close(self) -> None:
        """Leave the network; may be called again."""
        self._closing.set()
        self._role.stop_watching()
        if not self.zenoh.is_closed():
            closer = threading.Thread(target=self._close, daemon=True)
            wait_for_at_end(closer)
            closer.start()
            closer.join(_CLOSE_S)
        if self._reader.is_alive() and self._reader is not threading.current_thread():
            self._reader.join(_CLOSE_S)
        self._role.close()
        _open.discard(self)  # last: a close that Ctrl-C interrupts is completed at exit

    def _close(self) -> None:
        # Zenoh reports an error when it stops waiting for a link; nothing is lost.
        with contextlib.suppress(zenoh.ZError):
            self.zenoh.close()

    def _read(self) -> None:
        """Pass tokens to the graph until the session is closed.

        A token that follows a quiet period is passed at once. Then the reader pauses
        and passes the tokens of the pause together, because each batch switches threads
        twice: here and in the threads that wait for the graph. Pauses grow while
        several tokens arrive at once, and halve while none arrive.
        """
        pause_s = 0.0
        while True:
            try:
                samples = self._waiting(is_blocking=pause_s <= _MIN_PAUSE_S)
            except zenoh.ZError:  # closed
                return
            if samples:
                self.graph.on_tokens(map(_change, samples))
                if len(samples) > 1:
                    pause_s = min(_PAUSE_GROWTH * pause_s, _MAX_PAUSE_S)
                pause_s = max(pause_s, _MIN_PAUSE_S)
            else:
                pause_s /= 2
            self._closing.wait(pause_s)

    def _waiting(self, *, is_blocking: bool) -> list[zenoh.Sample]:
        """Return the token samples in the channel; with ``is_blocking`` one at least.

        Raises:
            zenoh.ZError: the session is closed.
        """
        samples = [self._samples.recv()] if is_blocking else []
        while (sample := self._samples.try_recv()) is not None:
            samples.append(sample)
        return samples

    def _complete_discovery(self, router: zenoh.Session) -> None:
        """Wait until all tokens in the router's graph are known here."""
        known = _listed(router, self._tokens)
        for _ in range(_DISCOVERY_ATTEMPTS):
            missing = self.graph.wait_until_known(known, _DISCOVERY_S)
            # Their sessions may have closed meanwhile: query only these again.
            sessions = {key.split("/", 3)[2] for key in missing}
            known = {
                key
                for zid in sessions
                for key in _listed(router, self._tokens.replace("**", f"{zid}/**"))
            }
            if not known:
                return


def _listed(router: zenoh.Session, tokens: str) -> set[str]:
    """Return the tokens in the router's graph."""
    replies = router.liveliness().get(tokens, timeout=_QUERY_S)
    return {str(reply.ok.key_expr) for reply in replies if reply.ok}


def _change(sample: zenoh.Sample) -> tuple[str, bool]:
    return str(sample.key_expr), sample.kind == zenoh.SampleKind.PUT


# A forked child has the sessions without their threads: closing would never end.
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_open.clear)


@atexit.register
def _close_all() -> None:
    """Close all sessions: Zenoh must not call back an interpreter that has ended."""
    for session in list(_open):
        session.close()
