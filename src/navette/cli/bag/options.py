"""Arguments and options that several verbs of ``navette bag`` take."""

from pathlib import Path
from typing import Annotated

from navette.cli.options import Argument, Option

Bag = Annotated[
    Path,
    Argument(metavar="BAG", help="A .mcap, .bag or .db3 file, or a folder of rosbag2."),
]
Bags = Annotated[
    list[Path], Argument(metavar="BAG...", help="Files or folders of rosbag2.")
]
Output = Annotated[
    Path,
    Option(
        "--output",
        "-o",
        metavar="FILE",
        help="What to write: .mcap, .bag, .db3; a name without suffix with"
        " --storage sqlite3 is a folder as rosbag2 makes it.",
    ),
]
Storage = Annotated[
    str,
    Option(
        "--storage",
        "-s",
        metavar="FORMAT",
        help="mcap, sqlite3 or rosbag1; by default as the name says.",
    ),
]
Compression = Annotated[
    str,
    Option(
        metavar="KIND",
        help="none, zstd, lz4 or bz2, as far as the format has it; .mcap: zstd.",
    ),
]
Overwrite = Annotated[
    bool, Option("--overwrite", help="Replace a recording of that name.")
]
Json = Annotated[bool, Option("--json", help="Print one JSON object.")]
Topics = Annotated[
    list[str] | None,
    Option("--topic", "-t", metavar="NAME", help="Take this topic; repeat."),
]
Types = Annotated[
    list[str] | None,
    Option("--type", metavar="TYPE", help="Take topics of this type; repeat."),
]
Regex = Annotated[
    str,
    Option("--regex", "-e", metavar="PATTERN", help="Take topics that match."),
]
Exclude = Annotated[
    str,
    Option("--exclude", "-x", metavar="PATTERN", help="Leave out what matches."),
]
Start = Annotated[
    str,
    Option(
        "--start",
        metavar="TIME",
        help="From here on: seconds since the first message (12.5), before the last"
        " (-3), or seconds since 1970 (1502792570.5).",
    ),
]
End = Annotated[str, Option("--end", metavar="TIME", help="Up to here, as --start.")]
Duration = Annotated[
    float | None,
    Option("--duration", "-u", metavar="S", help="So long from the start on."),
]
