"""The tokens of this session's own nodes and endpoints: made, shown, taken back."""

import itertools
import threading

import zenoh

from navette.msgs import type_hash
from navette.transports.base import Endpoint, EndpointKind, NodeInfo
from navette.transports.zenoh.qos_text import announced
from navette.transports.zenoh.session import Session
from navette.transports.zenoh.token_pool import TokenPool
from navette.transports.zenoh.tokens import EndpointToken, NodeToken, gid_of


class OwnTokens:
    """Gives every node and endpoint its name on the network; safe from any thread.

    Args:
        reuses_endpoints: an endpoint may get the token of one of its kind that is gone.
    """

    def __init__(
        self, session: Session, domain_id: int, *, reuses_endpoints: bool
    ) -> None:
        self._session = session
        self._domain_id = domain_id
        self._reuses_endpoints = reuses_endpoints
        self._ids = itertools.count()
        self._nodes: dict[NodeInfo, list[tuple[int, zenoh.LivelinessToken]]] = {}
        #: Numbers of nodes that are gone, for others of their names.
        self._spare_nodes: dict[NodeInfo, list[int]] = {}
        self._pool = TokenPool()
        #: By gid, until the endpoint is opened.
        self._made: dict[bytes, tuple[EndpointToken, int]] = {}
        self._hashes: dict[str, str] = {}
        self._lock = threading.Lock()

    # -- nodes -----------------------------------------------------------------

    def announce(self, node: NodeInfo) -> None:
        """A node is there."""
        with self._lock:
            spare = self._spare_nodes.get(node)
            nid = spare.pop() if spare else next(self._ids)
        token = NodeToken(self._domain_id, self._session.zid, nid, node)
        declared = self.declare(token)
        with self._lock:
            self._nodes.setdefault(node, []).append((nid, declared))

    def withdraw(self, node: NodeInfo) -> None:
        """One node of that name is gone."""
        with self._lock:
            tokens = self._nodes.get(node, [])
            if not tokens:
                return
            nid, token = tokens.pop(0)
            if not tokens:
                del self._nodes[node]
        if not self._session.zenoh.is_closed():
            token.undeclare()
            with self._lock:
                self._spare_nodes.setdefault(node, []).append(nid)

    def nodes(self) -> list[NodeInfo]:
        """One entry a node, also where several have the same name."""
        with self._lock:
            return [node for node, tokens in self._nodes.items() for _ in tokens]

    # -- endpoints -------------------------------------------------------------

    def gid_for(self, endpoint: Endpoint) -> bytes:
        """The gid is a hash of the token, which is therefore made up here."""
        token, used = self._make(endpoint)
        gid = gid_of(token.key())
        with self._lock:
            self._made[gid] = token, used
        return gid

    def take(self, endpoint: Endpoint) -> tuple[EndpointToken, int]:
        """The endpoint's token, and the last number that was used under it."""
        with self._lock:
            made = self._made.pop(endpoint.gid, None)
        return made or self._make(endpoint)

    def declare(self, token: NodeToken | EndpointToken) -> zenoh.LivelinessToken:
        """Show it to the others."""
        return self._session.zenoh.liveliness().declare_token(token.key())

    def take_back(
        self, token: EndpointToken, declared: zenoh.LivelinessToken, last: int
    ) -> None:
        """The endpoint is gone; ``last``: the last number that it has sent."""
        if not self._session.zenoh.is_closed():
            declared.undeclare()
            self._pool.put(token, last)

    # -- inside ----------------------------------------------------------------

    def _make(self, endpoint: Endpoint) -> tuple[EndpointToken, int]:
        offers = endpoint.kind in (EndpointKind.PUBLISHER, EndpointKind.SERVICE)
        nid, node = self._node_of(endpoint)
        token = EndpointToken(
            domain_id=self._domain_id,
            zid=self._session.zid,
            nid=nid,
            eid=next(self._ids),
            kind=endpoint.kind,
            node=node,
            topic=endpoint.topic,
            type_name=endpoint.type_name,
            type_hash=self._hash(endpoint.type_name),
            qos=announced(endpoint.qos, offers=offers),
        )
        return self._pool.take(token) if self._reuses_endpoints else (token, 0)

    def _node_of(self, endpoint: Endpoint) -> tuple[int, NodeInfo]:
        """The newest announced node of that name; 0 where none was."""
        with self._lock:
            for node, tokens in self._nodes.items():
                if node.full_name == endpoint.node_full_name:
                    return tokens[-1][0], node
        return 0, NodeInfo(endpoint.node_name, endpoint.node_namespace)

    def _hash(self, type_name: str) -> str:
        found = self._hashes.get(type_name)
        if found is None:
            found = self._hashes[type_name] = type_hash(type_name)
        return found
