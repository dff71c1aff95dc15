"""Graph and parameters for the clients that subscribe to them."""

from viewer_fakes import Bench, sent

from navette.viewer.frames import WireParameter
from navette.viewer.replies import ConnectionGraph


def test_parameter_answers_and_updates(bench: Bench) -> None:
    one, two = bench.join(), bench.join()
    bench.ask(one, op="subscribeParameterUpdates", parameterNames=["/n.a"])
    bench.ask(two, op="subscribeParameterUpdates", parameterNames=[])
    a, b = WireParameter("/n.a", 1), WireParameter("/n.b", True)
    bench.hub.reports.parameters(one.id, [b], "req")
    (answer,) = sent(one.outbox)
    assert answer["id"] == "req"
    bench.hub.reports.parameters_changed([a, b])
    (update,) = sent(one.outbox)
    assert update["parameters"] == [{"name": "/n.a", "value": 1}]
    assert len(sent(two.outbox)[0]["parameters"]) == 2
    bench.ask(one, op="unsubscribeParameterUpdates", parameterNames=["/n.a"])
    bench.ask(two, op="unsubscribeParameterUpdates", parameterNames=[])
    bench.hub.reports.parameters_changed([a, b])
    assert not one.outbox
    assert not two.outbox


def test_a_client_subscribes_to_a_bounded_number_of_parameters(bench: Bench) -> None:
    session = bench.join()
    for start in range(0, 3000, 500):
        names = [f"/a.{n}" for n in range(start, start + 500)]
        replies = bench.ask(
            session, op="subscribeParameterUpdates", parameterNames=names
        )
    assert "1000 parameters at most" in replies[0]["message"]
    assert len(session.parameter_names) == 1000


def test_the_graph_is_sent_whole_and_then_in_changes(bench: Bench) -> None:
    bench.hub.set_graph(ConnectionGraph({"/a": ("/n",)}, {}))
    session, other = bench.join(), bench.join()
    (whole,) = bench.ask(session, op="subscribeConnectionGraph")
    assert whole["publishedTopics"] == [{"name": "/a", "publisherIds": ["/n"]}]
    bench.hub.set_graph(ConnectionGraph({"/a": ("/n",)}, {"/a": ("/m",)}))
    (change,) = sent(session.outbox)
    assert change["publishedTopics"] == []
    assert change["subscribedTopics"] == [{"name": "/a", "subscriberIds": ["/m"]}]
    bench.ask(session, op="unsubscribeConnectionGraph")
    bench.hub.set_graph(ConnectionGraph({}, {}))
    assert not session.outbox
    assert not other.outbox
