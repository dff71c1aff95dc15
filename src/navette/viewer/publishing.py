"""Messages that clients publish: decoding, and the publishers they use."""

import functools
import json
from typing import Any

from navette.errors import DecodeError
from navette.files.untrusted.budget import CLIENT_MESSAGE, BudgetMeter
from navette.msgs import (
    Message,
    deserialize,
    fields,
    from_dict,
    get_interface,
    serialize,
)
from navette.viewer.frames import ClientChannel, check_containers
from navette.viewer.graph_access import GraphAccess

_DEPTH = 10  # messages, as in rclpy's default profile
_MAX_CONTAINERS = 10_000  # lists and objects of a JSON message


class ClientPublishers:
    """The publishers that clients opened, by client and the client's channel id.

    All methods raise NavetteError for types, topics and data that cannot be published.
    """

    def __init__(self, *, graph: GraphAccess) -> None:
        self._graph = graph
        self._opened: dict[tuple[int, int], tuple[str, Any]] = {}

    def open(self, client: int, channel: ClientChannel) -> None:
        interface = get_interface(channel.type_name)
        publisher = self._graph.create_publisher(interface, channel.topic, _DEPTH)
        self._opened[client, channel.id] = channel.encoding, publisher

    def close(self, client: int, channel_id: int) -> None:
        opened = self._opened.pop((client, channel_id), None)
        if opened is not None:
            self._graph.destroy_publisher(opened[1])

    def publish(self, client: int, channel_id: int, data: bytes) -> None:
        opened = self._opened.get((client, channel_id))
        if opened is not None:
            encoding, publisher = opened
            publisher.publish(decode_message(encoding, publisher.msg_type, data))


def decode_message(encoding: str, cls: type[Message], data: bytes) -> Message:
    """Decode a client's message, ``cdr`` or ``json``.

    Missing JSON fields keep their defaults; the nanoseconds of a stamp may be called
    ``nsec``, as Foxglove does, or ``nanosec``.

    Raises:
        DecodeError: the bytes are not a message of this type.
        MessageError: a field is unknown or has the wrong type; names the field.
        BudgetError: the message is too large.
    """
    if encoding == "cdr":
        if _has_lists_of_objects(cls._type_name_):
            # Decoded one by one, other arrays at once.
            CLIENT_MESSAGE.check_octets(len(data), f"{cls._type_name_} message")
        return deserialize(data, cls)
    CLIENT_MESSAGE.check_octets(len(data), "JSON message")
    check_containers(data.count(b"[") + data.count(b"{"), _MAX_CONTAINERS)
    try:
        document = json.loads(data)
    except (ValueError, RecursionError) as error:
        raise DecodeError(f"message is not JSON: {error}") from None
    if not isinstance(document, dict):
        raise DecodeError("message is not a JSON object")
    msg = from_dict(cls, _with_ros_names(document, BudgetMeter(CLIENT_MESSAGE)))
    serialize(msg)  # raises for text that is not Unicode, before any node receives it
    return msg


@functools.cache
def _has_lists_of_objects(type_name: str) -> bool:
    """Whether the number of objects in a message depends on its data."""
    kinds = [field.type for field in fields(get_interface(type_name))]
    return any(
        (not kind.is_numeric and not kind.is_scalar)
        or (kind.is_message and _has_lists_of_objects(kind.base))
        for kind in kinds
    )


def _with_ros_names(value: Any, meter: BudgetMeter) -> Any:
    """Rename {sec, nsec} to {sec, nanosec}, at any permitted depth."""
    if not isinstance(value, list | dict):
        return value
    meter.spend_items(len(value))
    with meter.nested():
        if isinstance(value, list):
            return [_with_ros_names(item, meter) for item in value]
        if value.keys() == {"sec", "nsec"}:
            return {"sec": value["sec"], "nanosec": value["nsec"]}
        return {name: _with_ros_names(item, meter) for name, item in value.items()}
