"""Samples buffered until a step begins: which are required, and in what order."""

from typing import Any

from navette.transports import (
    DurabilityPolicy,
    Endpoint,
    EndpointKind,
    EndpointQos,
    HistoryPolicy,
    Item,
)
from navette.transports.lockstep import (
    BufferedSubscription,
    Missing,
    SampleBuffer,
    Sent,
    SentCounter,
    SubscriptionInfo,
)

LATCHED = EndpointQos(depth=2, durability=DurabilityPolicy.TRANSIENT_LOCAL)
A, B = bytes(15) + b"a", bytes(15) + b"b"


def publisher(gid: bytes, node: str, qos: EndpointQos | None = None) -> Endpoint:
    kind = EndpointKind.PUBLISHER
    return Endpoint(
        kind, "/t", "p/msg/T", qos or EndpointQos(), node, "/", gid, "RIHS01_0"
    )


class Bench:
    """A process with one subscription, and the samples delivered to it."""

    def __init__(self, qos: EndpointQos | None = None) -> None:
        self.buffer = SampleBuffer()
        self.items: list[Item] = []
        #: Publisher and received stamp of delivered samples.
        self.delivered: list[tuple[bytes, int]] = []
        self.remotes: dict[bytes, Endpoint] = {}
        self.qos = qos or EndpointQos()
        self.subscription = self.open()

    def open(self) -> BufferedSubscription:
        info = SubscriptionInfo(
            "/t",
            self,
            sink=self.items.append,
            is_latched=self.qos.is_latched,
            depth=self.qos.queue_length,
        )
        return self.buffer.open(info)

    def publishers(self) -> dict[bytes, Endpoint]:
        return self.remotes

    def on_sample(self, gid: bytes, item: Item) -> None:
        self.delivered.append((gid, item[2]))

    def begin(self) -> None:
        """Begin the first step, with no samples sent before."""
        sent = {gid: Sent(e.node_full_name, 1, 0, 0) for gid, e in self.remotes.items()}
        assert self.buffer.expect(sent)
        self.buffer.release(0)

    def receive(self, gid: bytes, *numbers: int, source_ns: int = 5) -> None:
        for number in numbers:
            self.subscription.take(
                gid, (f"{gid[-1:].decode()}{number}", source_ns, 1, number)
            )

    def released(self, now_ns: int = 10) -> list[Any]:
        self.items.clear()
        self.buffer.release(now_ns)
        assert all(item[2] == now_ns for item in self.items), "received stamps"
        return [item[0] for item in self.items]


def with_two() -> Bench:
    bench = Bench()
    bench.remotes = {A: publisher(A, "a"), B: publisher(B, "b")}
    bench.begin()
    return bench


def test_a_step_waits_for_all_samples_of_the_previous_one() -> None:
    bench, calls = with_two(), []
    bench.buffer.on_complete = lambda: calls.append(True)
    bench.receive(B, 1)
    assert not bench.buffer.expect({A: Sent("/a", 1, 2, 2), B: Sent("/b", 1, 1, 1)})
    assert bench.buffer.missing() == [Missing("/t", "/a", 2)]
    bench.receive(A, 2)
    assert not calls
    bench.receive(A, 1)
    assert calls == [True]
    assert bench.released() == ["a1", "a2", "b1"]


def test_samples_of_a_later_step_wait_for_it() -> None:
    bench = with_two()
    bench.receive(A, 1, 2)
    assert bench.buffer.expect({A: Sent("/a", 1, 1, 1)})
    assert bench.released() == ["a1"]
    assert bench.buffer.expect({A: Sent("/a", 1, 2, 2)})
    assert bench.released() == ["a2"]


def test_duplicates_are_dropped() -> None:
    bench = with_two()
    bench.receive(A, 1, 1)
    assert bench.buffer.expect({A: Sent("/a", 1, 1, 1)})
    assert bench.released() == ["a1"]
    bench.receive(A, 1)
    assert bench.buffer.expect({})
    assert bench.released() == []


def test_numbers_that_were_never_sent_are_not_required() -> None:
    """Without a subscription a publisher counts its messages but sends none."""
    bench = with_two()
    bench.receive(A, 7, 9)
    assert bench.buffer.expect({A: Sent("/a", 1, 2, 9)})
    assert bench.released() == ["a7", "a9"]


def test_volatile_samples_from_before_the_first_step_are_dropped() -> None:
    bench = Bench()
    bench.remotes = {A: publisher(A, "a")}
    bench.receive(A, 1)
    assert bench.buffer.expect({A: Sent("/a", 1, 2, 2)})
    bench.receive(A, 2)
    assert bench.released() == []


