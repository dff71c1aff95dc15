"""Queryables of services; the services directly below a node's name share one.

Every node has six parameter services and one for its types, and every entity that a
session declares is sent to all other sessions. Among fifty processes these seven
queryables caused a quarter of Zenoh's work (decision 0019).
"""

import threading
from collections.abc import Callable
from typing import Any

import zenoh

from navette.transports.zenoh.callbacks import direct

Handler = Callable[[zenoh.Query], None]


class Queryables:
    """The queryables of a session; safe to use from several threads.

    Args:
        shares: whether services may share a queryable. Not with access rules, which
            name the keys of single services.
    """

    def __init__(self, session: zenoh.Session, *, shares: bool) -> None:
        self._session = session
        self._shares = shares
        self._shared: dict[str, _Shared] = {}
        self._lock = threading.Lock()

    def open(
        self, key: str, handler: Handler, *, is_of_node: bool
    ) -> Callable[[], None]:
        """Pass the queries of a key to a handler.

        Args:
            key: service name, type and hash; no wildcards.
            handler: called on Zenoh's threads.
            is_of_node: whether the service name is a node's name and one more part.

        Returns:
            A function that undeclares it.
        """
        if is_of_node and self._shares:
            head = key.rsplit("/", 3)[0]
            with self._lock:
                shared = self._shared.get(head)
                if shared is None:
                    shared = self._shared[head] = _Shared(self._session, head)
                # A second server of the same name has its own: both are queried.
                if key not in shared.handlers:
                    shared.handlers[key] = handler
                    return lambda: self._close_one(head, key)
        undeclare: Callable[[], None] = _declare(self._session, key, handler).undeclare
        return undeclare

    def _close_one(self, head: str, key: str) -> None:
        with self._lock:
            shared = self._shared[head]
            del shared.handlers[key]
            if shared.handlers:
                return
            del self._shared[head]
        shared.queryable.undeclare()


class _Shared:
    """One queryable for the services of one node."""

    def __init__(self, session: zenoh.Session, head: str) -> None:
        self.handlers: dict[str, Handler] = {}
        # The wildcards are service, type and hash.
        self.queryable: Any = _declare(session, f"{head}/*/*/*", self._on_query)

    def _on_query(self, query: zenoh.Query) -> None:
        handler = self.handlers.get(str(query.key_expr))
        if handler is None:
            # Served by another session, or by none: end the query without a reply.
            query.drop()
        else:
            handler(query)


def _declare(session: zenoh.Session, key: str, handler: Handler) -> Any:
    return session.declare_queryable(
        key,
        direct(handler),
        complete=True,
        allowed_origin=zenoh.Locality.REMOTE,
    )
