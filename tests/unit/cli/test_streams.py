"""Standard streams of a command that are closed, full or of another encoding."""

import errno
import io
import sys

import pytest

from navette.cli.output import show
from navette.cli.streams import prepare, reporting_failed_writes

FULL = OSError(errno.ENOSPC, "No space left on device")


class Failing(io.StringIO):
    """A stream that fails in ``write``, or only when its buffer is written."""

    def __init__(self, error: OSError, *, buffered: bool) -> None:
        super().__init__()
        self.error = error
        self.buffered = buffered

    def write(self, text: str) -> int:
        if not self.buffered:
            raise self.error
        return len(text)

    def flush(self) -> None:
        raise self.error


@pytest.mark.parametrize("buffered", [False, True])
def test_a_full_disk_is_reported_in_a_line(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    *,
    buffered: bool,
) -> None:
    monkeypatch.setattr("sys.stdout", Failing(FULL, buffered=buffered))
    with pytest.raises(SystemExit) as ended, reporting_failed_writes():
        show("x")
    sys.stdout.close()  # what is left goes to os.devnull
    assert ended.value.code == 1
    expected = "navette: cannot write the output: No space left on device\n"
    assert capsys.readouterr().err == expected


def test_what_is_still_buffered_at_the_end_is_written(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.stdout", Failing(FULL, buffered=True))
    with pytest.raises(SystemExit) as ended, reporting_failed_writes():
        raise SystemExit(0)
    sys.stdout.close()
    assert ended.value.code == 1
    assert "cannot write the output" in capsys.readouterr().err


def test_a_closed_pipe_is_not_reported(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.stdout", Failing(BrokenPipeError(), buffered=True))
    with pytest.raises(SystemExit) as ended, reporting_failed_writes():
        raise SystemExit(0)
    assert ended.value.code == 0
    assert capsys.readouterr().err == ""


def test_errors_of_files_are_not_those_of_the_output() -> None:
    error = FileNotFoundError(errno.ENOENT, "No such file or directory", "a")
    with pytest.raises(FileNotFoundError), reporting_failed_writes():
        raise error


def test_closed_streams_are_replaced(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("stdin", "stdout", "stderr"):
        monkeypatch.setattr(f"sys.{name}", None)
    prepare()
    show("x")
    assert not sys.stdin.read()
    for stream in (sys.stdin, sys.stdout, sys.stderr):
        stream.close()


@pytest.mark.parametrize("encoding", ["ascii", "latin-1"])
def test_characters_that_the_encoding_lacks_are_escaped(
    monkeypatch: pytest.MonkeyPatch, encoding: str
) -> None:
    written = io.BytesIO()
    monkeypatch.setattr("sys.stdout", io.TextIOWrapper(written, encoding))
    prepare()
    show("✓ ok")
    assert written.getvalue() == b"\\u2713 ok\n"
