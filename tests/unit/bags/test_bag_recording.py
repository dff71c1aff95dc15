"""Recorder options: split files, snapshots, pauses, types defined later."""

from pathlib import Path
from typing import Any

import pytest
from rosbags.highlevel import AnyReader

from navette.bags import BagTopic, OfferedQos, open_bag
from navette.bags.node import RecorderNode
from navette.bags.recording import Folder, RecordedTopic, Snapshots
from navette.errors import FileFormatError
from navette.msgs import register_definition
from navette.msgs.builtin_interfaces.msg import Time
from navette.msgs.rosgraph_msgs.msg import Clock
from navette.msgs.std_msgs.msg import String
from navette.msgs.std_srvs.srv import SetBool, Trigger
from navette.runtime import Context, Executor, Node, Parameter, VirtualClock
from navette.runtime.qos import QoSDurabilityPolicy, QoSProfile

SECOND = 1_000_000_000
LATCHED = QoSProfile(depth=1, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)


class Run:
    """A 100 Hz talker, a latched topic and the recorder, in virtual time."""

    def __init__(self, path: Path, **params: Any) -> None:
        self.context = Context(clock=VirtualClock())
        self.executor = Executor(context=self.context)
        self.talker = Node("talker", context=self.context)
        self.count = 0
        self.publisher = self.talker.create_publisher(String, "/chatter", 10)
        latched = self.talker.create_publisher(String, "/word", LATCHED)
        latched.publish(String(data="once"))
        self.talker.create_timer(0.01, self.talk)
        overrides = [Parameter(name, value=value) for name, value in params.items()]
        self.recorder = RecorderNode(
            path, context=self.context, parameter_overrides=overrides
        )
        self.executor.add_node(self.talker)
        self.executor.add_node(self.recorder)

    def talk(self) -> None:
        self.count += 1
        self.publisher.publish(String(data=str(self.count)))

    def go(self, seconds: float) -> "Run":
        self.executor.spin_for(round(seconds * SECOND))
        return self

    def call(self, kind: Any, name: str, **request: Any) -> Any:
        client = self.talker.create_client(kind, name)
        future = client.call_async(kind.Request(**request))
        self.executor.spin_until_future_complete(future, 1.0)
        return future.result()

    def end(self) -> None:
        self.recorder.close()
        self.context.shutdown()


def chatter(path: Path) -> list[int]:
    with open_bag(path) as reader:
        assert reader.problems == ()
        return [int(m.data[8:-1]) for m in reader.messages(["/chatter"])]


def test_files_split_by_duration(tmp_path: Path) -> None:
    path = tmp_path / "run"
    Run(path, max_bag_duration_s=1.0, topics=["/chatter"]).go(3.5).end()
    names = sorted(each.name for each in path.iterdir())
    assert names == ["metadata.yaml", *(f"run_{n}.mcap" for n in range(4))]
    assert [len(chatter(path / f"run_{n}.mcap")) for n in range(4)] == [
        100,
        100,
        100,
        50,
    ]
    assert chatter(path) == list(range(1, 351))
    with AnyReader([path]) as reader:
        assert reader.message_count == 350
        assert sum(1 for _ in reader.messages()) == 350
        assert reader.start_time == SECOND // 100


def test_files_split_by_size(tmp_path: Path) -> None:
    path = tmp_path / "run"
    Run(path, max_bag_size_bytes=6000, flush_period_s=0.1).go(10).end()
    files = sorted(path.glob("*.mcap"))
    assert len(files) > 2
    assert chatter(path) == list(range(1, 1001))


def test_many_small_files_do_not_write_their_list_each_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    written: list[int] = []
    write = Folder.write_metadata

    def counted(folder: Folder) -> None:
        written.append(len(folder.files))
        write(folder)

    monkeypatch.setattr(Folder, "write_metadata", counted)
    path = tmp_path / "run"
    Run(path, max_bag_size_bytes=1, flush_period_s=0.5).go(2.2).end()
    assert len(list(path.glob("*.mcap"))) > 200
    assert len(written) == 5, "at each flush, and at the end"
    assert written[-1] == len(list(path.glob("*.mcap")))
    assert chatter(path) == list(range(1, 221))


