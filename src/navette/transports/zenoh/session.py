"""The session of a process with the network: opened, looked around, closed."""

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
from navette.transports.zenoh.threads import provide_threads
from navette.transports.zenoh.tokens import SPACE

# Those who are there are listed when the session opens; one that is just leaving, or
# cannot be reached, is waited for this long.
_LOOKS = 4
_LOOK_S = 0.25
_ASK_S = 2.0
# Closing waits for links that are being opened, also to one that is stopped (Ctrl-Z).
_CLOSE_S = 1.5
# Tokens that wait to be read; who declares more at once waits for the reader.
_CHANNEL = 10_000
_SHORTEST_PAUSE_S, _LONGEST_PAUSE_S = 0.002, 0.128
_PAUSES_GROW = 4  # times, while tokens come in crowds

_open: "weakref.WeakSet[Session]" = weakref.WeakSet()


class Session:
    """A peer on the network, and the router where there was none.

    Args:
        domain_id: whose nodes are seen.

    Raises:
        NetworkError: says with which endpoints, and why.
    """

    def __init__(self, settings: Settings, domain_id: int) -> None:
        self.settings = settings
        self.log_once = LogOnce()
        self.last_received = LastReceived()
        self._tokens = f"{SPACE}/{domain_id}/**"
        self._role = RouterRole(settings)
        provide_threads(settings)
        router = self._role.find_or_serve()
        try:
            self.zenoh = zenoh.open(peer_config(settings, new_session_id()))
        except zenoh.ZError as error:
            self._role.close()
            raise refuse(settings, error) from error
        self.zid = str(self.zenoh.zid())
        self.graph = RemoteGraph(self.zid, self.log_once)
        # Through a channel: a callback would run in the thread that declares a token
        # here, and a Ctrl-C that came just then would be lost in it.
        self._closing = threading.Event()
        self._samples: Any = self.zenoh.liveliness().declare_subscriber(
            self._tokens, zenoh.handlers.FifoChannel(_CHANNEL), history=True
        )
        self._reader = threading.Thread(
            target=self._read, name="navette-graph", daemon=True
        )
        self._reader.start()
        wait_for_at_end(self._reader)
        self._role.watch(self.zenoh)
        if router is not None:
            self._look_around(router)
            router.close()
        _open.add(self)

    @property
    def serves_as_router(self) -> bool:
        """Whether the others find each other through this process."""
        return self._role.is_serving

    def close(self) -> None:
        """Leave the network; closing twice is harmless."""
        _open.discard(self)
        self._closing.set()
        self._role.stop_watching()
        if not self.zenoh.is_closed():
            closer = threading.Thread(target=self._close, daemon=True)
            closer.start()
            wait_for_at_end(closer)
            closer.join(_CLOSE_S)
        if self._reader is not threading.current_thread():
            self._reader.join(_CLOSE_S)
        self._role.close()

    def _close(self) -> None:
        # In the end Zenoh stops waiting for those links, too; all is said by then.
        with contextlib.suppress(zenoh.ZError):
            self.zenoh.close()

    def _read(self) -> None:
        """Take tokens as they come and go, until the session is closed.

        One that comes after a silence is taken at once, then there is a pause; those
        that come meanwhile are taken together: each time costs two changes of threads,
        here and in who waits for news of the graph. Pauses grow while several come at
        once, and halve while none do.
        """
        pause_s = 0.0
        with contextlib.suppress(zenoh.ZError):
            while True:
                first = self._samples.try_recv()
                if first is None and pause_s > _SHORTEST_PAUSE_S:
                    pause_s /= 2
                else:
                    first = first or self._samples.recv()
                    samples = self._all(first)
                    self.graph.on_tokens(map(_change, samples))
                    if len(samples) > 1:
                        pause_s = min(_PAUSES_GROW * pause_s, _LONGEST_PAUSE_S)
                    pause_s = max(pause_s, _SHORTEST_PAUSE_S)
                self._closing.wait(pause_s)

    def _all(self, first: zenoh.Sample) -> list[zenoh.Sample]:
        """It, and those that wait behind it."""
        samples = [first]
        while (more := self._samples.try_recv()) is not None:
            samples.append(more)
        return samples

    def _look_around(self, router: zenoh.Session) -> None:
        """Wait until all that the router knows of are known here."""
        known = _listed(router, self._tokens)
        for _ in range(_LOOKS):
            missing = self.graph.wait_until_known(known, _LOOK_S)
            # Those may have gone meanwhile: only of their sessions it is asked again.
            sessions = {key.split("/", 3)[2] for key in missing}
            known = {
                key
                for zid in sessions
                for key in _listed(router, self._tokens.replace("**", f"{zid}/**"))
            }
            if not known:
                return


def _listed(router: zenoh.Session, tokens: str) -> set[str]:
    """The tokens that the router knows of."""
    replies = router.liveliness().get(tokens, timeout=_ASK_S)
    return {str(reply.ok.key_expr) for reply in replies if reply.ok}


def _change(sample: zenoh.Sample) -> tuple[str, bool]:
    return str(sample.key_expr), sample.kind == zenoh.SampleKind.PUT


# A forked child has the sessions but not their threads: closing one would never end.
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_open.clear)


@atexit.register
def _close_all() -> None:
    """Zenoh's threads must not outlive the interpreter that they call back."""
    for session in list(_open):
        session.close()
