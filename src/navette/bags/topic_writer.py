"""Interface of the writers of a recording, independent of the file format."""

from abc import ABC, abstractmethod
from pathlib import Path
from typing import Any

from navette.bags.bag import BagMessage, BagTopic
from navette.errors import FileFormatError


class TopicWriter(ABC):
    """Writer of a recording."""

    def __init__(self, path: Path) -> None:
        self.path = path
        #: Messages written so far.
        self.message_count = 0
        self._channels: dict[BagTopic, Any] = {}

    def add_topic(self, topic: BagTopic) -> None:
        """Add a topic, possibly without messages.

        Raises:
            FileFormatError: the format cannot represent the topic.
        """
        self.channel_of(topic)

    def channel_of(self, topic: BagTopic) -> Any:
        """Return the format's own record of a topic, which is added if necessary."""
        if topic not in self._channels:
            self._channels[topic] = self._add(topic)
        return self._channels[topic]

    @abstractmethod
    def _add(self, topic: BagTopic) -> Any: ...

    @abstractmethod
    def write(self, message: BagMessage) -> None:
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
