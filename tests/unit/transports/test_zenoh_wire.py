"""Bytes and texts of rmw_zenoh's wire format.

The tokens are the examples of rmw_zenoh's docs/design.md. The other values were checked
against two independent peers (tests/conformance/test_zenoh_peers.py).
"""

import struct

import pytest

from navette.errors import DecodeError, InvalidValueError
from navette.msgs import type_hash
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
from navette.transports.zenoh.keys import data_key, dds_type_name, ros_type_name
from navette.transports.zenoh.qos_text import announced, format_qos, parse_qos
from navette.transports.zenoh.tokens import (
    EndpointToken,
    NodeToken,
    gid_of,
    parse_token,
)

STRING_HASH = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
ADD_HASH = "RIHS01_e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a"

LISTENER = "@ros2_lv/2/aac3178e146ba6f1fc6e6a4085e77f21/0/0/NN/%/%/listener"
SUBSCRIPTION = (
    "@ros2_lv/2/aac3178e146ba6f1fc6e6a4085e77f21/0/10/MS/%/%/listener/%chatter/"
    f"std_msgs::msg::dds_::String_/{STRING_HASH}/::,10:,:,:,,"
)
PUBLISHER = (
    "@ros2_lv/2/8b20917502ee955ac4476e0266340d5c/0/10/MP/%/%/talker/%chatter/"
    f"std_msgs::msg::dds_::String_/{STRING_HASH}/::,7:,:,:,,"
)
SERVICE = (
    "@ros2_lv/2/f9980ee0495eaafb3e38f0d19e2eae12/0/10/SS/%/%/add_two_ints_server/"
    f"%add_two_ints/example_interfaces::srv::dds_::AddTwoInts_/{ADD_HASH}/::,10:,:,:,,"
)
CLIENT = (
    "@ros2_lv/2/e1dc8d1b45ae8717fce78689cc655685/0/10/SC/%/%/add_two_ints_client/"
    f"%add_two_ints/example_interfaces::srv::dds_::AddTwoInts_/{ADD_HASH}/::,10:,:,:,,"
)


def test_node_token() -> None:
    token = NodeToken(
        2, "aac3178e146ba6f1fc6e6a4085e77f21", 0, NodeInfo("listener", "/")
    )
    assert token.key() == LISTENER
    assert parse_token(LISTENER) == token


def test_node_token_with_namespace_and_enclave() -> None:
    token = NodeToken(0, "1f", 3, NodeInfo("n", "/a/b", "/sec/one"))
    assert token.key() == "@ros2_lv/0/1f/3/3/NN/%sec%one/%a%b/n"
    assert parse_token(token.key()) == token


@pytest.mark.parametrize(
    ("key", "kind", "zid", "node", "topic", "type_name", "depth"),
    [
        (
            SUBSCRIPTION,
            EndpointKind.SUBSCRIPTION,
            "aac3178e146ba6f1fc6e6a4085e77f21",
            "listener",
            "/chatter",
            "std_msgs/msg/String",
            10,
        ),
        (
            PUBLISHER,
            EndpointKind.PUBLISHER,
            "8b20917502ee955ac4476e0266340d5c",
            "talker",
            "/chatter",
            "std_msgs/msg/String",
            7,
        ),
        (
            SERVICE,
            EndpointKind.SERVICE,
            "f9980ee0495eaafb3e38f0d19e2eae12",
            "add_two_ints_server",
            "/add_two_ints",
            "example_interfaces/srv/AddTwoInts",
            10,
        ),
        (
            CLIENT,
            EndpointKind.CLIENT,
            "e1dc8d1b45ae8717fce78689cc655685",
            "add_two_ints_client",
            "/add_two_ints",
            "example_interfaces/srv/AddTwoInts",
            10,
        ),
    ],
)
def test_endpoint_token(
    key: str,
    kind: EndpointKind,
    zid: str,
    node: str,
    topic: str,
    type_name: str,
    depth: int,
) -> None:
    token = EndpointToken(
        domain_id=2,
        zid=zid,
        nid=0,
        eid=10,
        kind=kind,
        node=NodeInfo(node, "/"),
        topic=topic,
        type_name=type_name,
        type_hash=type_hash(type_name),
        qos=EndpointQos(depth=depth),
    )
    assert token.key() == key
    assert parse_token(key) == token


