"""``navette bag recover``, ``convert``, ``filter``, ``cut`` and ``merge``."""

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated

import click

from navette.cli.bag.options import (
    Bag,
    Bags,
    Duration,
    End,
    Exclude,
    Regex,
    Start,
    Topics,
    Types,
    WriteOptions,
)
from navette.cli.options import Option
from navette.cli.session import FAILED
from navette.cli.stderr import note
from navette.errors import InvalidValueError

if TYPE_CHECKING:
    from navette.bags import BagReader, Damage
    from navette.bags.editing import MessageFilter


def recover(bag: Bag, target: WriteOptions) -> None:
    """Copy the readable part of a damaged recording.

    The exit code is 0 if any message was recovered.
    """
    from navette.bags import open_bag

    lost: list[str] = []

    def on_damage(damage: "Damage") -> None:
        lost.append(damage.reason)
        note(f"lost: {damage.reason}")

    with open_bag(bag) as reader:
        for problem in reader.problems:
            note(f"damaged: {problem}")
        count = _copy(reader, target, on_damage=on_damage)
    if count == 0 and lost:
        raise click.exceptions.Exit(FAILED)


def convert(bag: Bag, target: WriteOptions) -> None:
    """Convert a recording to another format or compression.

    Types and messages of ROS 1 are converted to ROS 2 and vice versa.
    """
    from navette.bags import open_bag

    with open_bag(bag) as reader:
        _copy(reader, target)


def filter_(
    bag: Bag,
    target: WriteOptions,
    topic: Topics = None,
    type_: Types = None,
    regex: Regex = "",
    exclude: Exclude = "",
    start: Start = "",
    end: End = "",
    where: Annotated[
        str,
        Option(
            metavar="EXPR",
            help="Keep messages for which the expression is true. Names: topic, t (time"
            ' in s) and m (message), as in "m.twist.twist.linear.x > 1".',
        ),
    ] = "",
) -> None:
    """Copy only some topics, types, times or messages."""
    from navette.bags import open_bag
    from navette.bags.editing import MessageFilter

    with open_bag(bag) as reader:
        first, last = _span(reader, start, end)
        selection = MessageFilter(
            topics=tuple(topic or ()),
            types=tuple(type_ or ()),
            regex=regex,
            exclude=exclude,
            start_ns=first,
            end_ns=last,
            expression=where,
        )
        _copy(reader, target, selection)


def cut(
    bag: Bag,
    target: WriteOptions,
    start: Start = "",
    end: End = "",
    duration: Duration = None,
) -> None:
    """Copy the part between two times."""
    from navette.bags import open_bag
    from navette.bags.editing import MessageFilter

    if end and duration is not None:
        raise click.UsageError("--end and --duration cannot be combined")
    with open_bag(bag) as reader:
        first, last = _span(reader, start, end, duration)
        _copy(reader, target, MessageFilter(start_ns=first, end_ns=last))


def merge(bags: Bags, target: WriteOptions) -> None:
    """Merge several recordings into one, in order of time."""
    from navette.bags.editing import join

    with join(bags) as reader:
        _copy(reader, target)


def _copy(
    reader: "BagReader",
    target: WriteOptions,
    selection: "MessageFilter | None" = None,
    *,
    on_damage: "Callable[[Damage], None] | None" = None,
) -> int:
    """Copy the selected messages and return their number."""
    from navette.bags.editing import copy
    from navette.bags.writing import open_writer
    from navette.cli.bag.progress import progress
    from navette.cli.bag.text import counted, size_text

    output = target.output
    if output.exists() and any(output.samefile(path) for path in reader.files):
        raise click.UsageError(f"--output {output} is the input; give another name")
    writer = open_writer(
        output,
        storage=target.storage,
        compression=target.compression,
        overwrite=target.overwrite,
        profile=reader.profile if reader.storage == "mcap" else "ros2",
    )
    first, last = reader.start_ns, reader.end_ns
    with progress(f"writing {output.name}", (last - first) / 1e9) as advance:
        at = first

        def on_message(stamp_ns: int) -> None:
            nonlocal at
            if advance is not None and stamp_ns - at > 100_000_000:
                advance((stamp_ns - at) / 1e9)
                at = stamp_ns

        count = copy(
            reader, writer, selection, on_message=on_message, on_damage=on_damage
        )
    size = output.stat().st_size if output.is_file() else 0
    suffix = f", {size_text(size)}" if size else ""
    for loss in writer.losses.lines:
        note(f"not kept: {loss}")
    note(f"{output}: {counted(count, 'message')}{suffix}")
    return count


def _span(
    reader: "BagReader", start: str, end: str, duration_s: float | None = None
) -> tuple[int | None, int | None]:
    """Return the first and last stamp of the options; None for the recording's own.

    Raises:
        InvalidValueError: no time of the recording is selected.
    """
    first, last = _time(start, reader), _time(end, reader)
    begin = reader.start_ns if first is None else first
    if duration_s is not None:
        if not 0 < duration_s < math.inf:
            raise InvalidValueError(
                f"--duration {duration_s:g}: expected more than 0 seconds, finite"
            )
        last = begin + round(duration_s * 1e9)
    final = reader.end_ns if last is None else last
    if begin > min(final, reader.end_ns) or final < reader.start_ns:
        duration = "" if duration_s is None else f"{duration_s:g}"
        given = {"--start": start, "--end": end, "--duration": duration}
        words = " ".join(f"{name} {value}" for name, value in given.items() if value)
        raise InvalidValueError(
            f"{words}: no time of the recording, which is from 0 to "
            f"{(reader.end_ns - reader.start_ns) / 1e9:.3f} s ("
            f"{reader.start_ns / 1e9:.3f} to {reader.end_ns / 1e9:.3f} since 1970)"
        )
    return first, last


def _time(text: str, reader: "BagReader") -> int | None:
    """Return a stamp from seconds after the start, before the end, or since 1970."""
    if not text:
        return None
    try:
        nanoseconds = round(float(text) * 1e9)
    except (ValueError, OverflowError):
        raise click.BadParameter(f"{text!r} is not a time in seconds") from None
    if text.startswith("-"):
        return reader.end_ns + nanoseconds
    if nanoseconds <= reader.end_ns - reader.start_ns or nanoseconds < reader.start_ns:
        return reader.start_ns + nanoseconds
    return nanoseconds
