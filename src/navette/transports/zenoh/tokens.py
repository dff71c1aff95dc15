"""Liveliness tokens, by which nodes and endpoints are discovered.

Node: ``@ros2_lv/<domain>/<zid>/<nid>/<nid>/NN/<enclave>/<namespace>/<name>``; endpoint:
``…/<zid>/<nid>/<eid>/<kind>/<enclave>/<namespace>/<node>/<name>/<type>/<hash>/<qos>``.
Newer distributions append chunks: Lyrical's ``/backends:cpu:`` after endpoints whose
type holds an unbounded ``uint8[]``. They count for the gid and are otherwise ignored.
"""

import re
from functools import lru_cache
from typing import NamedTuple

import xxhash

from navette.errors import DecodeError
from navette.transports.base import EndpointKind, NodeInfo
from navette.transports.qos import EndpointQos
from navette.transports.zenoh.keys import (
    dds_type_name,
    demangled_name,
    mangled,
    ros_type_name,
)
from navette.transports.zenoh.qos_text import format_qos, parse_qos

SPACE = "@ros2_lv"
_MAX_LENGTH = 2048
_NODE, _ENDPOINT = 9, 13  # chunks

_KINDS = {
    "MP": EndpointKind.PUBLISHER,
    "MS": EndpointKind.SUBSCRIPTION,
    "SS": EndpointKind.SERVICE,
    "SC": EndpointKind.CLIENT,
}
_ABBREVIATIONS = {kind: text for text, kind in _KINDS.items()}

_DOMAIN = re.compile(r"\d{1,10}", re.ASCII)
_ZID = re.compile(r"[0-9a-f]{1,32}")
_ID = re.compile(r"\d{1,20}", re.ASCII)
_ENCLAVE = re.compile(r"%|(%[A-Za-z_][\w.-]*)+", re.ASCII)
_NODE_NAME = re.compile(r"[A-Za-z_]\w*", re.ASCII)
# Before Jazzy, tokens have a word instead of a hash.
_HASH = re.compile(r"\w{1,128}", re.ASCII)


class NodeToken(NamedTuple):
    """Node ``nid`` of the session ``zid``."""

    domain_id: int
    zid: str
    nid: int
    node: NodeInfo

    def key(self) -> str:
        return _head(self, self.nid, "NN")


class EndpointToken(NamedTuple):
    """Endpoint ``eid`` of a session, at the node ``nid``."""

    domain_id: int
    zid: str
    nid: int
    eid: int
    kind: EndpointKind
    node: NodeInfo
    topic: str
    type_name: str
    type_hash: str
    qos: EndpointQos

    def key(self) -> str:
        head = _head(self, self.eid, _ABBREVIATIONS[self.kind])
        return "/".join(
            (
                head,
                mangled(self.topic),
                dds_type_name(self.type_name),
                self.type_hash,
                format_qos(self.qos),
            )
        )


Token = NodeToken | EndpointToken


def gid_of(key: str) -> bytes:
    """Return the gid of the endpoint with this token."""
    return xxhash.xxh3_128_digest(key.encode())[::-1]


def parse_token(key: str) -> Token:
    """Decode the key expression of a token.

    Raises:
        DecodeError: ``key`` is not a token of a node or an endpoint.
    """
    if len(key) > _MAX_LENGTH:
        raise DecodeError(f"token of {len(key)} characters, longer than {_MAX_LENGTH}")
    parts = key.split("/")
    if len(parts) < _NODE or parts[0] != SPACE:
        raise DecodeError(f"{key!r} is not a token of a node or endpoint")
    is_node = parts[5] == "NN"
    if not is_node and parts[5] not in _KINDS:
        raise DecodeError(
            f"{key!r}: entity {parts[5]!r}, expected NN, MP, MS, SS or SC"
        )
    if not is_node and len(parts) < _ENDPOINT:
        raise DecodeError(f"{key!r}: {len(parts)} chunks, expected {_ENDPOINT} or more")
    domain, zid, nid = _session(parts[1], parts[2], parts[3])
    eid = int(_checked(_ID, parts[4], "entity id"))
    node = _node(parts[6], parts[7], parts[8])
    if is_node:
        return NodeToken(domain, zid, nid, node)
    return EndpointToken(
        domain,
        zid,
        nid,
        eid,
        _KINDS[parts[5]],
        node,
        demangled_name(parts[9]),
        _type_name(parts[10], parts[11]),
        parts[11],
        _qos(parts[12]),
    )


# Thousands of tokens have few different sessions, nodes, types and QoS.
_cached = lru_cache(4096)


@_cached
def _session(domain: str, zid: str, nid: str) -> tuple[int, str, int]:
    """Return domain id, session id and number of the node."""
    return (
        int(_checked(_DOMAIN, domain, "domain id")),
        _checked(_ZID, zid, "session id"),
        int(_checked(_ID, nid, "node id")),
    )


@_cached
def _node(enclave: str, namespace: str, name: str) -> NodeInfo:
    return NodeInfo(
        name=_checked(_NODE_NAME, name, "node name"),
        namespace="/" if namespace == "%" else demangled_name(namespace),
        enclave=_checked(_ENCLAVE, enclave, "enclave").replace("%", "/"),
    )


@_cached
def _type_name(dds_name: str, type_hash: str) -> str:
    _checked(_HASH, type_hash, "type hash")
    return ros_type_name(dds_name)


_qos = _cached(parse_qos)


def _head(token: Token, eid: int, kind: str) -> str:
    node = token.node
    return "/".join(
        (
            SPACE,
            str(token.domain_id),
            token.zid,
            str(token.nid),
            str(eid),
            kind,
            mangled(node.enclave),
            mangled(node.namespace),
            node.name,
        )
    )


def _checked(pattern: re.Pattern[str], text: str, what: str) -> str:
    if not pattern.fullmatch(text):
        raise DecodeError(f"{text!r} is not a valid {what}")
    return text
