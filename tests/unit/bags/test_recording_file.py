"""Two recorders never share a file, and a recorder notices that its file is gone."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from navette.bags import BagWriter, open_bag
from navette.bags.node import RecorderNode
from navette.bags.recording_file import is_being_recorded
from navette.bags.writing import open_writer
from navette.errors import FileFormatError
from navette.msgs import definition_text, serialize
from navette.msgs.std_msgs.msg import String
from navette.runtime import Context, Executor, Node, Parameter, VirtualClock

STRING = "std_msgs/msg/String"
SECOND = 1_000_000_000


def some_bag(path: Path, *, overwrite: bool = False, count: int = 3) -> BagWriter:
    writer = BagWriter(path, overwrite=overwrite)
    channel = writer.add_channel("/chatter", STRING, definition_text(STRING))
    for stamp in range(count):
        writer.write(channel, stamp, serialize(String(data=str(stamp))))
    writer.flush()
    return writer


def count(path: Path) -> int:
    with open_bag(path) as reader:
        return sum(1 for _ in reader.messages())


@pytest.mark.parametrize("overwrite", [False, True])
def test_a_second_recorder_is_refused(tmp_path: Path, overwrite: bool) -> None:
    path = tmp_path / "run.mcap"
    first = some_bag(path)
    assert is_being_recorded(path)
    with pytest.raises(FileFormatError, match=r"run\.mcap: is being recorded by"):
        BagWriter(path, overwrite=overwrite)
    assert [each.name for each in tmp_path.iterdir()] == ["run.mcap"]
    first.close()
    assert not is_being_recorded(path)
    assert count(path) == 3


def test_a_file_that_is_being_created_is_refused(tmp_path: Path) -> None:
    """Two recorders that start at the same time."""
    program = (
        "import fcntl, sys; file = open(sys.argv[1], 'w'); "
        "fcntl.flock(file, fcntl.LOCK_EX); print('locked', flush=True); input()"
    )
    part = tmp_path / ".run.mcap.part"
    with subprocess.Popen(
        [sys.executable, "-c", program, part],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
    ) as other:
        assert other.stdout is not None
        assert other.stdout.readline() == b"locked\n"
        with pytest.raises(FileFormatError, match="is being recorded"):
            BagWriter(tmp_path / "run.mcap")
        other.kill()
    some_bag(tmp_path / "run.mcap").close()  # the temporary file was left behind
    assert [each.name for each in tmp_path.iterdir()] == ["run.mcap"]


def test_a_name_taken_meanwhile_is_not_replaced(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "run.mcap"
    some_bag(tmp_path / "other.mcap").close()
    monkeypatch.setattr("navette.bags.recording_file._refuse_existing", _take(path))
    with pytest.raises(FileFormatError, match="exists already"):
        BagWriter(path)
    assert count(path) == 3
    assert {each.name for each in tmp_path.iterdir()} == {"other.mcap", "run.mcap"}


def _take(path: Path) -> object:
    def take(_path: Path, *, overwrite: bool) -> None:
        (path.parent / "other.mcap").rename(path)
        (path.parent / "other.mcap").touch()

    return take


def test_a_recording_is_readable_under_its_name_while_it_is_written(
    tmp_path: Path,
) -> None:
    path = tmp_path / "run.mcap"
    writer = some_bag(path)
    assert count(path) == 3
    writer.close()


def test_the_target_of_a_link_is_replaced(tmp_path: Path) -> None:
    (tmp_path / "disk").mkdir()
    some_bag(tmp_path / "disk" / "run.mcap", count=1).close()
    link = tmp_path / "run.mcap"
    link.symlink_to("disk/run.mcap")
    some_bag(link, overwrite=True).close()
    assert link.is_symlink()
    assert count(tmp_path / "disk" / "run.mcap") == 3


class Talk:
    """A talker and a recorder on a virtual clock."""

    def __init__(self, path: Path, **parameters: object) -> None:
        self.context = Context(clock=VirtualClock())
        self.executor = Executor(context=self.context)
        talker = Node("talker", context=self.context)
        publisher = talker.create_publisher(String, "/chatter", 10)
        talker.create_timer(0.1, lambda: publisher.publish(String(data="a")))
        self.executor.add_node(talker)
        overrides = [Parameter(name, value=v) for name, v in parameters.items()]
        self.recorder = RecorderNode(
            path, context=self.context, parameter_overrides=overrides
        )
        self.executor.add_node(self.recorder)
        self.executor.spin_for(SECOND)

    def error_after(self, seconds: int) -> str:
        self.executor.spin_for(seconds * SECOND)
        return str(self.recorder.error)

    def end(self) -> None:
        self.recorder.close()
        self.context.shutdown()


def _replace(path: Path) -> None:
    other = path.with_name("other.mcap")
    some_bag(other, count=7).close()
    other.replace(path)


def _truncate(path: Path) -> None:
    os.truncate(path, 0)


@pytest.mark.parametrize(
    ("harm", "reason"),
    [
        (Path.unlink, "removed or renamed by another program"),
        (_replace, "replaced by another program"),
        (_truncate, "truncated by another program"),
    ],
)
def test_a_recorder_whose_file_is_gone_fails_at_once(
    tmp_path: Path, harm: object, reason: str
) -> None:
    path = tmp_path / "run.mcap"
    talk = Talk(path)
    assert callable(harm)
    harm(path)
    assert f"run.mcap: recording ended: the file was {reason}" in talk.error_after(1)
    talk.end()
    if harm is _replace:
        assert count(path) == 7, "the other program's file is intact"


def test_a_recording_renamed_meanwhile_keeps_its_messages(tmp_path: Path) -> None:
    talk = Talk(tmp_path / "run.mcap")
    (tmp_path / "run.mcap").rename(tmp_path / "kept.mcap")
    assert "removed or renamed" in talk.error_after(1)
    talk.end()
    with open_bag(tmp_path / "kept.mcap") as reader:
        assert reader.problems == ()
        assert sum(1 for _ in reader.messages(["/chatter"])) >= 9


def test_a_folder_that_is_being_recorded_is_not_replaced(tmp_path: Path) -> None:
    talk = Talk(tmp_path / "run", max_bag_duration_s=0.5)
    with pytest.raises(FileFormatError, match="is being recorded"):
        open_writer(tmp_path / "run", storage="sqlite3", overwrite=True)
    assert talk.error_after(1) == "None"
    talk.end()
    assert count(tmp_path / "run") > 15
    open_writer(tmp_path / "run", storage="sqlite3", overwrite=True).close()


def test_a_removed_folder_ends_the_recording(tmp_path: Path) -> None:
    import shutil

    talk = Talk(tmp_path / "run", max_bag_duration_s=0.5)
    shutil.rmtree(tmp_path / "run")
    assert "recording ended" in talk.error_after(1)
    talk.end()


def test_two_conversions_do_not_share_a_file(tmp_path: Path) -> None:
    first = open_writer(tmp_path / "a.mcap")
    with pytest.raises(FileFormatError, match="is being recorded"):
        open_writer(tmp_path / "a.mcap")
    first.close()
    assert [each.name for each in tmp_path.iterdir()] == ["a.mcap"]
