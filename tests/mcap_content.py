"""Everything in an MCAP file, as the official ``mcap`` library reads it."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mcap.records import Attachment, Channel, Header, Message, Metadata, Schema
from mcap.stream_reader import StreamReader


@dataclass(frozen=True)
class McapContent:
    """Records without their order, ids and place in the file."""

    profile: str
    channels: frozenset[tuple[Any, ...]]
    messages: list[tuple[Any, ...]]
    """Channel, sequence, log and publish time, data; by log time."""
    attachments: list[tuple[Any, ...]]
    metadata: list[tuple[Any, ...]]


def mcap_content(path: Path) -> McapContent:
    """Read all records of the data section.

    Raises:
        McapError: the library refuses the file.
    """
    schemas: dict[int, Schema] = {}
    channels: dict[int, tuple[Any, ...]] = {}
    profile = ""
    messages, attachments, metadata = [], [], []
    for record in _data_section(path):
        match record:
            case Header():
                profile = record.profile
            case Schema():
                schemas[record.id] = record
            case Channel():
                channels[record.id] = _channel(record, schemas)
            case Message():
                messages.append(
                    (
                        channels[record.channel_id],
                        record.sequence,
                        record.log_time,
                        record.publish_time,
                        record.data,
                    )
                )
            case Attachment():
                attachments.append(tuple(vars(record).items()))
            case Metadata():
                metadata.append((record.name, tuple(sorted(record.metadata.items()))))
    messages.sort(key=lambda message: message[2])
    return McapContent(
        profile, frozenset(channels.values()), messages, attachments, metadata
    )


def _data_section(path: Path) -> Iterator[Any]:
    with path.open("rb") as file:
        for record in StreamReader(file, validate_crcs=True).records:
            if type(record).__name__ == "DataEnd":
                return
            yield record


def _channel(channel: Channel, schemas: dict[int, Schema]) -> tuple[Any, ...]:
    schema = schemas.get(channel.schema_id)
    return (
        channel.topic,
        channel.message_encoding,
        None if schema is None else (schema.name, schema.encoding, schema.data),
        tuple(sorted(channel.metadata.items())),
    )
