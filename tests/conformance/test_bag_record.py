"""``navette bag record`` as a process: a running system, a kill, a full disk."""

import json
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from free_ports import free_endpoint
from navette.bags import open_bag
from navette.bags.checking import check_bag
from navette.bags.message_types import Decoder
from navette.errors import FileFormatError
from navette.msgs import register_definition
from navette.msgs.std_msgs.msg import String
from navette.runtime import Context, Executor, Node, Stopwatch
from navette.runtime.qos import QoSDurabilityPolicy, QoSProfile

pytestmark = [
    pytest.mark.long,
    pytest.mark.slow,
    pytest.mark.skipif(os.name == "nt", reason="signals and limits of POSIX"),
]
LIMIT_S = 60.0
LIMITED = """
import resource
resource.setrlimit(resource.RLIMIT_FSIZE, ({0}, {0}))
from navette.cli import main
main()
"""
NAVETTE = [sys.executable, "-m", "navette"]
LATCHED = QoSProfile(depth=1, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)


def environment(router: str) -> dict[str, str]:
    kept = {k: v for k, v in os.environ.items() if k != "PYTEST_CURRENT_TEST"}
    return {**kept, "NAVETTE_TRANSPORT": "zenoh", "NAVETTE_ROUTER": router}


class Talker:
    """Publishes numbers at 100 Hz on ``/chatter``, and a latched word."""

    def __init__(self, context: Context) -> None:
        self.executor = Executor(context=context)
        self.node = Node("talker", context=context)
        self.publisher = self.node.create_publisher(String, "/chatter", 100)
        latched = self.node.create_publisher(String, "/word", LATCHED)
        latched.publish(String(data="once"))
        self.count = 0
        self.executor.add_node(self.node)

    def start(self) -> None:
        self.node.create_timer(0.01, self._talk)

    def _talk(self) -> None:
        self.count += 1
        self.publisher.publish(String(data=str(self.count)))

    def until(self, condition: Callable[[], bool], what: str) -> None:
        watch = Stopwatch()
        while not condition():
            assert watch.elapsed_s < LIMIT_S, f"{what} did not come about"
            self.executor.spin_once(timeout_sec=0.01)

    def until_recorded(self) -> None:
        """Wait for the recorder's subscription."""
        self.until(lambda: self.publisher.get_subscription_count() > 0, "a recorder")


@pytest.fixture
def router(monkeypatch: pytest.MonkeyPatch) -> str:
    endpoint = free_endpoint()
    monkeypatch.setenv("NAVETTE_ROUTER", endpoint)
    return endpoint


@pytest.fixture
def talker(router: str) -> Iterator[Talker]:
    with Context(transport="zenoh") as context:
        yield Talker(context)


@contextmanager
def recorder(
    router: str, *arguments: str, cwd: Path
) -> Iterator["subprocess.Popen[str]"]:
    process = subprocess.Popen(
        [*NAVETTE, "bag", "record", *arguments],
        env=environment(router),
        stderr=subprocess.PIPE,
        text=True,
        cwd=cwd,
    )
    try:
        yield process
    finally:
        process.kill()
        process.wait(LIMIT_S)
        assert process.stderr is not None
        process.stderr.close()


def numbers(path: Path) -> list[int]:
    with open_bag(path) as reader:
        return [int(m.data[8:-1]) for m in reader.messages(["/chatter"])]


def test_running_and_late_topics_are_recorded(
    talker: Talker, router: str, tmp_path: Path
) -> None:
    with recorder(router, "--all", "-o", "run", cwd=tmp_path) as process:
        talker.until_recorded()
        talker.start()
        talker.until(lambda: talker.count >= 50, "50 numbers")
        late = talker.node.create_publisher(String, "/late", 10)
        talker.until(lambda: late.get_subscription_count() > 0, "a late recorder")
        late.publish(String(data="late"))
        last = talker.count
        talker.until(lambda: talker.count >= last + 50, "50 more")
        process.send_signal(signal.SIGINT)
        assert process.wait(LIMIT_S) == 0
        assert process.stderr is not None
        output = process.stderr.read()
    path = tmp_path / "run.mcap"
    assert "recording to run.mcap" in output
    assert check_bag(path, decode=True).is_sound
    found = numbers(path)
    assert found == list(range(1, len(found) + 1))
    assert len(found) >= last
    with open_bag(path) as reader:
        topics = {topic.name: topic for topic in reader.topics}
        assert topics["/word"].latched
        assert topics["/chatter"].type_hash.startswith("RIHS01_")
        counts = {topic.name: count for topic, count in reader.counts().items()}
    assert counts["/word"] == counts["/late"] == 1


