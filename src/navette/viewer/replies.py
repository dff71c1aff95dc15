"""Encode the frames that the server sends.

Source: the Foxglove WebSocket protocol v1 (foxglove/ws-protocol, docs/spec.md) and,
for playback control, the SDK's (foxglove/foxglove-sdk, rust/foxglove/src/protocol).
"""

import json
import struct
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from enum import IntEnum
from typing import Any

from navette.viewer.frames import WireParameter
from navette.viewer.liveness import NodeReport
from navette.viewer.parameters import ParameterText
from navette.viewer.playback import PlaybackState

# A declared capability must work; playbackControl is added with a recording.
CAPABILITIES = (
    "clientPublish",
    "parameters",
    "parametersSubscribe",
    "connectionGraph",
    "time",
    "assets",
)
ENCODINGS = ("cdr", "json")
_NS_PER_S = 1_000_000_000


class Level(IntEnum):
    INFO = 0
    WARNING = 1
    ERROR = 2


@dataclass(frozen=True)
class Channel:
    """A topic with one type; ``latched`` means transient local."""

    id: int
    topic: str
    type_name: str
    definition: str
    latched: bool = False


@dataclass(frozen=True)
class ConnectionGraph:
    """Names of the publishing and subscribing nodes by topic."""

    published: Mapping[str, tuple[str, ...]]
    subscribed: Mapping[str, tuple[str, ...]]


EMPTY_GRAPH = ConnectionGraph({}, {})


def server_info(
    name: str, session_id: str, playback_range: tuple[int, int] | None = None
) -> str:
    """Encode serverInfo; ``playback_range``: first and last stamp of a bag (ns)."""
    extra: dict[str, Any] = {}
    if playback_range is not None:
        begin, end = (divmod(each, _NS_PER_S) for each in playback_range)
        extra["dataStartTime"] = {"sec": begin[0], "nsec": begin[1]}
        extra["dataEndTime"] = {"sec": end[0], "nsec": end[1]}
    playback = () if playback_range is None else ("playbackControl",)
    return _json(
        op="serverInfo",
        name=name,
        capabilities=(*CAPABILITIES, *playback),
        supportedEncodings=ENCODINGS,
        # Without a ROS 2 distribution the Foxglove app disables its publish tools,
        # which set the goal point.
        metadata={"ROS_DISTRO": "jazzy"},
        sessionId=session_id,
        **extra,
    )


def status(level: Level, message: str) -> str:
    return _json(op="status", level=int(level), message=message)


def advertise(channels: Iterable[Channel]) -> str:
    return _json(
        op="advertise",
        channels=[
            {
                "id": channel.id,
                "topic": channel.topic,
                "encoding": "cdr",
                "schemaName": channel.type_name,
                "schemaEncoding": "ros2msg",
                "schema": channel.definition,
            }
            for channel in channels
        ],
    )


def unadvertise(channel_ids: Iterable[int]) -> str:
    return _json(op="unadvertise", channelIds=list(channel_ids))


def message_data(subscription_id: int, stamp_ns: int, payload: bytes) -> bytes:
    return struct.pack("<BIQ", 1, subscription_id, _u64(stamp_ns)) + payload


def time(stamp_ns: int) -> bytes:
    return struct.pack("<BQ", 2, _u64(stamp_ns))


def playback_state(state: PlaybackState, *, did_seek: bool, request_id: str) -> bytes:
    """Encode playbackState; ``did_seek`` makes clients clear their panels."""
    text = request_id.encode()
    head = struct.pack(
        "<BBQfBI",
        5,
        state.status,
        _u64(state.position_ns),
        state.speed,
        did_seek,
        len(text),
    )
    return head + text


def parameter_values(
    parameters: Iterable[WireParameter], request_id: str | None
) -> str:
    document: dict[str, Any] = {
        "op": "parameterValues",
        "parameters": [_parameter(parameter) for parameter in parameters],
    }
    if request_id is not None:
        document["id"] = request_id
    return _json(**document)


def _parameter(parameter: WireParameter) -> dict[str, Any]:
    document: dict[str, Any] = {"name": parameter.name}
    if parameter.value is not None:
        document["value"] = parameter.value
    if parameter.kind is not None:
        document["type"] = parameter.kind
    return document


def graph_update(old: ConnectionGraph, new: ConnectionGraph) -> str | None:
    """Encode the difference of two graphs; None if they are equal."""
    published = _changed(old.published, new.published)
    subscribed = _changed(old.subscribed, new.subscribed)
    gone = (old.published.keys() | old.subscribed.keys()) - (
        new.published.keys() | new.subscribed.keys()
    )
    # A topic that lost its last publisher but is still subscribed to is not removed.
    lost = old.published.keys() - new.published.keys() - gone
    published.update(dict.fromkeys(lost, ()))
    lost = old.subscribed.keys() - new.subscribed.keys() - gone
    subscribed.update(dict.fromkeys(lost, ()))
    if not (published or subscribed or gone):
        return None
    return _json(
        op="connectionGraphUpdate",
        publishedTopics=[
            {"name": topic, "publisherIds": list(nodes)}
            for topic, nodes in sorted(published.items())
        ],
        subscribedTopics=[
            {"name": topic, "subscriberIds": list(nodes)}
            for topic, nodes in sorted(subscribed.items())
        ],
        advertisedServices=[],
        removedTopics=sorted(gone),
        removedServices=[],
    )


def _changed(
    old: Mapping[str, tuple[str, ...]], new: Mapping[str, tuple[str, ...]]
) -> dict[str, tuple[str, ...]]:
    return {topic: nodes for topic, nodes in new.items() if old.get(topic) != nodes}


def nodes(reports: Iterable[NodeReport], blocked_s: float) -> str:
    """Encode node states; ``blocked_s``: time since the program ran a callback."""
    document = [
        {"name": each.name, "state": each.state, "since": round(each.since_s, 1)}
        for each in reports
    ]
    return _json(op="nodes", nodes=document, blocked=round(blocked_s, 1))


def parameter_texts(texts: Iterable[ParameterText]) -> str:
    return _json(op="parameterTexts", parameters=[asdict(text) for text in texts])


def asset(request_id: int, data: bytes) -> bytes:
    return struct.pack("<BIBI", 4, request_id, 0, 0) + data


def asset_error(request_id: int, message: str) -> bytes:
    text = message.encode(errors="replace")  # it may quote half a surrogate pair
    return struct.pack("<BIBI", 4, request_id, 1, len(text)) + text


def service_failure(service_id: int, call_id: int, message: str) -> str:
    return _json(
        op="serviceCallFailure", serviceId=service_id, callId=call_id, message=message
    )


def _json(**fields: Any) -> str:
    # A browser cannot parse a frame with NaN: fail here instead.
    return json.dumps(fields, allow_nan=False, separators=(",", ":"))


def _u64(stamp_ns: int) -> int:
    return max(0, stamp_ns)
