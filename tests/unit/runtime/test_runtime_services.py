"""Services and clients: calls, coroutines, failures, graph queries."""

import threading
from typing import Any

import pytest

import navette
from navette.errors import CallbackError, InvalidValueError, MessageError
from navette.msgs.example_interfaces.action import Fibonacci
from navette.msgs.example_interfaces.srv import AddTwoInts
from navette.msgs.service_msgs.msg import ServiceEventInfo
from navette.msgs.std_msgs.msg import String
from navette.msgs.std_srvs.srv import SetBool, Trigger
from navette.runtime import (
    Client,
    Context,
    Executor,
    Future,
    Node,
    QoSProfile,
    Service,
    VirtualClock,
)
from navette.runtime.exceptions import (
    InvalidHandle,
    InvalidServiceNameException,
    ROSInterruptException,
    ServiceFailedError,
)
from navette.runtime.service_introspection import ServiceIntrospectionState
from navette.runtime.testing import GraphHarness
from navette.runtime.type_support import (
    NoTypeSupportImportedException,
    check_for_type_support,
    check_is_valid_msg_type,
    check_is_valid_srv_type,
)


def add(request: Any, response: Any) -> Any:
    response.sum = request.a + request.b
    return response


def make(graph: GraphHarness, name: str) -> Node:
    return graph.add(Node(name, context=graph.context))


def pair(graph: GraphHarness, callback: Any = add) -> tuple[Service, Client]:
    service = make(graph, "server").create_service(AddTwoInts, "add", callback)
    return service, make(graph, "caller").create_client(AddTwoInts, "add")


def test_call_async(graph: GraphHarness) -> None:
    _, client = pair(graph)
    future = client.call_async(AddTwoInts.Request(a=2, b=3))
    assert not future.done()
    assert client.get_pending_request(1) is future
    graph.executor.spin_until_future_complete(future)
    assert future.result() == AddTwoInts.Response(sum=5)
    with pytest.raises(KeyError):
        client.get_pending_request(1)


def test_call_from_plain_code(graph: GraphHarness) -> None:
    _, client = pair(graph)
    assert client.call(AddTwoInts.Request(a=1, b=1)).sum == 2


def test_call_from_a_callback_to_another_node(graph: GraphHarness) -> None:
    _, client = pair(graph)
    sums: list[int] = []
    make(graph, "n").create_timer(
        1.0, lambda: sums.append(client.call(AddTwoInts.Request(a=len(sums))).sum)
    )
    graph.run_for(3.5)
    assert sums == [0, 1, 2]


def test_call_from_a_callback_to_a_service_of_the_same_group(
    graph: GraphHarness,
) -> None:
    node = make(graph, "n")
    node.create_service(AddTwoInts, "add", add)
    client = node.create_client(AddTwoInts, "add")
    order: list[str] = []

    def timer() -> None:
        order.append("asked")
        order.append(f"sum {client.call(AddTwoInts.Request(a=4)).sum}")

    def other() -> None:  # not a service, so it is held with its group
        order.append("other")

    node.create_timer(1.0, timer)
    node.create_timer(1.0, other)
    graph.run_for(1.5)
    assert order == ["asked", "sum 4", "other"]


def test_services_that_call_each_other_in_one_group(graph: GraphHarness) -> None:
    node, remote = make(graph, "n"), make(graph, "remote")
    back = remote.create_client(AddTwoInts, "add")
    there = node.create_client(AddTwoInts, "twice")

    def twice(request: Any, response: Any) -> Any:
        response.sum = 2 * back.call(request).sum
        return response

    node.create_service(AddTwoInts, "add", add)
    remote.create_service(AddTwoInts, "twice", twice)
    sums: list[int] = []
    node.create_timer(
        1.0, lambda: sums.append(there.call(AddTwoInts.Request(a=1, b=2)).sum)
    )
    graph.run_for(1.5)
    assert sums == [6]


