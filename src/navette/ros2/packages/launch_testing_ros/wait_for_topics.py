"""Wait until messages have arrived on all of some topics."""

from collections import deque
from collections.abc import Iterable
from threading import Event, Thread
from types import TracebackType
from typing import Any, Self
from uuid import uuid4

from navette.runtime import (
    Context,
    ExternalShutdownException,
    Node,
    SingleThreadedExecutor,
)


class WaitForTopics:
    """Subscribes to topics in a node and a thread of its own.

    As a context manager it waits on entry::

        with WaitForTopics([("chatter", String)], timeout=5.0) as topics:
            print(topics.received_messages("chatter"))

    Args:
        topic_tuples: topics and their message classes.
        timeout: maximum seconds of :meth:`wait`.
        messages_received_buffer_length: number of messages kept for each topic.
    """

    def __init__(
        self,
        topic_tuples: Iterable[tuple[str, Any]],
        timeout: float = 5.0,
        messages_received_buffer_length: int = 10,
    ) -> None:
        self.topic_tuples = list(topic_tuples)
        self.timeout = timeout
        self.messages_received_buffer_length = messages_received_buffer_length
        self._complete = Event()
        self._messages: dict[str, deque[Any]] = {}
        self._context = Context()
        self._context.init()
        self._node = Node(f"_test_node_{uuid4().hex[:10]}", context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._thread = Thread(target=self._spin, name="wait_for_topics", daemon=True)
        self._thread.start()

    def _spin(self) -> None:
        try:
            self._executor.spin()
        except ExternalShutdownException:
            return  # of shutdown()

    def wait(self) -> bool:
        """Return whether all topics receive a message; earlier ones do not count."""
        self._complete.clear()
        for name, message_type in self.topic_tuples:
            if name in self._messages:
                self._messages[name].clear()
                continue
            self._messages[name] = deque(maxlen=self.messages_received_buffer_length)
            self._subscribe(name, message_type)
        return self._complete.wait(self.timeout)

    def _subscribe(self, name: str, message_type: Any) -> None:
        def keep(message: Any) -> None:
            self._messages[name].append(message)
            if not self.topics_not_received():
                self._complete.set()

        self._node.create_subscription(message_type, name, keep, 10)

    def shutdown(self) -> None:
        """End the node and its thread."""
        self._context.try_shutdown()
        self._thread.join()
        self._node.destroy_node()

    def topics_received(self) -> set[str]:
        """Return the topics with at least one message."""
        return {name for name, messages in self._messages.items() if messages}

    def topics_not_received(self) -> set[str]:
        """Return the topics without a message."""
        return {name for name, _ in self.topic_tuples} - self.topics_received()

    def received_messages(self, topic_name: str) -> list[Any]:
        """Return the last messages of a topic.

        Raises:
            KeyError: the topic is not one of them.
        """
        if topic_name not in self._messages:
            raise KeyError(f"No messages received for topic: {topic_name}")
        return list(self._messages[topic_name])

    def __enter__(self) -> Self:
        if not self.wait():
            missing = ", ".join(sorted(self.topics_not_received()))
            self.shutdown()
            raise RuntimeError(f"Did not receive messages on these topics: {missing}")
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.shutdown()