def test_gid_is_the_byte_reversed_hash_of_the_token() -> None:
    # XXH3-128 of the text (xxhsum -H2), byte-reversed: rmw_zenoh copies the low 64
    # bits and then the high ones, little-endian.
    assert gid_of("") == bytes.fromhex("99aa06d3014798d86001c324468d497f")[::-1]
    assert len(gid_of(PUBLISHER)) == 16
    assert gid_of(PUBLISHER) != gid_of(SUBSCRIPTION)


@pytest.mark.parametrize(
    ("name", "dds"),
    [
        ("geometry_msgs/msg/Twist", "geometry_msgs::msg::dds_::Twist_"),
        ("pkg/srv/AddTwoInts", "pkg::srv::dds_::AddTwoInts_"),
        ("pkg/action/Fib_SendGoal", "pkg::action::dds_::Fib_SendGoal_"),
    ],
)
def test_dds_names_of_types(name: str, dds: str) -> None:
    assert dds_type_name(name) == dds
    assert ros_type_name(dds) == name


def test_invalid_type_names_are_refused() -> None:
    with pytest.raises(InvalidValueError, match="expected package/msg/Name"):
        dds_type_name("String")
    with pytest.raises(DecodeError, match="not the DDS name"):
        ros_type_name("std_msgs::msg::String")


def test_data_keys() -> None:
    assert (
        data_key(0, "/chatter", "std_msgs/msg/String", STRING_HASH)
        == f"0/chatter/std_msgs::msg::dds_::String_/{STRING_HASH}"
    )
    assert data_key(7, "/a/b", "std_srvs/srv/Empty", "RIHS01_0") == (
        "7/a/b/std_srvs::srv::dds_::Empty_/RIHS01_0"
    )


@pytest.mark.parametrize(
    ("qos", "text"),
    [
        (EndpointQos(depth=42), "::,:,:,:,,"),
        (EndpointQos(), "::,10:,:,:,,"),
        (
            EndpointQos(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT),
            "2::,5:,:,:,,",
        ),
        (EndpointQos.latched(), ":1:,1:,:,:,,"),
        (EndpointQos(history=HistoryPolicy.KEEP_ALL, depth=42), "::2,:,:,:,,"),
        (
            EndpointQos(deadline_ns=1_500_000_000, lifespan_ns=20),
            "::,10:1,500000000:0,20:,,",
        ),
        (
            EndpointQos(
                liveliness=LivelinessPolicy.MANUAL_BY_TOPIC, lease_ns=2_000_000_003
            ),
            "::,10:,:,:3,2,3",
        ),
    ],
)
def test_qos_as_text(qos: EndpointQos, text: str) -> None:
    assert format_qos(qos) == text
    assert parse_qos(text) == qos


@pytest.mark.parametrize(
    ("text", "deadline_ns"),
    [
        ("9223372036,854775807", INFINITE_NS),
        ("18446744073709551615,18446744073709551615", INFINITE_NS),
        ("1,1500000000", 2_500_000_000),  # nanoseconds of ten digits
        # Each half has its own default.
        ("5,", 5_854_775_807),
        (",0", INFINITE_NS - 854_775_807),
        ("0,0", 0),
    ],
)
def test_durations_as_rmw_zenoh_writes_them(text: str, deadline_ns: int) -> None:
    assert parse_qos(f"::,10:{text}:,:,,").deadline_ns == deadline_ns


@pytest.mark.parametrize("text", ["5,", ",0", "0,0", ",", "1,5"])
def test_the_halves_of_a_duration_are_written_as_rmw_zenoh_does(text: str) -> None:
    chunk = f"::,10:{text}:,:,,"
    assert format_qos(parse_qos(chunk)) == chunk


