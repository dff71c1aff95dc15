"""``navette bag recover|convert|filter|cut|merge``: commands that write a new one."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import click

from navette.cli.bag.options import (
    Bag,
    Bags,
    Compression,
    Duration,
    End,
    Exclude,
    Output,
    Overwrite,
    Regex,
    Start,
    Storage,
    Topics,
    Types,
)
from navette.cli.options import Option
from navette.cli.session import FAILED
from navette.cli.stderr import note

if TYPE_CHECKING:
    from navette.bags import BagMessage, BagReader, Damage
    from navette.bags.editing import MessageFilter


def recover(
    bag: Bag,
    output: Output,
    storage: Storage = "",
    compression: Compression = "",
    overwrite: Overwrite = False,
) -> None:
    """Write what is good of a damaged or killed recording into a new one.

    Exits 0 if anything could be saved.
    """
    from navette.bags import open_bag

    lost: list[str] = []

    def damaged(damage: "Damage") -> None:
        lost.append(damage.reason)
        note(f"lost: {damage.reason}")

    with open_bag(bag) as reader:
        for problem in reader.problems:
            note(f"damaged: {problem}")
        count = _copy(
            reader,
            output,
            storage=storage,
            compression=compression,
            overwrite=overwrite,
            on_damage=damaged,
        )
    if count == 0 and lost:
        raise click.exceptions.Exit(FAILED)


def convert(
    bag: Bag,
    output: Output,
    storage: Storage = "",
    compression: Compression = "",
    overwrite: Overwrite = False,
) -> None:
    """Write a recording in another format, or compressed in another way.

    Types and messages of ROS 1 become ROS 2's and the other way round.
    """
    from navette.bags import open_bag

    with open_bag(bag) as reader:
        _copy(
            reader,
            output,
            storage=storage,
            compression=compression,
            overwrite=overwrite,
        )


def filter_(
    bag: Bag,
    output: Output,
    topic: Topics = None,
    type_: Types = None,
    regex: Regex = "",
    exclude: Exclude = "",
    start: Start = "",
    end: End = "",
    where: Annotated[
        str,
        Option(
            metavar="PYTHON",
            help="Take messages for which this holds; it knows topic (name), t (s) and"
            ' m (message), as in "m.twist.twist.linear.x > 1".',
        ),
    ] = "",
    storage: Storage = "",
    compression: Compression = "",
    overwrite: Overwrite = False,
) -> None:
    """Write only some topics, types, times or messages."""
    from navette.bags import open_bag
    from navette.bags.editing import MessageFilter

    with open_bag(bag) as reader:
        selected = MessageFilter(
            topics=tuple(topic or ()),
            types=tuple(type_ or ()),
            regex=regex,
            exclude=exclude,
            start_ns=_time(start, reader),
            end_ns=_time(end, reader),
            expression=where,
        )
        _copy(
            reader,
            output,
            selected,
            storage=storage,
            compression=compression,
            overwrite=overwrite,
        )


def cut(
    bag: Bag,
    output: Output,
    start: Start = "",
    end: End = "",
    duration: Duration = None,
    storage: Storage = "",
    compression: Compression = "",
    overwrite: Overwrite = False,
) -> None:
    """Write the part between two times."""
    from navette.bags import open_bag
    from navette.bags.editing import MessageFilter

    with open_bag(bag) as reader:
        first = _time(start, reader)
        last = _time(end, reader)
        if duration is not None:
            if end:
                raise click.BadParameter("--end and --duration say the same")
            begin = first if first is not None else reader.start_ns
            last = begin + round(duration * 1e9)
        _copy(
            reader,
            output,
            MessageFilter(start_ns=first, end_ns=last),
            storage=storage,
            compression=compression,
            overwrite=overwrite,
        )


def merge(
    bags: Bags,
    output: Output,
    storage: Storage = "",
    compression: Compression = "",
    overwrite: Overwrite = False,
) -> None:
    """Write several recordings as one, in the order of time."""
    from navette.bags.editing import join

    with join(bags) as reader:
        _copy(
            reader,
            output,
            storage=storage,
            compression=compression,
            overwrite=overwrite,
        )


def _copy(
    reader: "BagReader",
    output: Path,
    selected: "MessageFilter | None" = None,
    *,
    storage: str,
    compression: str,
    overwrite: bool,
    on_damage: "Callable[[Damage], None] | None" = None,
) -> int:
    from navette.bags.editing import copy
    from navette.bags.writing import open_writer
    from navette.cli.bag.progress import progress
    from navette.cli.bag.text import count_text, size_text

    if output.exists() and any(output.samefile(path) for path in reader.files):
        raise click.BadParameter(f"{output} is what is read; it is not written over")
    writer = open_writer(
        output, storage=storage, compression=compression, overwrite=overwrite
    )
    first, last = reader.start_ns, reader.end_ns
    with progress(f"writing {output.name}", (last - first) / 1e9) as advance:
        at = first

        def on_message(message: "BagMessage") -> None:
            nonlocal at
            if advance is not None and message.stamp_ns - at > 100_000_000:
                advance((message.stamp_ns - at) / 1e9)
                at = message.stamp_ns

        count = copy(
            reader, writer, selected, on_message=on_message, on_damage=on_damage
        )
    size = output.stat().st_size if output.is_file() else 0
    how_large = f", {size_text(size)}" if size else ""
    note(f"{output}: {count_text(count)} messages{how_large}")
    return count


def _time(text: str, reader: "BagReader") -> int | None:
    """A stamp from seconds since the start, before the end, or since 1970."""
    if not text:
        return None
    try:
        nanoseconds = round(float(text) * 1e9)
    except (ValueError, OverflowError):
        raise click.BadParameter(f"{text!r} is no time in seconds") from None
    if text.startswith("-"):
        return reader.end_ns + nanoseconds
    if nanoseconds <= reader.end_ns - reader.start_ns or nanoseconds < reader.start_ns:
        return reader.start_ns + nanoseconds
    return nanoseconds
