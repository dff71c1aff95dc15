"""Programs of rclpy: messages, services and actions, beside figures of a real rclpy.

    python benchmarks/bench_calls.py [--json]

The programs below use rclpy only, so that the same file runs on ROS 2. Limits are what
rclpy 7.1.3 (Jazzy, CycloneDDS) needed on one machine with two cores, medians except
or p99 where stated; that machine is not this one.
"""

import json
import os
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from harness import Benchmark, Figure

PATIENCE_S = 20.0
CALLS = 2000
GOALS = 300
#: What the real rclpy needed: ms.
RCLPY = {
    "String there and back, two processes": 0.230,
    "service call, two processes": 0.291,
    "1 MB image there and back, two processes": 2.8,
    "first two 1 MB images, the slower": 24.0,
    "service call, one process": 0.210,
    "action goal, one process": 2.5,
    "action goal, one process, p99": 5.3,
    "import rclpy, with the start of Python": 69.0,
}


def serve() -> None:
    """The second process: returns strings and images, adds two numbers."""
    import rclpy
    from example_interfaces.srv import AddTwoInts
    from sensor_msgs.msg import Image
    from std_msgs.msg import String

    rclpy.init()
    node = rclpy.create_node("echo")
    for kind, name in ((String, "text"), (Image, "image")):
        back = node.create_publisher(kind, f"{name}_back", 10)
        node.create_subscription(kind, f"{name}_there", back.publish, 10)
    node.create_service(AddTwoInts, "add", _add)
    print("ready", flush=True)
    rclpy.spin(node)


def _add(request: Any, response: Any) -> Any:
    response.sum = request.a + request.b
    return response


def milliseconds(call: Callable[[], object]) -> float:
    begin = time.perf_counter()
    call()
    return 1e3 * (time.perf_counter() - begin)


class Client:
    """A node that another thread spins."""

    def __init__(self) -> None:
        import rclpy
        from rclpy.executors import SingleThreadedExecutor

        self.node = rclpy.create_node("client")
        executor = SingleThreadedExecutor()
        executor.add_node(self.node)
        self._thread = threading.Thread(target=executor.spin, daemon=True)
        self._thread.start()

    def echo(self, kind: Any, name: str, message: Any) -> Callable[[], None]:
        came = threading.Event()
        self.node.create_subscription(kind, f"{name}_back", lambda _: came.set(), 10)
        publisher = self.node.create_publisher(kind, f"{name}_there", 10)
        until = time.monotonic() + PATIENCE_S
        while publisher.get_subscription_count() < 1:
            assert time.monotonic() < until, "the other process was not found"
            time.sleep(0.01)
        time.sleep(0.5)  # until its publisher has found this subscription

        def once() -> None:
            came.clear()
            publisher.publish(message)
            assert came.wait(PATIENCE_S), "no echo"

        return once

    def call(self, name: str) -> Callable[[], None]:
        from example_interfaces.srv import AddTwoInts

        client = self.node.create_client(AddTwoInts, name)
        assert client.wait_for_service(PATIENCE_S)

        def once() -> None:
            assert client.call(AddTwoInts.Request(a=2, b=3)).sum == 5

        return once

    def goal(self) -> Callable[[], None]:
        from example_interfaces.action import Fibonacci
        from rclpy.action import ActionClient, ActionServer

        def execute(handle: Any) -> Any:
            handle.succeed()
            return Fibonacci.Result(sequence=[0, 1])

        self.server = ActionServer(self.node, Fibonacci, "fibonacci", execute)
        client = ActionClient(self.node, Fibonacci, "fibonacci")
        assert client.wait_for_server(PATIENCE_S)

        def once() -> None:
            result = client.send_goal(Fibonacci.Goal(order=1)).result
            assert list(result.sequence) == [0, 1]

        return once


def measure() -> dict[str, float]:
    """Return the milliseconds of each line but the import's."""
    import rclpy
    from example_interfaces.srv import AddTwoInts
    from sensor_msgs.msg import Image
    from std_msgs.msg import String

    rclpy.init()
    client = Client()
    image = Image(height=1024, width=1024, step=1024, encoding="mono8")
    image.data = bytes(1 << 20)
    text = client.echo(String, "text", String(data="x" * 16))
    times = [milliseconds(text) for _ in range(CALLS)]
    picture = client.echo(Image, "image", image)
    first = [milliseconds(picture) for _ in range(2)]
    pictures = [milliseconds(picture) for _ in range(CALLS // 10)]
    remote = client.call("add")
    calls = [milliseconds(remote) for _ in range(CALLS)]
    client.node.create_service(AddTwoInts, "add_here", _add)
    local = client.call("add_here")
    here = [milliseconds(local) for _ in range(CALLS)]
    act = client.goal()
    goals = sorted(milliseconds(act) for _ in range(GOALS))
    return {
        "String there and back, two processes": statistics.median(times),
        "service call, two processes": statistics.median(calls),
        "1 MB image there and back, two processes": statistics.median(pictures),
        "first two 1 MB images, the slower": max(first),
        "service call, one process": statistics.median(here),
        "action goal, one process": statistics.median(goals),
        "action goal, one process, p99": goals[int(0.99 * GOALS)],
    }


def navette_run(*arguments: str, **streams: Any) -> subprocess.Popen[str]:
    """Start this file, or ``-c CODE``, as ``navette run`` does."""
    command = [sys.executable, "-m", "navette", "run", *arguments]
    return subprocess.Popen(command, text=True, stdout=subprocess.PIPE, **streams)


def imports() -> float:
    """Median time from the start of a process until it has imported rclpy.

    ``navette run`` imports before the program does: the whole process counts. The
    limit is that of the import alone.
    """
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder, "program.py")
        program.write_text("import rclpy, time; print(time.time())")
        times = []
        for _ in range(11):
            begin = time.time()
            output, _ = navette_run(str(program)).communicate()
            times.append(1e3 * (float(output) - begin))
    return statistics.median(times)


def programs() -> dict[str, float]:
    """Run the two programs; return what the client measured."""
    with tempfile.TemporaryDirectory() as folder:
        os.environ["NAVETTE_TRANSPORT"] = "zenoh"
        os.environ["NAVETTE_RUNTIME_DIR"] = folder
        os.environ["ROS_DOMAIN_ID"] = "78"
        server = navette_run(__file__, "--serve")
        try:
            assert server.stdout is not None
            assert "ready" in server.stdout.readline()
            output, _ = navette_run(__file__, "--measure").communicate(timeout=120)
        finally:
            server.kill()
            server.communicate()
    found: dict[str, float] = json.loads(output.splitlines()[-1])
    return found


def main() -> None:
    found = programs() | {"import rclpy, with the start of Python": imports()}
    bench = Benchmark("calls", __doc__)
    for name, value in found.items():
        figure = Figure(name, value, "ms", RCLPY[name])
        bench.figure(lambda figure=figure: figure)
    bench.main()


if __name__ == "__main__":
    if sys.argv[1:2] == ["--serve"]:
        serve()
    elif sys.argv[1:2] == ["--measure"]:
        print(json.dumps(measure()))
        os._exit(0)  # the spinning thread does not end by itself
    else:
        main()