def test_what_is_queued_at_the_end_is_recorded(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    run = Run(path, topics=["/chatter"]).go(0.1)
    for number in range(11, 61):
        run.publisher.publish(String(data=str(number)))
    run.recorder.record_queued()
    run.end()
    assert chatter(path) == list(range(1, 61))


def test_an_existing_folder_is_not_replaced(tmp_path: Path) -> None:
    with pytest.raises(FileFormatError, match="exists already"):
        Run(tmp_path, max_bag_size_bytes=6000)


def test_snapshots_of_the_last_seconds(tmp_path: Path) -> None:
    path = tmp_path / "run"
    run = Run(path, snapshot_duration_s=2.0).go(5)
    assert list(path.iterdir()) == []
    answer = run.call(Trigger, "/recorder/snapshot")
    assert answer.success
    assert answer.message == str(path / "run_0.mcap")
    found = chatter(path / "run_0.mcap")
    assert found == list(range(found[0], found[-1] + 1))
    assert len(found) in (200, 201)
    assert found[-1] >= 500
    with open_bag(path / "run_0.mcap") as reader:
        (word,) = reader.messages(["/word"])
    assert word.stamp_ns == 0, "a latched message is kept however old it is"
    run.go(1).call(Trigger, "/recorder/snapshot")
    run.end()
    assert len(list(path.glob("*.mcap"))) == 2
    assert chatter(path / "run_1.mcap")[-1] > found[-1]


def test_snapshots_are_bounded_in_memory(tmp_path: Path) -> None:
    kept = Snapshots(tmp_path / "run", duration_ns=SECOND, max_bytes=1000)
    assert kept.take() is None
    qos = (OfferedQos(durability="transient_local"),)
    topic = RecordedTopic(BagTopic("/a", "std_msgs/msg/String", "string data\n"))
    latched = RecordedTopic(BagTopic("/b", "std_msgs/msg/String", "", qos=qos))
    kept.write(latched, 1, bytes(10))
    for number in range(100):
        kept.write(topic, 2 + number, bytes(100))
    kept.write(topic, 200, bytes(2000))  # larger than everything that may be kept
    path = kept.take()
    assert path is not None
    with open_bag(path) as reader:
        assert [m.stamp_ns for m in reader.messages()] == [1]


def test_a_continuous_recorder_takes_no_snapshots(tmp_path: Path) -> None:
    run = Run(tmp_path / "a.mcap")
    with pytest.raises(FileFormatError, match="takes no snapshots"):
        run.recorder.take_snapshot()
    run.end()


def test_pauses(tmp_path: Path) -> None:
    run = Run(tmp_path / "a.mcap", paused=True).go(1)
    assert run.recorder.message_count == 0
    assert run.call(SetBool, "/recorder/pause", data=False).message == "recording"
    first = run.count + 1
    run.go(1)
    assert run.call(SetBool, "/recorder/pause", data=True).message == "paused"
    last = run.count
    run.go(1).end()
    found = chatter(tmp_path / "a.mcap")
    assert found[0] in (first - 1, first)
    assert found[-1] in (last - 1, last)


def test_by_type(tmp_path: Path) -> None:
    Run(tmp_path / "a.mcap", types=["std_msgs/msg/String"]).go(1).end()
    with open_bag(tmp_path / "a.mcap") as reader:
        assert {topic.name for topic in reader.topics} == {"/chatter", "/word"}
    Run(tmp_path / "b.mcap", exclude_types=["std_msgs/msg/String"]).go(1).end()
    with open_bag(tmp_path / "b.mcap") as reader:
        assert "/chatter" not in {topic.name for topic in reader.topics}


@pytest.mark.parametrize("compression", ["zstd", "lz4", "none"])
def test_compression(tmp_path: Path, compression: str) -> None:
    Run(tmp_path / "a.mcap", compression=compression).go(1).end()
    with open_bag(tmp_path / "a.mcap") as reader:
        assert list(reader.compression) == [compression]
    assert chatter(tmp_path / "a.mcap") == list(range(1, 101))


def test_a_type_that_is_defined_later(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Simulates a type that only its publisher can describe."""
    run = Run(tmp_path / "a.mcap")
    every = run.context.graph.topics
    name = "recording_late/msg/Beep"
    with monkeypatch.context() as patch:
        patch.setattr(run.context.graph, "topics", lambda: {**every(), "/beep": [name]})
        run.recorder.refresh()
        assert run.recorder.undefined == {"/beep": name}
        assert "/beep" not in run.recorder.topics
        beep: Any = register_definition(name, "int32 volume\n")
        run.recorder.refresh()
    assert run.recorder.undefined == {}
    assert "/beep" in run.recorder.topics
    publisher = run.talker.create_publisher(beep, "/beep", 10)
    publisher.publish(beep(volume=11))
    run.go(0.1).end()
    with open_bag(tmp_path / "a.mcap") as reader:
        (message,) = reader.messages(["/beep"])
    assert message.topic.definition == "int32 volume\n"


def test_stamps_of_simulated_time(tmp_path: Path) -> None:
    """Messages received before the first ``/clock`` get its time as stamp."""
    context = Context()
    executor = Executor(context=context)
    talker = Node("talker", context=context)
    publisher = talker.create_publisher(String, "/chatter", 10)
    clock = talker.create_publisher(Clock, "/clock", 10)
    path = tmp_path / "a.mcap"
    overrides = [Parameter("use_sim_time", value=True)]
    recorder = RecorderNode(path, context=context, parameter_overrides=overrides)
    executor.add_node(talker)
    executor.add_node(recorder)

    def say(text: str) -> None:
        publisher.publish(String(data=text))
        for _ in range(20):  # all that is ready; in process nothing takes time
            executor.spin_once(timeout_sec=0.0)

    say("1")
    assert recorder.message_count == 0
    for seconds in (50, 51):
        clock.publish(Clock(clock=Time(sec=seconds)))
        say(f"{seconds}")
    recorder.close()
    context.shutdown()
    assert chatter(path) == [1, 50, 51]
    with open_bag(path) as reader:
        stamps = [m.stamp_ns // SECOND for m in reader.messages(["/chatter"])]
    assert stamps == [50, 50, 51]
