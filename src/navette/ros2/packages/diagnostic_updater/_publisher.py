"""Tasks about a topic, told of each message or publishing it themselves."""

from typing import Any

from navette.ros2.packages.diagnostic_updater._diagnostic_updater import (
    CompositeDiagnosticTask,
    Updater,
)
from navette.ros2.packages.diagnostic_updater._update_functions import (
    FrequencyStatus,
    FrequencyStatusParam,
    TimeStampStatus,
    TimeStampStatusParam,
)
from navette.runtime import Publisher, Time


class HeaderlessTopicDiagnostic(CompositeDiagnosticTask):
    """How often messages come that have no header.

    Args:
        name: the topic's.
        diag: the updater that it is added to; its node's clock counts.
        freq: what is expected.
    """

    def __init__(self, name: str, diag: Updater, freq: FrequencyStatusParam) -> None:
        super().__init__(f"{name} topic status")
        self.diag = diag
        self.freq = FrequencyStatus(freq, clock=diag.node.get_clock())
        self.addTask(self.freq)
        diag.add(self)

    def tick(self) -> None:
        """A message came or went."""
        self.freq.tick()

    def clear_window(self) -> None:
        """Count anew."""
        self.freq.clear()


class TopicDiagnostic(HeaderlessTopicDiagnostic):
    """How often messages come, and whether their stamps are about now."""

    def __init__(
        self,
        name: str,
        diag: Updater,
        freq: FrequencyStatusParam,
        stamp: TimeStampStatusParam,
    ) -> None:
        super().__init__(name, diag, freq)
        self.stamp = TimeStampStatus(stamp, clock=diag.node.get_clock())
        self.addTask(self.stamp)

    def tick(self, stamp: Time | float) -> None:  # type: ignore[override]
        """A message with that stamp came or went."""
        self.stamp.tick(stamp)
        super().tick()


class DiagnosedPublisher(TopicDiagnostic):
    """A publisher whose messages are looked at as they go."""

    def __init__(
        self,
        pub: Publisher[Any],
        diag: Updater,
        freq: FrequencyStatusParam,
        stamp: TimeStampStatusParam,
    ) -> None:
        super().__init__(pub.topic_name, diag, freq, stamp)
        self.publisher = pub

    def publish(self, message: Any) -> None:
        """Publish a message with a header."""
        self.tick(Time.from_msg(message.header.stamp))
        self.publisher.publish(message)
