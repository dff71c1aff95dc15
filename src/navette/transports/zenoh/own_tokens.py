"""Liveliness tokens of this session's nodes and endpoints."""

import itertools
import threading

import zenoh

from navette.transports.base import Endpoint, EndpointKind, NodeInfo
from navette.transports.zenoh.keys import wire_hash
from navette.transports.zenoh.qos_text import announced
from navette.transports.zenoh.session import ZenohSession
from navette.transports.zenoh.token_pool import TokenPool
from navette.transports.zenoh.tokens import EndpointToken, NodeToken, gid_of


class OwnTokens:
    """Creates, declares and withdraws tokens; called from any thread.

    Args:
        reuses_endpoints: whether an endpoint may get the token of a closed one of the
            same kind.
    """

    def __init__(
        self, session: ZenohSession, domain_id: int, *, reuses_endpoints: bool
    ) -> None:
        self._session = session
        self._domain_id = domain_id
        self._reuses_endpoints = reuses_endpoints
        self._ids = itertools.count()
        self._nodes: dict[NodeInfo, list[tuple[int, zenoh.LivelinessToken]]] = {}
        #: Numbers of closed nodes, for new nodes of the same name.
        self._free_nodes: dict[NodeInfo, list[int]] = {}
        self._pool = TokenPool()
        #: Created tokens by gid, until the endpoint is opened.
        self._created: dict[bytes, tuple[EndpointToken, int]] = {}
        self._lock = threading.Lock()

    def announce(self, node: NodeInfo) -> None:
        with self._lock:
            free = self._free_nodes.get(node)
            nid = free.pop() if free else next(self._ids)
        token = NodeToken(self._domain_id, self._session.zid, nid, node)
        declared = self.declare(token)
        with self._lock:
            self._nodes.setdefault(node, []).append((nid, declared))

    def withdraw(self, node: NodeInfo) -> None:
        """Undeclare the token of one node of that name."""
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
                self._free_nodes.setdefault(node, []).append(nid)

    def nodes(self) -> list[NodeInfo]:
        """Return one entry for each node, also if several have the same name."""
        with self._lock:
            return [node for node, tokens in self._nodes.items() for _ in tokens]

    def gid_for(self, endpoint: Endpoint) -> bytes:
        """Return the gid of a new endpoint: the hash of a token created here."""
        token, initial_sequence = self._create(endpoint)
        gid = gid_of(token.key())
        with self._lock:
            self._created[gid] = token, initial_sequence
        return gid

    def take(self, endpoint: Endpoint) -> tuple[EndpointToken, int]:
        """Return the endpoint's token and the last sequence number sent under it."""
        with self._lock:
            created = self._created.pop(endpoint.gid, None)
        return created or self._create(endpoint)

    def declare(self, token: NodeToken | EndpointToken) -> zenoh.LivelinessToken:
        """Declare a token, which other sessions receive."""
        return self._session.zenoh.liveliness().declare_token(token.key())

    def take_back(
        self, token: EndpointToken, declared: zenoh.LivelinessToken, last_sequence: int
    ) -> None:
        """Undeclare the token of a closed endpoint and keep it for reuse."""
        if not self._session.zenoh.is_closed():
            declared.undeclare()
            self._pool.put(token, last_sequence)

    def _create(self, endpoint: Endpoint) -> tuple[EndpointToken, int]:
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
            type_hash=wire_hash(endpoint.type_name),
            qos=announced(endpoint.qos, offers=offers),
        )
        return self._pool.take(token) if self._reuses_endpoints else (token, 0)

    def _node_of(self, endpoint: Endpoint) -> tuple[int, NodeInfo]:
        """Return number and node of the newest announced node of that name, else 0."""
        with self._lock:
            for node, tokens in self._nodes.items():
                if node.full_name == endpoint.node_full_name:
                    return tokens[-1][0], node
        return 0, NodeInfo(endpoint.node_name, endpoint.node_namespace)