def test_an_earlier_queued_request_does_not_block_a_call(
    graph: GraphHarness,
) -> None:
    node = make(graph, "n")
    node.create_service(AddTwoInts, "add", add)
    client = node.create_client(AddTwoInts, "add")
    other = graph.node.create_client(AddTwoInts, "/add")
    gate: Future[None] = Future()
    sums: list[int] = []

    async def timer() -> None:
        await gate
        sums.append(client.call(AddTwoInts.Request(a=4)).sum)

    once = node.create_timer(1.0, timer)
    graph.run_for(1.0)
    once.cancel()
    waiting = other.call_async(AddTwoInts.Request(a=1))
    graph.run_for(1.0)
    assert not waiting.done()  # its group is held by the coroutine
    gate.set_result(None)
    graph.run_for(1.0)
    assert (sums, waiting.result().sum) == ([4], 1)


def test_call_from_another_thread() -> None:
    navette.init(args=[])
    server, caller = navette.Node("server"), navette.Node("caller")
    server.create_service(AddTwoInts, "add", add)
    client = caller.create_client(AddTwoInts, "add")
    executor = navette.SingleThreadedExecutor()
    executor.add_node(server)
    executor.add_node(caller)
    sums: list[int] = []

    def work() -> None:
        for number in range(20):
            sums.append(client.call(AddTwoInts.Request(a=number), 10.0).sum)
        executor.stop()

    thread = threading.Thread(target=work)
    server.context.loop.call_soon(thread.start)
    executor.spin()
    thread.join()
    navette.shutdown()
    assert sums == list(range(20))


def test_coroutine_callbacks(graph: GraphHarness) -> None:
    gate: Future[None] = Future()

    async def slow(request: Any, response: Any) -> Any:
        await gate
        return add(request, response)

    service, client = pair(graph, slow)
    future = client.call_async(AddTwoInts.Request(a=1))
    second = client.call_async(AddTwoInts.Request(a=2))
    graph.run_for(1.0)
    assert not future.done()
    gate.set_result(None)
    graph.run_for(1.0)
    assert (future.result().sum, second.result().sum) == (1, 2)
    assert service.callback is slow


def test_a_coroutine_awaits_a_call_within_its_own_group(graph: GraphHarness) -> None:
    node = make(graph, "n")
    _, _ = pair(graph)
    client = node.create_client(AddTwoInts, "add")
    sums: list[int] = []

    async def ask() -> None:
        sums.append((await client.call_async(AddTwoInts.Request(a=8))).sum)

    timer = node.create_timer(1.0, ask)
    graph.run_for(1.0)
    timer.cancel()
    graph.run_for(1.0)
    assert sums == [8]


def test_an_exception_is_raised_and_the_client_gets_a_failure(
    graph: GraphHarness,
) -> None:
    def fail(request: Any, response: Any) -> Any:
        raise ValueError("no such number")

    _, client = pair(graph, fail)
    future = client.call_async(AddTwoInts.Request())
    with pytest.raises(CallbackError, match=r"/server: callback of service /add .*no"):
        graph.run_for(1.0)
    graph.run_for(1.0)
    assert future.done()
    with pytest.raises(ServiceFailedError, match="/add failed: ValueError: no such"):
        future.result()


def test_an_exception_of_a_coroutine_reaches_the_client(
    graph: GraphHarness,
) -> None:
    async def fail(request: Any, response: Any) -> Any:
        raise ValueError("late")

    _, client = pair(graph, fail)
    future = client.call_async(AddTwoInts.Request())
    with pytest.raises(CallbackError, match="service /add"):
        graph.run_for(1.0)
    graph.run_for(1.0)
    assert isinstance(future.exception(), ServiceFailedError)


def test_a_callback_that_returns_none_raises(
    graph: GraphHarness,
) -> None:
    _, client = pair(graph, lambda request, response: None)
    with pytest.raises(CallbackError, match=r"must return its .*_Response, got None"):
        client.call(AddTwoInts.Request())