def test_latched_samples_from_before_the_first_step_are_delivered() -> None:
    bench = Bench(LATCHED)
    bench.remotes = {A: publisher(A, "a", LATCHED)}
    assert not bench.buffer.expect({A: Sent("/a", 1, 5, 5)})
    bench.receive(A, 3, 4)
    assert not bench.buffer.is_complete()
    bench.receive(A, 5)
    assert bench.released() == ["a4", "a5"], "the smaller depth of the two"


def test_keep_all_receives_as_many_as_the_publisher_keeps() -> None:
    everything = EndpointQos(
        history=HistoryPolicy.KEEP_ALL, durability=DurabilityPolicy.TRANSIENT_LOCAL
    )
    bench = Bench(everything)
    bench.remotes = {A: publisher(A, "a", LATCHED)}
    bench.receive(A, 1, 2, 3)
    assert bench.buffer.expect({A: Sent("/a", 1, 3, 3)})
    assert bench.released() == ["a2", "a3"]


def test_a_new_publisher_is_received_from_its_first_sample() -> None:
    bench = with_two()
    late = bytes(15) + b"c"
    bench.receive(late, 1)  # before its publisher is known
    bench.remotes[late] = publisher(late, "c")
    assert bench.buffer.expect({late: Sent("/c", 1, 1, 1)})
    assert bench.released() == ["c1"]


def test_a_new_subscription_receives_the_steps_after_it() -> None:
    bench = with_two()
    assert bench.buffer.expect({A: Sent("/a", 1, 1, 1)}) is False
    bench.receive(A, 1)
    bench.released()
    bench.subscription.close()
    bench.subscription = bench.open()
    bench.receive(A, 2)  # may arrive before or after the subscription
    assert bench.buffer.expect({A: Sent("/a", 1, 3, 3)})
    assert bench.released() == []
    bench.receive(A, 4)
    assert bench.buffer.expect({A: Sent("/a", 1, 4, 4)})
    assert bench.released() == ["a4"]


def test_only_samples_that_were_sent_are_required_of_a_closed_publisher() -> None:
    bench = with_two()
    bench.receive(A, 1)
    del bench.remotes[A]
    assert bench.buffer.expect({A: Sent("/a", 1, 1, 1)})
    assert bench.released() == ["a1"]
    assert bench.buffer.expect({})


def test_publishers_outside_the_lock_step_are_delivered_last() -> None:
    """Their samples arrive at arbitrary times, so they wait for a whole step."""
    bench = with_two()
    outsider = bytes(15) + b"x"
    bench.receive(outsider, 1, 2)
    bench.receive(A, 1)
    assert bench.buffer.expect({A: Sent("/a", 1, 1, 1)})
    assert bench.released() == ["a1"]
    bench.receive(A, 2)
    assert bench.buffer.expect({A: Sent("/a", 1, 2, 2)})
    assert bench.released() == ["a2", "x1", "x2"]


def test_samples_from_outside_are_limited() -> None:
    bench = with_two()
    outsider = bytes(15) + b"x"
    bench.receive(outsider, *range(1, 3001))
    bench.released()
    assert len(bench.released()) == 1000


def test_nothing_is_required_for_a_closed_subscription() -> None:
    bench, calls = with_two(), []
    bench.buffer.on_complete = lambda: calls.append(True)
    assert not bench.buffer.expect({A: Sent("/a", 1, 1, 1)})
    bench.subscription.close()
    assert calls == [True]
    bench.subscription.close()


def test_counts_are_reported_until_they_are_granted() -> None:
    counter = SentCounter()
    first, second = counter.open(A, "/n"), counter.open(B, "/n")
    first.add(4)
    first.add(6)
    assert counter.changed() == {A: Sent("/n", 1, 2, 6), B: Sent("/n", 2, 0, 0)}
    reported = counter.changed()
    second.add(1)  # after the report
    counter.granted(reported)
    assert counter.changed() == {B: Sent("/n", 2, 1, 1)}


def test_a_sample_counts_as_received_when_it_is_delivered() -> None:
    bench = Bench()
    bench.remotes[A] = publisher(A, "n")
    bench.begin()
    bench.receive(A, 1)
    assert bench.delivered == []
    assert bench.buffer.expect({A: Sent("/n", 1, 1, 1)})
    bench.released(30)
    assert bench.delivered == [(A, 30)]
