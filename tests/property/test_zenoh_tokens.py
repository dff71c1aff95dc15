"""Tokens and QoS survive encoding; invalid text raises DecodeError only."""

from hypothesis import given
from hypothesis import strategies as st

from navette.errors import DecodeError
from navette.transports import (
    INFINITE_NS,
    DurabilityPolicy,
    EndpointKind,
    EndpointQos,
    HistoryPolicy,
    LivelinessPolicy,
    NodeInfo,
    ReliabilityPolicy,
)
from navette.transports.zenoh.attachment import Attachment, decode_attachment
from navette.transports.zenoh.qos_text import format_qos, parse_qos
from navette.transports.zenoh.tokens import EndpointToken, NodeToken, parse_token

names = st.from_regex(r"[A-Za-z_][A-Za-z0-9_]{0,20}", fullmatch=True)
type_parts = st.from_regex(r"[A-Za-z][A-Za-z0-9_]{0,20}", fullmatch=True)
full_names = st.lists(names, min_size=1, max_size=4).map(lambda p: "/" + "/".join(p))
durations = st.integers(0, 2**62) | st.just(INFINITE_NS)
qualities = st.builds(
    EndpointQos,
    history=st.sampled_from([HistoryPolicy.KEEP_LAST, HistoryPolicy.KEEP_ALL]),
    depth=st.integers(1, 10**9),
    reliability=st.sampled_from(
        [ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT]
    ),
    durability=st.sampled_from(
        [DurabilityPolicy.VOLATILE, DurabilityPolicy.TRANSIENT_LOCAL]
    ),
    deadline_ns=durations,
    lifespan_ns=durations,
    liveliness=st.sampled_from(
        [LivelinessPolicy.AUTOMATIC, LivelinessPolicy.MANUAL_BY_TOPIC]
    ),
    lease_ns=durations,
)
nodes = st.builds(NodeInfo, names, st.just("/") | full_names, st.just("/") | full_names)
identities = st.tuples(
    st.integers(0, 232),
    st.integers(1, 2**128 - 1).map(lambda zid: f"{zid:x}"),
    st.integers(0, 2**63),
)
node_tokens = st.builds(lambda who, node: NodeToken(*who, node), identities, nodes)
endpoint_tokens = st.builds(
    lambda who, *others: EndpointToken(*who, *others),
    identities,
    st.integers(0, 2**63),
    st.sampled_from(EndpointKind),
    nodes,
    full_names,
    st.builds(
        "{}/{}/{}".format,
        type_parts,
        st.sampled_from(["msg", "srv", "action"]),
        type_parts,
    ),
    st.from_regex(r"RIHS01_[0-9a-f]{64}", fullmatch=True),
    qualities,
)


@given(node_tokens | endpoint_tokens)
def test_tokens_survive_encoding(token: NodeToken | EndpointToken) -> None:
    assert parse_token(token.key()) == token


@given(qualities)
def test_qos_survives_encoding(qos: EndpointQos) -> None:
    assert parse_qos(format_qos(qos)) == qos


@given(
    st.integers(0, 2**63 - 1),
    st.integers(-(2**63), 2**63 - 1),
    st.binary(min_size=16, max_size=16),
)
def test_attachments_survive_encoding(
    sequence: int, source_ns: int, gid: bytes
) -> None:
    attachment = Attachment(sequence, source_ns, gid)
    assert decode_attachment(attachment.encode()) == attachment


@given(endpoint_tokens, st.data())
def test_a_damaged_token_is_refused_or_valid(
    token: EndpointToken, data: st.DataObject
) -> None:
    key = token.key()
    at = data.draw(st.integers(0, len(key) - 1))
    garbled = key[:at] + data.draw(st.text(max_size=5)) + key[at + 1 :]
    try:
        parsed = parse_token(garbled)
    except DecodeError:
        return
    assert parse_token(parsed.key()) == parsed


@given(st.text() | st.lists(st.text(max_size=9), max_size=15).map("/".join))
def test_any_text_is_refused_or_valid(text: str) -> None:
    for parse in (parse_token, parse_qos):
        try:
            parse(text)
        except DecodeError:
            continue
