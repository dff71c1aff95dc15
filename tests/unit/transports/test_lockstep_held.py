"""Samples held until a step begins: which are awaited, which go, in what order."""

from typing import Any

from navette.transports import (
    DurabilityPolicy,
    Endpoint,
    EndpointKind,
    EndpointQos,
    HistoryPolicy,
    Item,
)
from navette.transports.lockstep import HeldSamples, Holding, Missing, Sent, SentTally

LATCHED = EndpointQos(depth=2, durability=DurabilityPolicy.TRANSIENT_LOCAL)
A, B = bytes(15) + b"a", bytes(15) + b"b"


def publisher(gid: bytes, node: str, qos: EndpointQos | None = None) -> Endpoint:
    kind = EndpointKind.PUBLISHER
    return Endpoint(
        kind, "/t", "p/msg/T", qos or EndpointQos(), node, "/", gid, "RIHS01_0"
    )


class Bench:
    """A process with one subscription, and what it was given."""

    def __init__(self, qos: EndpointQos | None = None) -> None:
        self.held = HeldSamples()
        self.items: list[Item] = []
        #: Whose samples were given, and when.
        self.heard: list[tuple[bytes, int]] = []
        self.remotes: dict[bytes, Endpoint] = {}
        self.qos = qos or EndpointQos()
        self.holding = self.open()

    def open(self) -> Holding:
        return self.held.open(
            "/t",
            self.items.append,
            lambda: self.remotes,
            is_latched=self.qos.is_latched,
            depth=self.qos.queue_length,
            heard=lambda gid, item: self.heard.append((gid, item[2])),
        )

    def begins(self) -> None:
        """The first step, with nothing sent before."""
        sent = {gid: Sent(e.node_full_name, 1, 0, 0) for gid, e in self.remotes.items()}
        assert self.held.expect(sent)
        self.held.release(0)

    def come(self, gid: bytes, *numbers: int, source_ns: int = 5) -> None:
        for number in numbers:
            self.holding.take(
                gid, (f"{gid[-1:].decode()}{number}", source_ns, 1, number)
            )

    def released(self, now_ns: int = 10) -> list[Any]:
        self.items.clear()
        self.held.release(now_ns)
        assert all(item[2] == now_ns for item in self.items), "received stamps"
        return [item[0] for item in self.items]


def with_two() -> Bench:
    bench = Bench()
    bench.remotes = {A: publisher(A, "a"), B: publisher(B, "b")}
    bench.begins()
    return bench


def test_a_step_waits_for_all_that_was_sent() -> None:
    bench, told = with_two(), []
    bench.held.on_complete = lambda: told.append(True)
    bench.come(B, 1)
    assert not bench.held.expect({A: Sent("/a", 1, 2, 2), B: Sent("/b", 1, 1, 1)})
    assert bench.held.missing() == [Missing("/t", "/a", 2)]
    bench.come(A, 2)
    assert not told
    bench.come(A, 1)
    assert told == [True]
    assert bench.released() == ["a1", "a2", "b1"]


def test_what_was_sent_in_the_next_step_waits_for_it() -> None:
    bench = with_two()
    bench.come(A, 1, 2)
    assert bench.held.expect({A: Sent("/a", 1, 1, 1)})
    assert bench.released() == ["a1"]
    assert bench.held.expect({A: Sent("/a", 1, 2, 2)})
    assert bench.released() == ["a2"]


def test_what_comes_twice_goes_once() -> None:
    bench = with_two()
    bench.come(A, 1, 1)
    assert bench.held.expect({A: Sent("/a", 1, 1, 1)})
    assert bench.released() == ["a1"]
    bench.come(A, 1)
    assert bench.held.expect({})
    assert bench.released() == []


def test_numbers_that_were_never_sent_are_not_waited_for() -> None:
    """A publisher counts what it publishes; while nobody listens nothing is sent."""
    bench = with_two()
    bench.come(A, 7, 9)
    assert bench.held.expect({A: Sent("/a", 1, 2, 9)})
    assert bench.released() == ["a7", "a9"]


def test_what_was_sent_before_the_beginning_is_gone() -> None:
    bench = Bench()
    bench.remotes = {A: publisher(A, "a")}
    bench.come(A, 1)
    assert bench.held.expect({A: Sent("/a", 1, 2, 2)})
    bench.come(A, 2)
    assert bench.released() == []


