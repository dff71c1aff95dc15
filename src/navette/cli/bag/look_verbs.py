"""``navette bag info``, ``list`` and ``check``: verbs that only read."""

from pathlib import Path
from typing import Annotated

import click

from navette.cli.bag.options import Bags
from navette.cli.options import Argument, Json, Option
from navette.cli.output import show, show_json
from navette.cli.session import FAILED
from navette.cli.stderr import note
from navette.files.untrusted.escaping import escaped


def info(
    bags: Bags,
    verbose: Annotated[
        bool, Option("--verbose", "-v", help="Also print type hashes, QoS and files.")
    ] = False,
    key: Annotated[
        str,
        Option(
            "--key",
            "-k",
            metavar="NAME",
            help="Print only this value: path, duration, start, end, size, messages, …",
        ),
    ] = "",
    topic_name: Annotated[
        bool, Option("--topic-name", "-t", help="Print only the topic names.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Show time, size and topics of a recording, with type, count and rate."""
    from navette.bags import open_bag
    from navette.bags.summary import summarise
    from navette.cli.bag import info_text
    from navette.cli.bag.progress import progress

    summaries = []
    for path in bags:
        with open_bag(path) as reader, progress("reading stamps", None) as advance:
            summaries.append(summarise(reader, advance))
    if as_json:
        found = [each.to_json() for each in summaries]
        show_json(found[0] if len(found) == 1 else found)
        return
    for number, summary in enumerate(summaries):
        if key:
            show(escaped(info_text.value_of(summary, key)))
        elif topic_name:
            for each in summary.topics:
                show(escaped(each.topic.name))
        else:
            if number:
                show()
            info_text.show_info(summary, verbose=verbose)


def list_(
    folder: Annotated[
        Path, Argument(metavar="[FOLDER]", help="Default: the current folder.")
    ] = Path(),
    recursive: Annotated[
        bool, Option("--recursive", "-r", help="Include subfolders.")
    ] = False,
    as_json: Json = False,
) -> None:
    """List the recordings in a folder with time, duration and size."""
    from navette.cli.bag import listing

    found = listing.find(folder, recursive=recursive)
    if as_json:
        show_json([each.to_json() for each in found])
    elif found:
        listing.show_list(found)
    else:
        note(f"no recordings in {folder}")


def check(
    bags: Bags,
    decode: Annotated[
        bool, Option("--decode", help="Also decode every message.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Check recordings for damage; the exit code is 0 if there is none.

    Reads the whole file: header and footer, index, lengths and checksums of chunks,
    message counts, and the order of stamps.
    """
    from navette.bags.checking import check_bag
    from navette.cli.bag import report
    from navette.cli.bag.progress import progress

    reports = []
    for path in bags:
        size = report.size_of(path)
        with progress(f"checking {path.name}", size, as_bytes=True) as advance:
            reports.append(check_bag(path, decode=decode, on_bytes=advance))
    if as_json:
        found = [report.to_json(each) for each in reports]
        show_json(found[0] if len(found) == 1 else found)
    else:
        for each in reports:
            report.show_report(each)
    if not all(each.is_sound for each in reports):
        raise click.exceptions.Exit(FAILED)
