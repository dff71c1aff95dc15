"""Queryables of services; those directly below a node's name share one.

Every node has six services for its parameters and one for its types, and each entity
that a session declares is told to every other one over every link: among fifty
processes these seven were a quarter of all that Zenoh had to do (decision 0019).
"""

import threading
from collections.abc import Callable
from typing import Any

import zenoh

Handler = Callable[[zenoh.Query], None]


class Queryables:
    """The queryables of a session; safe to use from several threads.

    Args:
        shares: several services may have one. Not where rules say which keys may be
            declared: they are written for the services' own.
    """

    def __init__(self, session: zenoh.Session, *, shares: bool) -> None:
        self._session = session
        self._shares = shares
        self._shared: dict[str, _Shared] = {}
        self._lock = threading.Lock()

    def open(
        self, key: str, handler: Handler, *, is_of_node: bool
    ) -> Callable[[], None]:
        """Take the queries to that key from now on.

        Args:
            key: path, type and hash; no wildcards.
            handler: called on Zenoh's threads.
            is_of_node: the path is a node's name and one word more.

        Returns:
            What ends it.
        """
        if is_of_node and self._shares:
            head = key.rsplit("/", 3)[0]
            with self._lock:
                shared = self._shared.get(head)
                if shared is None:
                    shared = self._shared[head] = _Shared(self._session, head)
                # A second one of the same name has its own: both are asked.
                if key not in shared.handlers:
                    shared.handlers[key] = handler
                    return lambda: self._close_one(head, key)
        queryable = _declare(self._session, key, handler)

        def close() -> None:
            queryable.undeclare()

        return close

    def _close_one(self, head: str, key: str) -> None:
        with self._lock:
            shared = self._shared[head]
            del shared.handlers[key]
            if shared.handlers:
                return
            del self._shared[head]
        shared.queryable.undeclare()


class _Shared:
    """One queryable for all services of one node."""

    def __init__(self, session: zenoh.Session, head: str) -> None:
        self.handlers: dict[str, Handler] = {}
        # Service, type, hash.
        self.queryable: Any = _declare(session, f"{head}/*/*/*", self._on_query)

    def _on_query(self, query: zenoh.Query) -> None:
        handler = self.handlers.get(str(query.key_expr))
        if handler is None:
            # Another one's, or nobody's: without an answer, as if it were not asked.
            query.drop()
        else:
            handler(query)


def _declare(session: zenoh.Session, key: str, handler: Handler) -> Any:
    return session.declare_queryable(
        key,
        zenoh.handlers.Callback(handler, indirect=False),
        complete=True,
        allowed_origin=zenoh.Locality.REMOTE,
    )
