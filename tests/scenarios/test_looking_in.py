"""Verbs from a second terminal, with nothing prepared: real processes."""

import json
import os
import queue
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from free_ports import free_endpoint

LIMIT_S = 60.0
NAVETTE = [sys.executable, "-c", "from navette.cli import main; main()"]
PROGRAM = """
import sys
import navette
from navette.msgs import get_interface
from navette.msgs.std_msgs.msg import Header, String
from navette.runtime import DurabilityPolicy, QoSProfile

Reading = get_interface("scenario_msgs/msg/Reading")
Ask = get_interface("scenario_msgs/srv/Ask")
navette.init(args=[])
node = navette.Node("sensor")
readings = node.create_publisher(Reading, "reading", 10)
latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
origin = node.create_publisher(Header, "origin", latched)
origin.publish(Header(frame_id="map"))

def tick():
    stamp = node.get_clock().now().to_msg()
    readings.publish(Reading(header=Header(stamp=stamp), values=[1.5, 2.5]))

def answer(request, response):
    response.total = request.first.values[0] + 1.0
    return response

node.create_timer(0.05, tick)
node.create_service(Ask, "ask", answer)
node.create_subscription(
    String, "command", lambda m: print("command", m.data, flush=True), 10
)
print("ready", flush=True)
navette.spin(node)
"""


