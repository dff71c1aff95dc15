"""Arguments and options that several verbs of ``navette bag`` take."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from navette.cli.options import Argument, Option

Bag = Annotated[
    Path,
    Argument(metavar="BAG", help="A .mcap, .bag or .db3 file, or a rosbag2 folder."),
]
Bags = Annotated[
    list[Path], Argument(metavar="BAG...", help="Files or rosbag2 folders.")
]
Topics = Annotated[
    list[str] | None,
    Option(
        "--topic", "-t", metavar="NAME", help="Keep this topic. Repeat for several."
    ),
]
Types = Annotated[
    list[str] | None,
    Option(
        "--type", metavar="TYPE", help="Keep topics of this type. Repeat for several."
    ),
]
Regex = Annotated[
    str,
    Option("--regex", "-e", metavar="PATTERN", help="Keep matching topics."),
]
Exclude = Annotated[
    str,
    Option("--exclude", "-x", metavar="PATTERN", help="Omit matching topics."),
]
Start = Annotated[
    str,
    Option(
        "--start",
        metavar="TIME",
        help="Start time: seconds after the first message (12.5), before the last"
        " message (-3), or since 1970 (1502792570.5).",
    ),
]
End = Annotated[
    str, Option("--end", metavar="TIME", help="End time, in the forms of --start.")
]
Duration = Annotated[
    float | None,
    Option("--duration", "-u", metavar="S", help="Duration from the start."),
]


@dataclass(frozen=True, kw_only=True)
class WriteOptions:
    """The recording to write."""

    output: Annotated[
        Path,
        Option(
            "--output",
            "-o",
            metavar="FILE",
            help="File to write: .mcap, .bag or .db3. Without a suffix and with"
            " --storage sqlite3: a rosbag2 folder.",
        ),
    ]
    storage: Annotated[
        str,
        Option(
            "--storage",
            "-s",
            metavar="FORMAT",
            help="mcap, sqlite3 or rosbag1. Default: from the suffix.",
        ),
    ] = ""
    compression: Annotated[
        str,
        Option(
            metavar="KIND",
            help="none, zstd, lz4 or bz2, if the format supports it. Default for .mcap:"
            " zstd.",
        ),
    ] = ""
    overwrite: Annotated[
        bool, Option("--overwrite", help="Replace an existing recording.")
    ] = False
