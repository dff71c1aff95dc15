"""Nodes and endpoints of other sessions, matched with the local endpoints."""

import threading
from collections import Counter, deque
from collections.abc import Callable, Iterable
from functools import partial

from navette.errors import DecodeError
from navette.transports.base import (
    Endpoint,
    EndpointKind,
    NodeInfo,
    TransportObserver,
)
from navette.transports.qos import QoSPolicyKind, incompatible_policies
from navette.transports.zenoh.log_once import LogOnce
from navette.transports.zenoh.matches import Matches
from navette.transports.zenoh.tokens import EndpointToken, Token, gid_of, parse_token

# Limit for one session, against flooding.
MAX_TOKENS_OF_A_SESSION = 20_000
_MAX_TOPICS = 100_000

_SENDERS = (EndpointKind.PUBLISHER, EndpointKind.CLIENT)

_OPPOSITE = {
    EndpointKind.PUBLISHER: EndpointKind.SUBSCRIPTION,
    EndpointKind.SUBSCRIPTION: EndpointKind.PUBLISHER,
    EndpointKind.SERVICE: EndpointKind.CLIENT,
    EndpointKind.CLIENT: EndpointKind.SERVICE,
}


class RemoteGraph:
    """Stores the tokens of other sessions and notifies observers of changes.

    Called from several threads. No observer is called while the lock is held.

    Args:
        own_zid: id of the local session, whose tokens are ignored.
    """

    def __init__(self, own_zid: str, log_once: LogOnce) -> None:
        self.observers: list[TransportObserver] = []
        self._own_zid = own_zid
        self._log_once = log_once
        self._nodes: dict[str, NodeInfo] = {}
        self._endpoints: dict[str, Endpoint] = {}
        self._by_name: dict[tuple[EndpointKind, str], dict[str, Endpoint]] = {}
        self._count_of: Counter[str] = Counter()
        #: Gid → topic, also of closed endpoints: a gid is never used for another topic.
        self._topics: dict[bytes, str] = {}
        self._locals: dict[tuple[EndpointKind, str], list[Matches]] = {}
        self._lock = threading.Condition()
        self._events: deque[Callable[[], None]] = deque()
        self._notifying = threading.RLock()

    def on_tokens(self, changes: Iterable[tuple[str, bool]]) -> None:
        """Add (true) and remove (false) tokens; invalid ones are logged once.

        Observers are notified once that the graph has changed.
        """
        read = [
            (key, alive, self._token(key) if alive else None) for key, alive in changes
        ]
        changed = False
        with self._lock:
            for key, alive, token in read:
                if token is not None:
                    changed |= self._add(key, token)
                elif not alive:
                    changed |= self._remove(key)
            if changed:
                self._events.append(self._notify_changed)
                self._lock.notify_all()
        self._notify()

    def nodes(self) -> list[NodeInfo]:
        """Return the remote nodes, in order of appearance."""
        with self._lock:
            return list(self._nodes.values())

    def endpoints(
        self, kinds: Iterable[EndpointKind], name: str | None = None
    ) -> list[Endpoint]:
        """Return the remote endpoints of these kinds, and of a topic or service.

        They are in order of appearance, those of a name kind by kind.
        """
        chosen = set(kinds)
        with self._lock:
            if name is None:
                return [e for e in self._endpoints.values() if e.kind in chosen]
            found = (self._by_name.get((kind, name), {}) for kind in kinds)
            return [endpoint for each in found for endpoint in each.values()]

    def counts(self) -> dict[str, int]:
        """Notify observers; return session → number of nodes and endpoints."""
        with self._notifying:
            while True:
                self._notify()
                with self._lock:
                    if not self._events:
                        return dict(self._count_of)

    def wait_until_known(self, keys: set[str], timeout_s: float) -> set[str]:
        """Wait until these tokens are known; return those missing after the timeout."""
        missing = keys

        def all_known() -> bool:
            nonlocal missing
            missing = missing - self._nodes.keys() - self._endpoints.keys()
            return not missing

        with self._lock:
            self._lock.wait_for(all_known, timeout_s)
        return missing

    def add_local(self, endpoint: Endpoint, type_hash: str) -> Matches:
        """Match an endpoint of this session with the remote ones from now on."""
        matches = Matches(
            endpoint, type_hash, self._topics, on_asserted=self._queue_assertion
        )
        with self._lock:
            self._locals.setdefault((endpoint.kind, endpoint.topic), []).append(matches)
            remotes = self._by_name.get((_OPPOSITE[endpoint.kind], endpoint.topic), {})
            for key, remote in remotes.items():
                self._match(matches, key, remote)
        self._notify()
        return matches

    def remove_local(self, matches: Matches) -> None:
        """Unmatch an endpoint that :meth:`add_local` has added."""
        name = matches.endpoint.kind, matches.endpoint.topic
        with self._lock:
            here = self._locals.get(name, [])
            if matches not in here:
                return
            here.remove(matches)
            if not here:
                del self._locals[name]
            for remote in matches.remotes.values():
                self._queue_match(matches.endpoint, remote, up=False)
            matches.clear()
        self._notify()

    def _token(self, key: str) -> Token | None:
        """Return the token; None if it is invalid or of this session."""
        try:
            token = parse_token(key)
        except DecodeError as error:
            peer = "/".join(key[:200].split("/")[:3])
            self._log_once.warning(("token", peer), f"token ignored: {error}")
            return None
        return None if token.zid == self._own_zid else token

    # The methods from here to _queue() are called under the lock.

    def _add(self, key: str, token: Token) -> bool:
        if key in self._nodes or key in self._endpoints:
            return False
        if self._count_of[token.zid] >= MAX_TOKENS_OF_A_SESSION:
            self._log_once.warning(
                ("tokens", token.zid),
                f"session {token.zid} has more than {MAX_TOKENS_OF_A_SESSION} "
                "nodes and endpoints: further ones are ignored",
            )
            return False
        self._count_of[token.zid] += 1
        if isinstance(token, EndpointToken):
            self._add_endpoint(key, token)
        else:
            self._nodes[key] = token.node
        return True

    def _add_endpoint(self, key: str, token: EndpointToken) -> None:
        endpoint = Endpoint(
            kind=token.kind,
            topic=token.topic,
            type_name=token.type_name,
            qos=token.qos,
            node_name=token.node.name,
            node_namespace=token.node.namespace,
            gid=gid_of(key),
            type_hash=token.type_hash,
        )
        self._endpoints[key] = endpoint
        if endpoint.kind in _SENDERS:
            self._store_topic(endpoint)
        self._by_name.setdefault((endpoint.kind, endpoint.topic), {})[key] = endpoint
        for matches in self._locals.get((_OPPOSITE[token.kind], token.topic), ()):
            self._match(matches, key, endpoint)

    def _store_topic(self, sender: Endpoint) -> None:
        if len(self._topics) >= _MAX_TOPICS:
            del self._topics[next(iter(self._topics))]
        self._topics[sender.gid] = sender.topic

    def _remove(self, key: str) -> bool:
        endpoint = self._endpoints.pop(key, None)
        if endpoint is not None:
            self._unmatch(key, endpoint)
        elif self._nodes.pop(key, None) is None:
            return False
        zid = key.split("/", 3)[2]
        self._count_of[zid] -= 1
        if not self._count_of[zid]:
            del self._count_of[zid]
        return True

    def _unmatch(self, key: str, endpoint: Endpoint) -> None:
        name = endpoint.kind, endpoint.topic
        del self._by_name[name][key]
        if not self._by_name[name]:
            del self._by_name[name]
        opposite = _OPPOSITE[endpoint.kind], endpoint.topic
        for matches in self._locals.get(opposite, ()):
            matches.refused.discard(endpoint.gid)
            if matches.remove(key):
                self._queue_match(matches.endpoint, endpoint, up=False)

    def _match(self, matches: Matches, key: str, remote: Endpoint) -> None:
        local = matches.endpoint
        if (remote.type_name, remote.type_hash) != (local.type_name, matches.type_hash):
            if remote.type_name not in local.other_types:
                self._queue("incompatible_type", local, remote)
            return
        publisher, subscription = _in_order(local, remote)
        short = incompatible_policies(publisher.qos, subscription.qos)
        if local.kind in (EndpointKind.SERVICE, EndpointKind.CLIENT):
            short += incompatible_policies(subscription.qos, publisher.qos)
            if not short:
                matches.add(key, remote)
        elif short:
            matches.refused.add(remote.gid)
            self._queue("incompatible_qos", publisher, subscription, short)
        else:
            matches.add(key, remote)
            self._queue_match(local, remote, up=True)

    def _queue_match(self, local: Endpoint, remote: Endpoint, *, up: bool) -> None:
        if local.kind in (EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION):
            self._queue("matched" if up else "unmatched", *_in_order(local, remote))

    def _queue(self, event: str, *ends: Endpoint | tuple[QoSPolicyKind, ...]) -> None:
        for observer in self.observers:
            self._events.append(partial(getattr(observer, event), *ends))

    def lost(self, subscription: Endpoint, count: int) -> None:
        """Report that samples did not arrive."""
        for observer in self.observers:
            observer.message_lost(subscription, count)

    def asserted(self, gid: bytes) -> None:
        """Report that a remote publisher asserted its liveliness without a sample."""
        with self._lock:
            name = EndpointKind.SUBSCRIPTION, self._topics.get(gid, "")
            for matches in self._locals.get(name, ()):
                if gid in matches.asserting:
                    self._queue("asserted", matches.by_gid[gid], matches.endpoint)
        self._notify()

    def _queue_assertion(self, matches: Matches, gid: bytes) -> None:
        with self._lock:
            publisher = matches.by_gid.get(gid)
            if publisher is None:
                return
            self._queue("asserted", publisher, matches.endpoint)
        self._notify()

    def _notify(self) -> None:
        """Call the observers, in the order of the events."""
        with self._notifying:
            while self._events:
                self._events.popleft()()

    def _notify_changed(self) -> None:
        for observer in self.observers:
            observer.graph_changed()


def _in_order(local: Endpoint, remote: Endpoint) -> tuple[Endpoint, Endpoint]:
    """Return the publisher or server first."""
    if local.kind in (EndpointKind.PUBLISHER, EndpointKind.SERVICE):
        return local, remote
    return remote, local