def test_types_that_only_their_publisher_defines(
    talker: Talker, router: str, tmp_path: Path
) -> None:
    text = "int32 volume\nstd_msgs/Header header\n"
    beep: Any = register_definition("bag_record_case/msg/Beep", text)
    publisher = talker.node.create_publisher(beep, "/beep", 10)
    with recorder(router, "-a", "-o", "run.mcap", cwd=tmp_path) as process:
        talker.until(lambda: publisher.get_subscription_count() > 0, "a recorder")
        publisher.publish(beep(volume=11))
        talker.start()
        talker.until(lambda: talker.count >= 20, "20 numbers")
        process.send_signal(signal.SIGINT)
        assert process.wait(LIMIT_S) == 0
    with open_bag(tmp_path / "run.mcap") as reader:
        (message,) = reader.messages(["/beep"])
        assert message.topic.definition.startswith(text)
        assert Decoder(message.topic)(message.data).volume == 11


def on_disk(path: Path) -> int:
    """Return how many numbers another reader finds during the recording."""
    try:
        with open_bag(path) as reader:
            kept = reader.messages(["/chatter"], on_damage=lambda damage: None)
            return sum(1 for _ in kept)
    except (FileNotFoundError, FileFormatError):
        return 0  # not started yet


def test_a_killed_recorder_leaves_the_written_messages(
    talker: Talker, router: str, tmp_path: Path
) -> None:
    path = tmp_path / "run.mcap"
    with recorder(router, "/chatter", "-o", "run.mcap", cwd=tmp_path) as process:
        talker.until_recorded()
        talker.start()
        talker.until(lambda: on_disk(path) >= 60, "the first half second, and more")
        process.kill()
        process.wait(LIMIT_S)
    assert not check_bag(path).is_sound
    recovered = tmp_path / "saved.mcap"
    subprocess.run(
        [*NAVETTE, "bag", "recover", path, "-o", recovered],
        check=True,
        timeout=LIMIT_S,
        capture_output=True,
    )
    assert check_bag(recovered, decode=True).is_sound
    found = numbers(recovered)
    assert found == list(range(1, len(found) + 1)), "nothing is missing in between"
    assert len(found) >= 60


def test_a_full_disk_ends_the_recording_with_a_clear_error(
    talker: Talker, router: str, tmp_path: Path
) -> None:
    limited = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (20_000,)*2)"
    program = f"{limited}; from navette.cli import main; main()"
    arguments = ["bag", "record", "/chatter", "--compression", "none", "-o", "run.mcap"]
    with subprocess.Popen(
        [sys.executable, "-c", program, *arguments],
        env=environment(router),
        stderr=subprocess.PIPE,
        text=True,
        cwd=tmp_path,
    ) as process:
        ended = threading.Event()
        output: list[str] = []

        def read() -> None:
            output.append(process.communicate(timeout=LIMIT_S)[1])
            ended.set()

        reading = threading.Thread(target=read)
        reading.start()
        talker.until_recorded()
        talker.start()
        talker.until(ended.is_set, "the end of the recording")
        reading.join()
    assert process.returncode == 1
    assert "run.mcap: recording ended: File too large" in output[0]
    report = check_bag(tmp_path / "run.mcap")
    assert report.is_sound
    assert report.messages > 50


def test_a_robot_keeps_driving_when_its_disk_is_full(tmp_path: Path) -> None:
    words = "sim --goal 2 0 --headless --json --record run.mcap".split()
    run = subprocess.run(
        [sys.executable, "-c", LIMITED.format(500_000), *words],
        env={**os.environ, "NAVETTE_TRANSPORT": "inprocess"},
        capture_output=True,
        text=True,
        timeout=120,
        cwd=tmp_path,
    )
    assert [goal["result"] for goal in json.loads(run.stdout)["goals"]] == ["reached"]
    assert "recording ended: File too large" in run.stderr
    report = check_bag(tmp_path / "run.mcap")
    assert report.is_sound
    assert report.messages > 100


def test_invalid_uses(tmp_path: Path) -> None:
    (tmp_path / "a.mcap").write_text("", "utf-8")
    for arguments, reason in (
        ([], "give topics, --all"),
        (["-a", "-o", "a.mcap"], "already exists"),
        (["-a", "-x", "["], "is not a regular expression"),
        (["-a", "--compression", "bz2", "-o", "b"], "compression"),
    ):
        run = subprocess.run(
            [*NAVETTE, "bag", "record", *arguments],
            env={**os.environ, "NAVETTE_TRANSPORT": "inprocess"},
            capture_output=True,
            text=True,
            timeout=LIMIT_S,
            cwd=tmp_path,
        )
        assert run.returncode == 2, run.stderr
        assert reason in run.stderr
    assert [each.name for each in tmp_path.iterdir()] == ["a.mcap"]
