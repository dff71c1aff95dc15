"""Decode the frames that clients send.

Source: the Foxglove WebSocket protocol v1 (foxglove/ws-protocol, docs/spec.md);
the later subprotocol ``foxglove.sdk.v1`` has the same frames and those for playback
control (foxglove/foxglove-sdk, rust/foxglove/src/protocol). A frame either decodes to
one of the classes below or raises :class:`DecodeError`.
"""

import json
import struct
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NoReturn

from navette.errors import DecodeError
from navette.files.untrusted.budget import FRAME, BudgetError

# In order of preference: the current app requests the first, older tools and the
# published TypeScript client the second.
SUBPROTOCOLS = ("foxglove.sdk.v1", "foxglove.websocket.v1")

MAX_BINARY = 4 * 2**20
"""Bytes of a frame; the connection is closed with code 1009 beyond."""

_MAX_CONTAINERS = 2500  # lists and objects of a request

_U32 = 2**32
_PLAYBACK = struct.Struct("<BBfBQI")


@dataclass(frozen=True)
class Subscribe:
    """Pairs of (subscription id chosen by the client, channel id)."""

    subscriptions: tuple[tuple[int, int], ...]


@dataclass(frozen=True)
class Unsubscribe:
    subscription_ids: tuple[int, ...]


@dataclass(frozen=True)
class ClientChannel:
    """A channel on which a client publishes; ``encoding`` is ``cdr`` or ``json``."""

    id: int
    topic: str
    encoding: str
    type_name: str


@dataclass(frozen=True)
class Advertise:
    channels: tuple[ClientChannel, ...]


@dataclass(frozen=True)
class Unadvertise:
    channel_ids: tuple[int, ...]


@dataclass(frozen=True)
class Publish:
    channel_id: int
    data: bytes


@dataclass(frozen=True)
class GetParameters:
    """No names means all parameters."""

    names: tuple[str, ...]
    request_id: str | None


@dataclass(frozen=True)
class WireParameter:
    """A parameter in JSON; ``kind`` distinguishes 3.0 from 3 and bytes from text.

    ``value`` None means unset. ``kind``: float64, float64_array, byte_array or None.
    """

    name: str
    value: Any
    kind: str | None = None


@dataclass(frozen=True)
class SetParameters:
    parameters: tuple[WireParameter, ...]
    request_id: str | None


@dataclass(frozen=True)
class WatchParameters:
    """No names means all parameters."""

    names: tuple[str, ...]


@dataclass(frozen=True)
class UnwatchParameters:
    names: tuple[str, ...]


@dataclass(frozen=True)
class WatchGraph:
    wanted: bool


@dataclass(frozen=True)
class WatchNodes:
    """Subscribe to node states and parameter texts, or unsubscribe.

    Used by Navette's own page only.
    """

    wanted: bool


@dataclass(frozen=True)
class ApplyGridUpdates:
    """The client applies the updates of grids: it needs few whole ones.

    Used by Navette's own page only.
    """


@dataclass(frozen=True)
class FetchAsset:
    uri: str
    request_id: int


@dataclass(frozen=True)
class CallService:
    service_id: int
    call_id: int
    encoding: str
    data: bytes


@dataclass(frozen=True)
class ControlPlayback:
    """Play or pause at a speed, after an optional seek."""

    play: bool
    speed: float
    seek_ns: int | None
    request_id: str


@dataclass(frozen=True)
class StepPlayback:
    """Pause and publish the next message; used by Navette's own page only."""


ClientFrame = (
    Subscribe
    | Unsubscribe
    | Advertise
    | Unadvertise
    | Publish
    | GetParameters
    | SetParameters
    | WatchParameters
    | UnwatchParameters
    | WatchGraph
    | WatchNodes
    | ApplyGridUpdates
    | FetchAsset
    | CallService
    | ControlPlayback
    | StepPlayback
)


def decode(frame: str | bytes) -> ClientFrame:
    """Decode one client frame.

    Raises:
        DecodeError: with a message that the client's user can read.
    """
    try:
        if isinstance(frame, str):
            return _decode_text(frame)
        return _decode_binary(frame)
    except BudgetError as error:
        raise DecodeError(f"{error}: send several requests") from None


def check_containers(count: int, most: int) -> None:
    """Refuse JSON by the number of its lists and objects, before it is parsed.

    Each of them makes the garbage collector run, which stops all threads. Brackets in
    strings count too.

    Raises:
        BudgetError: too many.
    """
    if count > most:
        raise BudgetError(f"JSON with {count} lists and objects; at most {most}")


def _decode_text(text: str) -> ClientFrame:
    FRAME.check_octets(len(text), "text frame")
    check_containers(text.count("[") + text.count("{"), _MAX_CONTAINERS)
    try:
        # Python's parser accepts NaN, which is not JSON.
        document = json.loads(text, parse_constant=_refuse_constant)
    except (ValueError, RecursionError) as error:
        raise DecodeError(f"text frame is not JSON: {error}") from None
    if not isinstance(document, dict):
        raise DecodeError("text frame is not a JSON object")
    operation = document.get("op")
    if not isinstance(operation, str) or operation not in _TEXT:
        raise DecodeError(f"unknown op {operation!r:.80}; known: {', '.join(_TEXT)}")
    return _TEXT[operation](_Fields(document, operation))


def _decode_binary(data: bytes) -> ClientFrame:
    if not data:
        raise DecodeError("binary frame is empty")
    if data[0] == 1:
        if len(data) < 5:
            raise DecodeError("message data frame is truncated")
        (channel_id,) = struct.unpack_from("<I", data, 1)
        return Publish(channel_id, bytes(data[5:]))
    if data[0] == 2:
        return _decode_call(data)
    if data[0] == 3:
        return _decode_playback(data)
    raise DecodeError(f"unknown binary opcode {data[0]}; known: 1, 2 and 3")


