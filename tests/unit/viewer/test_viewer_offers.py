"""Messages on their way from the executor's thread to the sockets' thread."""

import asyncio
from collections.abc import Iterable

from navette.viewer.offers import Offer, OfferQueue
from navette.viewer.replies import Channel
from navette.viewer.session import Watch


def test_messages_that_follow_a_delivery_need_no_wake_up() -> None:
    watch = Watch(Channel(1, "/odom", "nav_msgs/msg/Odometry", ""), None)
    batches: list[list[int]] = []

    async def deliver_all() -> None:
        loop = asyncio.get_running_loop()
        wake_ups = 0
        schedule = loop.call_soon_threadsafe

        def wake_up(*call: object, **options: object) -> asyncio.Handle:
            nonlocal wake_ups
            wake_ups += 1
            return schedule(*call, **options)  # type: ignore[arg-type]

        loop.call_soon_threadsafe = wake_up  # type: ignore[method-assign]
        arrived = asyncio.Event()

        def deliver(offers: Iterable[Offer]) -> None:
            batches.append([stamp_ns for _, stamp_ns, _ in offers])
            if len(batches) < 3:
                for stamp_ns in (10 * len(batches), 10 * len(batches) + 1):
                    queue.add(watch, stamp_ns, b"")
            else:
                arrived.set()

        queue = OfferQueue(loop, deliver=deliver)
        queue.add(watch, 1, b"")
        await arrived.wait()
        assert wake_ups == 1

    asyncio.run(deliver_all())
    assert batches == [[1], [10, 11], [20, 21]]
