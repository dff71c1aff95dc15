"""Wait for one message of a topic."""

from typing import Any, TypeVar

from navette.runtime.callback_groups import ReentrantCallbackGroup
from navette.runtime.node import Node
from navette.runtime.qos import QoSProfile

MsgT = TypeVar("MsgT")


def wait_for_message(
    msg_type: type[MsgT],
    node: Node,
    topic: str,
    *,
    qos_profile: QoSProfile | int = 1,
    time_to_wait: float = -1,
) -> tuple[bool, MsgT | None]:
    """Return (True, next message), or (False, None) after ``time_to_wait`` seconds.

    Events run during the wait, even if the node has no executor. A negative time means
    no limit (under a virtual clock: until no event is left).
    """
    received: list[MsgT] = []
    subscription: Any = node.create_subscription(
        msg_type,
        topic,
        received.append,
        qos_profile,
        callback_group=ReentrantCallbackGroup(),
    )

    def done() -> bool:
        # Polled, because callbacks do not run while the node has no executor.
        while (message := subscription.take()) is not None:
            received.append(message)
        return bool(received)

    loop = node.context.loop
    try:
        loop.run(until_ns=loop.deadline_ns(time_to_wait), done=done)
    finally:
        node.destroy_subscription(subscription)
    return (True, received[0]) if received else (False, None)
