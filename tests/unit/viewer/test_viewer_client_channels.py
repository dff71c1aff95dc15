"""Channels on which clients publish: opened, closed, refused, limited."""

from viewer_fakes import Bench, sent

from navette.viewer.frames import ClientChannel


def test_clients_publish_on_channels_that_they_advertised(bench: Bench) -> None:
    session = bench.join()
    assert bench.advertise(session) == []
    bench.hub.receive(session, b"\x01\x01\x00\x00\x00{}")
    bench.ask(session, op="unadvertise", channelIds=[1])
    channel = ClientChannel(1, "/goal_point", "json", "geometry_msgs/msg/PointStamped")
    assert bench.program.take() == [
        ("open", session.id, channel),
        ("publish", session.id, 1, b"{}"),
        ("close", session.id, 1),
    ]
    bench.hub.receive(session, b"\x01\x01\x00\x00\x00{}")
    (status,) = sent(session.outbox)
    assert "channel 1 is not advertised" in status["message"]
    assert bench.program.take() == []


def test_invalid_channels_are_refused(bench: Bench) -> None:
    session = bench.join()
    (status,) = bench.advertise(session, encoding="protobuf")
    assert "known: cdr, json" in status["message"]
    bench.advertise(session)
    (status,) = bench.advertise(session)
    assert "channel id 1 is in use" in status["message"]
    for number in range(2, 400):
        replies = bench.advertise(session, id=number)
    assert "64 channels at most" in replies[0]["message"]


def test_publishers_of_a_client_end_with_it(bench: Bench) -> None:
    session = bench.join()
    bench.advertise(session)
    bench.program.take()
    bench.hub.leave(session)
    assert bench.program.take() == [("close", session.id, 1)]
    bench.hub.done(session.id)
    assert bench.hub.clients == 0


def test_all_clients_together_open_a_bounded_number_of_channels(bench: Bench) -> None:
    for _ in range(5):
        session = bench.join()
        for number in range(64):
            replies = bench.advertise(session, id=number)
    assert "all clients together can open 256 channels" in replies[0]["message"]
