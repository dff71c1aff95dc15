"""Encode the frames that the server sends.

Source: the Foxglove WebSocket protocol v1 (foxglove/ws-protocol, docs/spec.md) and,
for playback control, the SDK's (foxglove/foxglove-sdk, rust/foxglove/src/protocol).
"""

import json
import struct
from collections.abc import Iterable, Mapping, Set
from dataclasses import asdict, dataclass, field
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
    "services",
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
class OfferedService:
    """A service of the graph; definitions of request and response in ros2msg."""

    name: str
    type_name: str
    request: str
    response: str


Ends = Mapping[str, tuple[str, ...]]
"""Names of nodes, by topic or service."""


@dataclass(frozen=True)
class ConnectionGraph:
    """The publishing and subscribing nodes by topic, the serving nodes by service."""

    published: Ends
    subscribed: Ends
    served: Ends = field(default_factory=dict)


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


def message_head(subscription_id: int, stamp_ns: int) -> bytes:
    """Encode what precedes the payload of messageData."""
    return struct.pack("<BIQ", 1, subscription_id, _u64(stamp_ns))


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
    known = new.published.keys() | new.subscribed.keys()
    gone = (old.published.keys() | old.subscribed.keys()) - known
    unserved = old.served.keys() - new.served.keys()
    # A topic that lost its last publisher but is still subscribed to is not removed.
    published = _changed(old.published, new.published, gone)
    subscribed = _changed(old.subscribed, new.subscribed, gone)
    served = _changed(old.served, new.served, unserved)
    if not (published or subscribed or served or gone or unserved):
        return None
    return _json(
        op="connectionGraphUpdate",
        publishedTopics=_ends(published, "publisherIds"),
        subscribedTopics=_ends(subscribed, "subscriberIds"),
        advertisedServices=_ends(served, "providerIds"),
        removedTopics=sorted(gone),
        removedServices=sorted(unserved),
    )


def _changed(old: Ends, new: Ends, gone: Set[str]) -> dict[str, tuple[str, ...]]:
    """Return new and changed entries, and empty entries for lost names."""
    changed = {name: nodes for name, nodes in new.items() if old.get(name) != nodes}
    lost = old.keys() - new.keys() - gone
    return changed | dict.fromkeys(lost, ())


def _ends(ends: Ends, key: str) -> list[dict[str, Any]]:
    return [{"name": name, key: list(nodes)} for name, nodes in sorted(ends.items())]


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


def advertise_services(services: Iterable[tuple[int, OfferedService]]) -> str:
    """Encode services with their ids."""
    return _json(
        op="advertiseServices",
        services=[
            {
                "id": service_id,
                "name": service.name,
                "type": service.type_name,
                "request": _service_schema(service, "Request", service.request),
                "response": _service_schema(service, "Response", service.response),
                # Clients from before 2024 read these.
                "requestSchema": service.request,
                "responseSchema": service.response,
            }
            for service_id, service in services
        ],
    )


def _service_schema(
    service: OfferedService, part: str, definition: str
) -> dict[str, str]:
    return {
        "encoding": "cdr",
        "schemaName": f"{service.type_name}_{part}",
        "schemaEncoding": "ros2msg",
        "schema": definition,
    }


def unadvertise_services(service_ids: Iterable[int]) -> str:
    return _json(op="unadvertiseServices", serviceIds=list(service_ids))


def service_response(
    service_id: int, call_id: int, encoding: str, data: bytes
) -> bytes:
    name = encoding.encode()
    return struct.pack("<BIII", 3, service_id, call_id, len(name)) + name + data


def service_failure(service_id: int, call_id: int, message: str) -> str:
    return _json(
        op="serviceCallFailure", serviceId=service_id, callId=call_id, message=message
    )


def _json(**fields: Any) -> str:
    # A browser cannot parse a frame with NaN: fail here instead.
    return json.dumps(fields, allow_nan=False, separators=(",", ":"))


def _u64(stamp_ns: int) -> int:
    return max(0, stamp_ns)