def test_timeout(graph: GraphHarness) -> None:
    never: Future[Any] = Future()

    async def hang(request: Any, response: Any) -> Any:
        return await never

    _, client = pair(graph, hang)
    with pytest.raises(TimeoutError, match=r"/add: no response in 2 s$"):
        client.call(AddTwoInts.Request(), timeout_sec=2.0)
    assert graph.now_ns == 2_000_000_000
    with pytest.raises(KeyError):
        client.get_pending_request(1)


def test_a_call_without_a_server_times_out(graph: GraphHarness) -> None:
    client = graph.node.create_client(Trigger, "no_server")
    with pytest.raises(TimeoutError, match="has no server"):
        client.call(Trigger.Request(), 0.5)
    assert not client.wait_for_service(timeout_sec=0.5)
    assert not client.service_is_ready()


def test_wait_for_service(graph: GraphHarness) -> None:
    client = graph.node.create_client(AddTwoInts, "add")
    server = make(graph, "server")
    server.create_timer(1.0, lambda: server.create_service(AddTwoInts, "add", add))
    assert client.wait_for_service(timeout_sec=5.0)
    assert graph.now_ns == 1_000_000_000
    assert client.service_is_ready()


def test_a_removed_request_stays_pending(graph: GraphHarness) -> None:
    _, client = pair(graph)
    future = client.call_async(AddTwoInts.Request())
    client.remove_pending_request(future)
    graph.run_for(1.0)
    assert not future.done()


def test_the_response_of_the_first_of_two_servers_counts(graph: GraphHarness) -> None:
    _, client = pair(graph)
    make(graph, "second").create_service(
        AddTwoInts, "add", lambda request, response: AddTwoInts.Response(sum=-1)
    )
    assert client.call(AddTwoInts.Request(a=3)).sum == 3
    graph.run_for(1.0)


def test_wrong_types_raise(graph: GraphHarness) -> None:
    node: Any = graph.node
    with pytest.raises(NoTypeSupportImportedException, match="String, which is a mess"):
        node.create_service(String, "s", add)
    with pytest.raises(TypeError, match="Fibonacci, which is an act"):
        node.create_client(Fibonacci, "s")
    with pytest.raises(RuntimeError, match="is not a class"):
        node.create_client("std_srvs/srv/Trigger", "s")
    with pytest.raises(MessageError, match="AddTwoInts, which is a serv"):
        node.create_publisher(AddTwoInts, "t", 1)
    with pytest.raises(TypeError, match="callback 3 not callable"):
        node.create_service(AddTwoInts, "s", 3)
    with pytest.raises(TypeError, match="must be a QoSProfile"):
        node.create_service(AddTwoInts, "s", add, qos_profile=10)
    with pytest.raises(InvalidServiceNameException, match="service name"):
        node.create_client(AddTwoInts, "a b")
    _, client = pair(graph)
    with pytest.raises(TypeError, match=r"expected .*_Request, got SetBool_Request"):
        client.call_async(SetBool.Request())
    with pytest.raises(InvalidValueError, match="cannot call it as std_srvs/srv/Set"):
        node.create_client(SetBool, "add")
    assert graph.context.graph.service_endpoints(node="/harness") == []


def test_type_checks() -> None:
    check_for_type_support(String)
    check_is_valid_msg_type(AddTwoInts.Request)
    check_is_valid_srv_type(AddTwoInts)
    with pytest.raises(TypeError, match="not a ROS 2 message"):
        check_for_type_support(int)
    with pytest.raises(RuntimeError, match="not a ROS 2 interface"):
        check_is_valid_srv_type(int)


