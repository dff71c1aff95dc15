"""Zenoh's threads keep their Python thread state between two callbacks."""

import threading

import zenoh
from transport_pairs import until

from free_ports import free_endpoint
from navette.transports.zenoh.callbacks import direct

SAMPLES = 200


def session(listen: list[str], connect: list[str]) -> zenoh.Session:
    config = zenoh.Config.from_json5(
        f'{{mode: "peer", scouting: {{multicast: {{enabled: false}}}}, '
        f"listen: {{endpoints: {listen}}}, connect: {{endpoints: {connect}}}}}"
    )
    return zenoh.open(config)


def test_a_thread_of_zenoh_keeps_what_belongs_to_it() -> None:
    own = threading.local()
    counts: dict[int, list[int]] = {}

    def receive(sample: zenoh.Sample) -> None:
        own.count = getattr(own, "count", 0) + 1
        counts.setdefault(threading.get_native_id(), []).append(own.count)

    where = free_endpoint()
    with session([where], []) as reader, session([], [where]) as writer:
        reader.declare_subscriber("count", direct(receive))
        publisher = writer.declare_publisher("count")
        until(lambda: bool(publisher.matching_status.matching), "the reader")
        for number in range(1, SAMPLES + 1):
            publisher.put(b"")
            until(
                lambda n=number: sum(map(len, counts.values())) == n, f"sample {number}"
            )
    # Without a kept state, each call would find an empty thread-local object.
    for each in counts.values():
        assert each == list(range(1, len(each) + 1))
