"""Content and order of a step do not depend on the order of arrival."""

from hypothesis import given
from hypothesis import strategies as st

from lockstep_fakes import Publishers
from navette.transports import Endpoint, EndpointKind, EndpointQos, Item
from navette.transports.lockstep import SampleBuffer, Sent, SubscriptionInfo

TOPICS = ("/a", "/b")
PUBLISHERS = {
    bytes([number] * 16): (TOPICS[number % 2], f"n{number // 3}", number)
    for number in range(6)
}
Arrival = tuple[bytes, int, int]

#: Source stamps of each publisher's samples, oldest first.
sendings = st.fixed_dictionaries(
    {gid: st.lists(st.integers(0, 5), max_size=4).map(sorted) for gid in PUBLISHERS}
)


def endpoint(gid: bytes) -> Endpoint:
    topic, node, _ = PUBLISHERS[gid]
    qos, kind = EndpointQos(), EndpointKind.PUBLISHER
    return Endpoint(kind, topic, "p/msg/T", qos, node, "/", gid, "RIHS01_0")


def run(
    arrivals: list[Arrival], sent: dict[bytes, Sent], early: int
) -> list[tuple[str, Item]]:
    """Return what two subscriptions of each topic receive, in order.

    Args:
        early: samples that arrive before the end of the step is known.
    """
    buffer, got = SampleBuffer(), []
    subscriptions = []
    for topic in (*TOPICS, *TOPICS):
        remotes = {g: endpoint(g) for g, p in PUBLISHERS.items() if p[0] == topic}
        name = f"{topic}{len(subscriptions)}"
        info = SubscriptionInfo(
            topic,
            Publishers(remotes),
            sink=lambda item, name=name: got.append((name, item)),
            depth=10,
        )
        subscription = buffer.open(info)
        subscriptions.append((topic, subscription))
    buffer.expect({g: Sent(p[1], p[2], 0, 0) for g, p in PUBLISHERS.items()})

    def arrive(part: list[Arrival]) -> None:
        for gid, source_ns, number in part:
            for topic, subscription in subscriptions:
                if topic == PUBLISHERS[gid][0]:
                    subscription.take(gid, ((gid, number), source_ns, 99, number))

    arrive(arrivals[:early])
    complete = buffer.expect(sent)
    assert complete == (buffer.missing() == [])
    arrive(arrivals[early:])
    assert buffer.is_complete()
    buffer.release(7)
    return got


@given(sendings, st.data())
def test_the_order_does_not_depend_on_the_arrival(
    sendings: dict[bytes, list[int]], data: st.DataObject
) -> None:
    in_order = [
        (gid, time_ns, number)
        for gid, times in sendings.items()
        for number, time_ns in enumerate(times, start=1)
    ]
    sent = {
        gid: Sent(PUBLISHERS[gid][1], PUBLISHERS[gid][2], len(times), len(times))
        for gid, times in sendings.items()
    }
    doubled = data.draw(st.lists(st.sampled_from(in_order))) if in_order else []
    arrivals = data.draw(st.permutations(in_order + doubled))
    early = data.draw(st.integers(0, len(arrivals)))
    expected = run(in_order, sent, 0)
    assert run(arrivals, sent, early) == expected
    assert len(expected) == 2 * len(in_order)
    by_time = [item[1] for _, item in expected]
    assert by_time == sorted(by_time)
    for gid in PUBLISHERS:  # the order of each publisher is kept
        for name in {name for name, _ in expected}:
            own = [i[3] for n, i in expected if n == name and i[0][0] == gid]
            assert own == sorted(own)