def test_what_was_kept_before_the_beginning_comes() -> None:
    bench = Bench(LATCHED)
    bench.remotes = {A: publisher(A, "a", LATCHED)}
    assert not bench.held.expect({A: Sent("/a", 1, 5, 5)})
    bench.come(A, 3, 4)
    assert not bench.held.is_complete()
    bench.come(A, 5)
    assert bench.released() == ["a4", "a5"], "as many as both keep"


def test_a_recorder_gets_as_many_as_the_publisher_keeps() -> None:
    everything = EndpointQos(
        history=HistoryPolicy.KEEP_ALL, durability=DurabilityPolicy.TRANSIENT_LOCAL
    )
    bench = Bench(everything)
    bench.remotes = {A: publisher(A, "a", LATCHED)}
    bench.come(A, 1, 2, 3)
    assert bench.held.expect({A: Sent("/a", 1, 3, 3)})
    assert bench.released() == ["a2", "a3"]


def test_a_publisher_that_comes_later_is_heard_from_its_first_sample() -> None:
    bench = with_two()
    late = bytes(15) + b"c"
    bench.come(late, 1)  # before it is known
    bench.remotes[late] = publisher(late, "c")
    assert bench.held.expect({late: Sent("/c", 1, 1, 1)})
    assert bench.released() == ["c1"]


def test_a_subscription_that_comes_later_hears_the_steps_after_it() -> None:
    bench = with_two()
    assert bench.held.expect({A: Sent("/a", 1, 1, 1)}) is False
    bench.come(A, 1)
    bench.released()
    bench.holding.close()
    bench.holding = bench.open()
    bench.come(A, 2)  # it may have come in time, or not
    assert bench.held.expect({A: Sent("/a", 1, 3, 3)})
    assert bench.released() == []
    bench.come(A, 4)
    assert bench.held.expect({A: Sent("/a", 1, 4, 4)})
    assert bench.released() == ["a4"]


def test_who_has_gone_is_waited_for_no_more_than_it_sent() -> None:
    bench = with_two()
    bench.come(A, 1)
    del bench.remotes[A]
    assert bench.held.expect({A: Sent("/a", 1, 1, 1)})
    assert bench.released() == ["a1"]
    assert bench.held.expect({})


def test_strangers_go_last_and_after_a_whole_step() -> None:
    """Who is not in the lock-step, and whose arrival is chance."""
    bench = with_two()
    stranger = bytes(15) + b"x"
    bench.come(stranger, 1, 2)
    bench.come(A, 1)
    assert bench.held.expect({A: Sent("/a", 1, 1, 1)})
    assert bench.released() == ["a1"]
    bench.come(A, 2)
    assert bench.held.expect({A: Sent("/a", 1, 2, 2)})
    assert bench.released() == ["a2", "x1", "x2"]


def test_endless_strangers_do_not_fill_the_memory() -> None:
    bench = with_two()
    stranger = bytes(15) + b"x"
    bench.come(stranger, *range(1, 3001))
    bench.released()
    assert len(bench.released()) == 1000


def test_a_subscription_that_closes_is_not_waited_for() -> None:
    bench, told = with_two(), []
    bench.held.on_complete = lambda: told.append(True)
    assert not bench.held.expect({A: Sent("/a", 1, 1, 1)})
    bench.holding.close()
    assert told == [True]
    bench.holding.close()


def test_the_tally_counts_until_all_know() -> None:
    tally = SentTally()
    first, second = tally.open(A, "/n"), tally.open(B, "/n")
    first(4)
    first(6)
    assert tally.changed() == {A: Sent("/n", 1, 2, 6), B: Sent("/n", 2, 0, 0)}
    reported = tally.changed()
    second(1)  # after the report: for the next step
    tally.granted(reported)
    assert tally.changed() == {B: Sent("/n", 2, 1, 1)}


def test_a_publisher_is_heard_when_its_sample_is_given_not_when_it_comes() -> None:
    bench = Bench()
    bench.remotes[A] = publisher(A, "n")
    bench.begins()
    bench.come(A, 1)
    assert bench.heard == []
    assert bench.held.expect({A: Sent("/n", 1, 1, 1)})
    bench.released(30)
    assert bench.heard == [(A, 30)]
