"""Reader of a bag's messages in the order of their stamps."""

import re
from collections.abc import Iterator
from pathlib import Path

from navette.bags import BagMessage, BagReader, open_bag
from navette.errors import InvalidValueError
from navette.ros2.packages.rosbag2_py._info import metadata_of
from navette.ros2.packages.rosbag2_py._storage import (
    BagMetadata,
    ConverterOptions,
    MessageDefinition,
    ReadOrder,
    ReadOrderSortBy,
    StorageFilter,
    StorageOptions,
    TopicMetadata,
    topic_metadata,
)

_FORMATS = ("", "cdr")


class SequentialReader:
    """Reads serialized messages; any format that Navette reads is possible."""

    def __init__(self) -> None:
        self._reader: BagReader | None = None
        self._options = StorageOptions("")
        self._filter = StorageFilter()
        self._messages: Iterator[BagMessage] = iter(())
        self._next: BagMessage | None = None

    def open(
        self,
        storage_options: StorageOptions,
        converter_options: ConverterOptions | None = None,
    ) -> None:
        """Open a bag; messages are CDR.

        Raises:
            FileFormatError: no bag is there, or it cannot be read.
            InvalidValueError: another format is requested.
        """
        wanted = (converter_options or ConverterOptions()).output_serialization_format
        if wanted not in _FORMATS:
            raise InvalidValueError(
                f"output_serialization_format {wanted!r}: messages are read as 'cdr'"
            )
        self.close()
        self._options, self._filter = storage_options, StorageFilter()
        self._reader = open_bag(Path(storage_options.uri))
        self._read_from(storage_options.start_time_ns)

    def open_uri(self, uri: str) -> None:
        """Open a bag with default options."""
        self.open(StorageOptions(uri))

    def close(self) -> None:
        """Close the bag; a second call has no effect."""
        if self._reader is not None:
            self._reader.close()
        self._reader, self._next, self._messages = None, None, iter(())

    def has_next(self) -> bool:
        """Return whether :meth:`read_next` has a message."""
        if self._next is None:
            self._next = next(self._messages, None)
        return self._next is not None

    def read_next(self) -> tuple[str, bytes, int]:
        """Return topic, serialized message and stamp (ns) of the next message.

        Raises:
            RuntimeError: the end was reached.
        """
        if not self.has_next() or self._next is None:
            raise RuntimeError("Bag is at end. No next message.")
        message, self._next = self._next, None
        return message.topic.name, message.data, message.stamp_ns

    def seek(self, timestamp: int) -> None:
        """Continue with the first message at or after a stamp (ns)."""
        self._read_from(timestamp)

    def set_filter(self, storage_filter: StorageFilter) -> None:
        """Read only some topics, from the next message on."""
        at_ns = self._next.stamp_ns if self.has_next() and self._next else None
        self._filter = storage_filter
        if at_ns is not None:
            self._read_from(at_ns)

    def reset_filter(self) -> None:
        """Read all topics."""
        self.set_filter(StorageFilter())

    def set_read_order(self, read_order: ReadOrder) -> bool:
        """Choose the order; return False for one that is not supported."""
        by_stamp = read_order.sort_by is ReadOrderSortBy.ReceivedTimestamp
        return by_stamp and not read_order.reverse

    def get_metadata(self) -> BagMetadata:
        """Return the metadata of the bag."""
        return metadata_of(self._opened)

    def get_all_topics_and_types(self) -> list[TopicMetadata]:
        """Return all topics of the bag."""
        topics = enumerate(self._opened.topics)
        return [topic_metadata(number, topic) for number, topic in topics]

    def get_all_message_definitions(self) -> list[MessageDefinition]:
        """Return the recorded definition of each type."""
        found = {
            topic.type_name: MessageDefinition(
                topic.type_name, "ros2msg", topic.definition, topic.type_hash
            )
            for topic in self._opened.topics
            if topic.definition
        }
        return list(found.values())

    @property
    def _opened(self) -> BagReader:
        if self._reader is None:
            raise RuntimeError("Bag is not open. Call open() before reading.")
        return self._reader

    def _read_from(self, start_ns: int) -> None:
        end_ns = self._options.end_time_ns
        self._next = None
        self._messages = self._opened.messages(
            [each.name for each in self._opened.topics if self._is_wanted(each.name)],
            start_ns=max(start_ns, self._options.start_time_ns, 0),
            end_ns=None if end_ns < 0 else end_ns,
        )

    def _is_wanted(self, topic: str) -> bool:
        wanted = self._filter
        excluded = (*wanted.exclude_topics, *wanted.exclude_service_events)
        if topic in excluded:
            return False
        if wanted.regex_to_exclude and re.search(wanted.regex_to_exclude, topic):
            return False
        listed = (*wanted.topics, *wanted.services_events)
        if not listed and not wanted.regex:
            return True
        matches = bool(wanted.regex) and re.search(wanted.regex, topic) is not None
        return topic in listed or matches


class SequentialCompressionReader(SequentialReader):
    """As :class:`SequentialReader`, which reads compressed bags, too."""


def get_registered_readers() -> set[str]:
    """Return the storages that can be read."""
    return {"mcap", "sqlite3", "rosbag1"}