class Terminals:
    """A running program and a second terminal."""

    def __init__(self, folder: Path) -> None:
        self.environment = {
            **os.environ,
            "NAVETTE_ROUTER": free_endpoint(),
            "NAVETTE_TRANSPORT": "zenoh",
            "ROS_DOMAIN_ID": "7",
        }
        self.folder = folder
        messages = folder / "program" / "scenario_msgs"
        (messages / "msg").mkdir(parents=True)
        (messages / "srv").mkdir()
        (messages / "msg" / "Reading.msg").write_text(
            "uint8 GOOD=1\nstd_msgs/Header header\nfloat64[] values\n"
        )
        (messages / "srv" / "Ask.srv").write_text("Reading first\n---\nfloat64 total\n")
        self._program = subprocess.Popen(
            [sys.executable, "-c", PROGRAM],
            env={**self.environment, "NAVETTE_INTERFACE_PATH": str(messages.parent)},
            stdout=subprocess.PIPE,
            text=True,
        )
        self._lines: queue.SimpleQueue[str] = queue.SimpleQueue()
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def program_prints(self) -> str:
        """Its next line."""
        return self._lines.get(timeout=LIMIT_S)

    def navette(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [*NAVETTE, *arguments],
            cwd=self.folder,  # without the program's message definitions
            env=self.environment,
            capture_output=True,
            text=True,
            check=False,
            timeout=LIMIT_S,
        )

    def start(self, *arguments: str) -> subprocess.Popen[str]:
        return subprocess.Popen(
            [*NAVETTE, *arguments],
            cwd=self.folder,
            env=self.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    def close(self) -> None:
        self._program.kill()
        self._program.wait(LIMIT_S)
        self._reader.join(LIMIT_S)
        assert self._program.stdout is not None
        self._program.stdout.close()

    def _read(self) -> None:
        assert self._program.stdout is not None
        for line in self._program.stdout:
            self._lines.put(line.rstrip("\n"))


@pytest.fixture(scope="module")
def terminals(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Terminals]:
    made = Terminals(tmp_path_factory.mktemp("looking_in"))
    try:
        assert made.program_prints() == "ready"
        yield made
    finally:
        made.close()


@pytest.mark.slow
def test_topics_are_listed_at_once(terminals: Terminals) -> None:
    shown = terminals.navette("topic", "list", "-t")
    assert (shown.returncode, shown.stderr) == (0, "")
    assert shown.stdout.splitlines() == [
        "/command [std_msgs/msg/String]",
        "/origin [std_msgs/msg/Header]",
        "/parameter_events [rcl_interfaces/msg/ParameterEvent]",
        "/reading [scenario_msgs/msg/Reading]",
        "/rosout [rcl_interfaces/msg/Log]",
    ]


@pytest.mark.slow
def test_an_endpoint_is_described_as_its_owner_announces_it(
    terminals: Terminals,
) -> None:
    shown = terminals.navette("topic", "info", "/reading", "--json")
    found = json.loads(shown.stdout)
    (publisher,) = found["publishers"]
    assert publisher["node"] == "/sensor"
    assert publisher["hash"].startswith("RIHS01_")
    assert len(publisher["gid"]) == 32
    assert (publisher["qos"]["reliability"], publisher["qos"]["depth"]) == (
        "reliable", 10
    )  # fmt: skip


@pytest.mark.slow
def test_a_latched_message_is_shown_at_once(terminals: Terminals) -> None:
    shown = terminals.navette("topic", "echo", "/origin", "--once", "--timeout", "20")
    assert shown.stdout == "stamp:\n  sec: 0\n  nanosec: 0\nframe_id: map\n---\n"


@pytest.mark.slow
def test_an_unknown_type_is_requested_from_the_program(terminals: Terminals) -> None:
    shown = terminals.navette(
        "topic", "echo", "/reading", "--field", "values", "--flow-style", "-n", "2",
        "--timeout", "20", "--filter", "m.values[0] > m.GOOD",
    )  # fmt: skip
    assert (shown.returncode, shown.stderr) == (0, "")
    assert shown.stdout == "[1.5, 2.5]\n---\n" * 2
    shown = terminals.navette("interface", "show", "scenario_msgs/srv/Ask")
    assert shown.stdout == (
        "scenario_msgs/Reading first\n"
        "\tuint8 GOOD=1\n"
        "\tstd_msgs/Header header\n"
        "\t\tbuiltin_interfaces/Time stamp\n"
        "\t\t\tint32 sec\n"
        "\t\t\tuint32 nanosec\n"
        "\t\tstring frame_id\n"
        "\tfloat64[] values\n"
        "---\n"
        "float64 total\n"
    )
    shown = terminals.navette("service", "call", "/ask", "{first: {values: [41]}}")
    assert "total=42.0" in shown.stdout


@pytest.mark.slow
def test_rates_and_delays_are_measured(terminals: Terminals) -> None:
    shown = terminals.navette("topic", "hz", "/reading", "--count", "1", "--json")
    # The number of messages in that second depends on the load; the values are tested
    # with a virtual clock (test_topic_measuring.py).
    assert json.loads(shown.stdout)["rate_hz"] > 0
    shown = terminals.navette("topic", "delay", "/reading", "--count", "1", "--json")
    assert 0 <= json.loads(shown.stdout)["min"] < LIMIT_S


@pytest.mark.slow
def test_a_single_message_is_received(terminals: Terminals) -> None:
    shown = terminals.navette(
        "topic", "pub", "--once", "/command", "std_msgs/msg/String", "{data: go}"
    )
    assert shown.returncode == 0, shown.stderr
    assert terminals.program_prints() == "command go"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)]
)
def test_a_signal_ends_a_verb_silently(
    terminals: Terminals, number: int, code: int
) -> None:
    verb = terminals.start("topic", "echo", "/reading", "--csv")
    assert verb.stdout is not None
    assert verb.stdout.readline().endswith("1.5,2.5\n")
    verb.send_signal(number)
    _, complaints = verb.communicate(timeout=LIMIT_S)
    assert (verb.returncode, complaints) == (code, "")


@pytest.mark.slow
def test_a_closed_pipe_ends_a_verb_silently(
    terminals: Terminals,
) -> None:
    verb = terminals.start("topic", "echo", "/reading", "--csv")
    assert verb.stdout is not None
    verb.stdout.readline()
    verb.stdout.close()
    assert verb.stderr is not None
    assert verb.stderr.read() == ""
    verb.stderr.close()
    assert verb.wait(LIMIT_S) == 1