def test_open_qos_values_are_announced_with_their_defaults() -> None:
    open_values = EndpointQos(
        history=HistoryPolicy.SYSTEM_DEFAULT,
        depth=0,
        reliability=ReliabilityPolicy.SYSTEM_DEFAULT,
        durability=DurabilityPolicy.UNKNOWN,
        liveliness=LivelinessPolicy.SYSTEM_DEFAULT,
    )
    assert announced(open_values, offers=True) == EndpointQos(depth=42)
    best = EndpointQos(
        reliability=ReliabilityPolicy.BEST_AVAILABLE,
        durability=DurabilityPolicy.BEST_AVAILABLE,
    )
    assert announced(best, offers=True) == EndpointQos.latched(10)
    assert announced(best, offers=False) == EndpointQos(
        reliability=ReliabilityPolicy.BEST_EFFORT
    )


def test_attachment() -> None:
    gid = bytes(range(16))
    data = Attachment(1, 0x0102030405060708, gid).encode()
    assert data == bytes.fromhex(
        "0100000000000000 0807060504030201 10 000102030405060708090a0b0c0d0e0f"
    )
    assert decode_attachment(data) == Attachment(1, 0x0102030405060708, gid)


@pytest.mark.parametrize(
    ("data", "what"),
    [
        (b"", "of 0 bytes, expected 33"),
        (bytes(34), "of 34 bytes, expected 33"),
        (bytes(33), "gid of 0 bytes, expected 16"),
        (struct.pack("<qqB16s", -1, 0, 16, b""), "sequence number -1"),
    ],
)
def test_invalid_attachments_are_refused(data: bytes, what: str) -> None:
    with pytest.raises(DecodeError, match=what):
        decode_attachment(data)


@pytest.mark.parametrize("chunks", ["/backends:cpu:", "/backends:cpu:/and/more"])
def test_further_chunks_of_a_token_count_for_the_gid_only(chunks: str) -> None:
    assert parse_token(PUBLISHER + chunks) == parse_token(PUBLISHER)
    assert parse_token(LISTENER + chunks) == parse_token(LISTENER)
    assert gid_of(PUBLISHER + chunks) != gid_of(PUBLISHER)


@pytest.mark.parametrize(
    "key",
    [
        "",
        "@ros2_lv",
        LISTENER.replace("@ros2_lv", "ros2_lv"),
        LISTENER.replace("NN", "MP"),
        LISTENER.replace("/2/", "/-2/"),
        LISTENER.replace("/2/", "/2e3/"),
        LISTENER.replace("/0/0/", "/0/x/"),
        LISTENER.replace("aac3", "AAC3"),
        LISTENER.replace("listener", "lis tener"),
        LISTENER.replace("listener", "1listener"),
        LISTENER.replace("%/%", "%/%%"),
        LISTENER.replace("%/%", "%/a"),
        LISTENER.replace("listener", "l" * 3000),
        PUBLISHER.rpartition("/")[0],
        PUBLISHER.replace("/MP/", "/XX/"),
        PUBLISHER.replace("%chatter", "chatter"),
        PUBLISHER.replace("%chatter", "%chat%"),
        PUBLISHER.replace("%chatter", "%chat\n"),
        PUBLISHER.replace("::dds_::", "::"),
        PUBLISHER.replace("RIHS01_", "RIHS01*"),
        PUBLISHER.replace("::,7:", "::,-7:"),
        PUBLISHER.replace("::,7:", "9::,7:"),
        PUBLISHER.replace("::,7:", "::,7:" * 3),
        PUBLISHER.replace("::,7:", "::,99999999999:"),
        PUBLISHER.replace("::,7:", "::,٧:"),
    ],
)
def test_invalid_tokens_are_refused(key: str) -> None:
    with pytest.raises(DecodeError):
        parse_token(key)