def _decode_call(data: bytes) -> CallService:
    if len(data) < 13:
        raise DecodeError("service call frame is truncated")
    service_id, call_id, length = struct.unpack_from("<III", data, 1)
    end = 13 + length
    if end > len(data):
        raise DecodeError("service call frame is truncated")
    encoding = data[13:end].decode("utf-8", "replace")
    return CallService(service_id, call_id, encoding, bytes(data[end:]))


def _decode_playback(data: bytes) -> ControlPlayback:
    """Decode command (0 play, 1 pause), speed, optional seek and request id."""
    if len(data) < _PLAYBACK.size:
        raise DecodeError("playback control frame is truncated")
    _, command, speed, seeks, seek_ns, length = _PLAYBACK.unpack_from(data)
    end = _PLAYBACK.size + length
    if end > len(data):
        raise DecodeError("playback control frame is truncated")
    FRAME.check_word(length, "playback control: request id")
    if command > 1:
        raise DecodeError(f"unknown playback command {command}; known: 0 and 1")
    request_id = data[_PLAYBACK.size : end].decode("utf-8", "replace")
    where = seek_ns if seeks else None
    return ControlPlayback(command == 0, speed, where, request_id)


def _refuse_constant(name: str) -> NoReturn:
    raise ValueError(f"{name} is not JSON")


class _Fields:
    """Typed access to the fields of a JSON object; errors name op and field."""

    def __init__(self, document: dict[str, Any], where: str) -> None:
        self._document = document
        self._where = where

    def _get(self, name: str, kind: type, wanted: str) -> Any:
        value = self._document.get(name)
        if not isinstance(value, kind) or isinstance(value, bool):
            raise self._wrong(name, value, wanted)
        return value

    def _list(self, name: str, wanted: str) -> list[Any]:
        items: list[Any] = self._get(name, list, wanted)
        FRAME.check_items(len(items), f"entries in {name!r} of {self._where}")
        return items

    def text(self, name: str) -> str:
        return self._text(name, self._get(name, str, "a string"))

    def _text(self, name: str, value: str) -> str:
        FRAME.check_word(len(value), f"{self._where}: {name!r}")
        return value

    def optional_text(self, name: str) -> str | None:
        return None if self._document.get(name) is None else self.text(name)

    def identifier(self, name: str) -> int:
        return self._identifier(name, self._get(name, int, "a number"))

    def _identifier(self, name: str, value: object) -> int:
        if isinstance(value, bool) or not isinstance(value, int):
            raise self._wrong(name, value, "a number")
        if not 0 <= value < _U32:
            raise self._wrong(name, value, "a uint32")
        return value

    def _wrong(self, name: str, value: object, wanted: str) -> DecodeError:
        return DecodeError(f"{self._where}: {name!r} has {value!r:.80}, not {wanted}")

    def identifiers(self, name: str) -> tuple[int, ...]:
        items = self._list(name, "a list of numbers")
        return tuple(self._identifier(name, item) for item in items)

    def texts(self, name: str) -> tuple[str, ...]:
        items = self._list(name, "a list of strings")
        if not all(isinstance(item, str) for item in items):
            raise DecodeError(f"{self._where}: {name!r} is not a list of strings")
        return tuple(self._text(name, item) for item in items)

    def objects(self, name: str) -> "list[_Fields]":
        items = self._list(name, "a list of objects")
        if not all(isinstance(item, dict) for item in items):
            raise DecodeError(f"{self._where}: {name!r} is not a list of objects")
        return [_Fields(item, f"{self._where}.{name}") for item in items]

    def value(self, name: str) -> Any:
        return self._document.get(name)


def _subscribe(fields: _Fields) -> Subscribe:
    return Subscribe(
        tuple(
            (item.identifier("id"), item.identifier("channelId"))
            for item in fields.objects("subscriptions")
        )
    )


def _advertise(fields: _Fields) -> Advertise:
    return Advertise(
        tuple(
            ClientChannel(
                item.identifier("id"),
                item.text("topic"),
                item.text("encoding"),
                item.text("schemaName"),
            )
            for item in fields.objects("channels")
        )
    )


def _set_parameters(fields: _Fields) -> SetParameters:
    return SetParameters(
        tuple(
            WireParameter(
                item.text("name"), item.value("value"), item.optional_text("type")
            )
            for item in fields.objects("parameters")
        ),
        fields.optional_text("id"),
    )


_TEXT: dict[str, Callable[[_Fields], ClientFrame]] = {
    "subscribe": _subscribe,
    "unsubscribe": lambda f: Unsubscribe(f.identifiers("subscriptionIds")),
    "advertise": _advertise,
    "unadvertise": lambda f: Unadvertise(f.identifiers("channelIds")),
    "getParameters": lambda f: GetParameters(
        f.texts("parameterNames"), f.optional_text("id")
    ),
    "setParameters": _set_parameters,
    "subscribeParameterUpdates": lambda f: WatchParameters(f.texts("parameterNames")),
    "unsubscribeParameterUpdates": lambda f: UnwatchParameters(
        f.texts("parameterNames")
    ),
    "subscribeConnectionGraph": lambda _: WatchGraph(wanted=True),
    "unsubscribeConnectionGraph": lambda _: WatchGraph(wanted=False),
    "subscribeNodes": lambda _: WatchNodes(wanted=True),
    "unsubscribeNodes": lambda _: WatchNodes(wanted=False),
    "applyGridUpdates": lambda _: ApplyGridUpdates(),
    "stepPlayback": lambda _: StepPlayback(),
    "fetchAsset": lambda f: FetchAsset(f.text("uri"), f.identifier("requestId")),
}
