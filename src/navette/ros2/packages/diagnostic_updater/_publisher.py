"""Tasks that monitor the messages of a topic."""

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
    """Monitor of the rate of messages without a header.

    Args:
        name: name of the topic.
        diag: the updater to which the task is added; its node's clock is used.
        freq: the expected rate.
    """

    def __init__(self, name: str, diag: Updater, freq: FrequencyStatusParam) -> None:
        super().__init__(f"{name} topic status")
        self.diag = diag
        self.freq = FrequencyStatus(freq, clock=diag.node.get_clock())
        self.addTask(self.freq)
        diag.add(self)

    def tick(self) -> None:
        self.freq.tick()

    def clear_window(self) -> None:
        self.freq.clear()


class TopicDiagnostic(HeaderlessTopicDiagnostic):
    """Monitor of the rate and the stamps of messages."""

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

    def tick(self, stamp: Time | float) -> None:  # type: ignore[override] # ROS 2's signature
        self.stamp.tick(stamp)
        super().tick()


class DiagnosedPublisher(TopicDiagnostic):
    """Publisher that monitors its messages."""

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
        self.tick(Time.from_msg(message.header.stamp))
        self.publisher.publish(message)
