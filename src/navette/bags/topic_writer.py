"""Interface of the writers of a recording, independent of the file format."""

import re
from abc import ABC, abstractmethod
from pathlib import Path
from typing import Any

from navette.bags.bag import (
    BagAttachment,
    BagMessage,
    BagTopic,
    MetadataRecord,
    RecordedMessage,
)
from navette.errors import FileFormatError, join_names

_NAMED = 3


class UnsupportedTopicError(FileFormatError):
    """A format cannot represent a topic; its messages are left out."""


class Losses:
    """Parts of a recording that its copy lacks, counted by kind and named."""

    def __init__(self) -> None:
        self._counts: dict[str, dict[str, int]] = {}

    def add(self, kind: str, name: str, count: int = 1) -> None:
        """Count a part.

        Args:
            kind: in the plural: ``attachments``, ``publish times``, …
            name: of the part or of its topic.
        """
        names = self._counts.setdefault(kind, {})
        names[name] = names.get(name, 0) + count

    def __bool__(self) -> bool:
        return bool(self._counts)

    @property
    def lines(self) -> list[str]:
        """One line for each kind: number and names."""
        lines = []
        for kind, names in self._counts.items():
            count = sum(names.values())
            counted = _singular(kind) if count == 1 else kind
            lines.append(f"{count} {counted} ({join_names(list(names), _NAMED)})")
        return lines


def _singular(kind: str) -> str:
    """Return ``message with a stamp`` for ``messages with a stamp``."""
    for ending, one in (("entries", "entry"), ("s", "")):
        found = re.search(rf"{ending}\b", kind)
        if found:
            return kind[: found.start()] + one + kind[found.end() :]
    return kind


class TopicWriter(ABC):
    """Writer of a recording."""

    keeps_encoding = False
    """Whether messages of any encoding can be written, not only CDR."""

    def __init__(self, path: Path) -> None:
        self.path = path
        #: Messages written so far.
        self.message_count = 0
        #: Parts that the format cannot hold.
        self.losses = Losses()
        self._channels: dict[BagTopic, Any] = {}

    def add_topic(self, topic: BagTopic) -> None:
        """Add a topic, possibly without messages.

        Raises:
            UnsupportedTopicError: the format cannot represent the topic.
        """
        self.channel_of(topic)

    def channel_of(self, topic: BagTopic) -> Any:
        """Return the format's own record of a topic, which is added if necessary."""
        channel = self._channels.get(topic)
        if channel is None:
            channel = self._channels[topic] = self._add(topic)
        return channel

    def add_attachment(self, attachment: BagAttachment) -> None:
        """Add a file; a loss if the format has none."""
        self.losses.add("attachments", attachment.name)

    def add_metadata(self, record: MetadataRecord) -> None:
        """Add named texts; a loss if the format has none."""
        self.losses.add("metadata records", record.name)

    @abstractmethod
    def _add(self, topic: BagTopic) -> Any: ...

    @abstractmethod
    def write(self, message: BagMessage | RecordedMessage) -> None:
        """Append a message; adds its topic if necessary.

        Raises:
            FileFormatError: the format cannot represent it, or the disk is full.
        """

    @abstractmethod
    def close(self) -> None:
        """Finish the file and move it to its target."""

    @abstractmethod
    def abandon(self) -> None:
        """Delete the unfinished file; a file to be replaced stays."""

    def _error(self, error: Exception) -> FileFormatError:
        reason = getattr(error, "strerror", None) or error
        return FileFormatError(self.path, f"cannot be written: {reason}")

    def _note_losses(self, message: BagMessage | RecordedMessage) -> None:
        """Count what formats without publish times and sequence numbers lose."""
        if not isinstance(message, RecordedMessage):
            return
        name = message.topic.name
        if message.publish_ns not in (None, message.stamp_ns):
            self.losses.add("publish times", name)
        if message.sequence:
            self.losses.add("sequence numbers", name)


_KEPT_KEYS = {"offered_qos_profiles", "topic_type_hash"}


def other_metadata(topic: BagTopic) -> list[str]:
    """Return the keys of a channel's metadata that only MCAP can hold."""
    if topic.channel is None:
        return []
    return [
        key for key, value in topic.channel.metadata if value and key not in _KEPT_KEYS
    ]