def test_destroying(graph: GraphHarness) -> None:
    service, client = pair(graph)
    future = client.call_async(AddTwoInts.Request())
    with service:
        assert client.service_is_ready()
    assert not client.service_is_ready()
    graph.run_for(1.0)
    assert not future.done()
    with client:
        pass
    assert future.cancelled()
    with pytest.raises(InvalidHandle, match="/add was destroyed"):
        client.call_async(AddTwoInts.Request())
    node = make(graph, "n")
    service = node.create_service(AddTwoInts, "add", add)
    client = node.create_client(AddTwoInts, "add")
    assert node.destroy_service(service)
    assert not node.destroy_service(service)
    assert node.destroy_client(client)


def test_shutdown_ends_a_call() -> None:
    context = Context(clock=VirtualClock())
    node = Node("n", context=context)
    Executor(context=context).add_node(node)
    client = node.create_client(AddTwoInts, "add")
    node.create_timer(1.0, context.shutdown)
    with pytest.raises(ROSInterruptException):
        client.call(AddTwoInts.Request())


def test_names_and_attributes(graph: GraphHarness) -> None:
    node = graph.add(
        Node(
            "n",
            namespace="ns",
            context=graph.context,
            start_parameter_services=False,
            cli_args=["-r", "~/add:=/sum"],
        )
    )
    qos = QoSProfile(depth=3)
    service = node.create_service(AddTwoInts, "~/add", add, qos_profile=qos)
    client = node.create_client(AddTwoInts, "/sum", qos_profile=qos)
    assert (service.srv_name, service.service_name) == ("~/add", "/sum")
    assert (client.srv_name, client.service_name) == ("/sum", "/sum")
    assert service.srv_type is client.srv_type is AddTwoInts
    assert service.qos_profile is client.qos_profile is qos
    assert service in node.services
    assert list(node.clients) == [client]
    assert service.callback_group is client.callback_group
    assert node.default_callback_group.has_entity(service)


def test_graph_queries(graph: GraphHarness) -> None:
    node = graph.add(
        Node("n", namespace="ns", context=graph.context, start_parameter_services=False)
    )
    node.create_service(Trigger, "go", lambda request, response: response)
    node.create_client(SetBool, "/enable")
    served = ("/ns/go", ["std_srvs/srv/Trigger"])
    assert served in graph.node.get_service_names_and_types()
    assert served in node.get_service_names_and_types_by_node("n", "ns")
    assert node.get_client_names_and_types_by_node("n", "/ns") == [
        ("/enable", ["std_srvs/srv/SetBool"])
    ]
    assert (node.count_services("go"), node.count_clients("go")) == (1, 0)
    assert (node.count_services("/enable"), node.count_clients("/enable")) == (0, 1)
    assert all(name != "/ns/go" for name, _ in node.get_topic_names_and_types())


def test_introspection(graph: GraphHarness) -> None:
    service, client = pair(graph)
    node = graph.node
    state = ServiceIntrospectionState
    assert node.count_publishers("/add/_service_event") == 0
    for end in (service, client):
        end.configure_introspection(
            node.get_clock(), QoSProfile(depth=9), state.CONTENTS
        )
    events = graph.collect("/add/_service_event", AddTwoInts.Event)
    client.call(AddTwoInts.Request(a=1, b=2))
    graph.run_for(0.1)
    kinds = ServiceEventInfo
    assert [
        (e.info.event_type, [r.a for r in e.request], [r.sum for r in e.response])
        for e in events.messages
    ] == [
        (kinds.REQUEST_SENT, [1], []),
        (kinds.REQUEST_RECEIVED, [1], []),
        (kinds.RESPONSE_SENT, [], [3]),
        (kinds.RESPONSE_RECEIVED, [], [3]),
    ]
    assert {e.info.sequence_number for e in events.messages} == {1}
    events.clear()
    service.configure_introspection(
        node.get_clock(), QoSProfile(depth=9), state.METADATA
    )
    client.configure_introspection(node.get_clock(), QoSProfile(depth=9), state.OFF)
    client.call(AddTwoInts.Request())
    graph.run_for(0.1)
    assert [(e.request, e.response) for e in events.messages] == [([], [])] * 2
