"""Print the summary of a recording."""

from collections import Counter

from rich.console import Console
from rich.text import Text

from navette.bags.qos import OfferedQos
from navette.bags.recording_file import is_being_recorded
from navette.bags.summary import BagSummary, TopicSummary
from navette.cli.bag.tables import Table, new_table, open_console, show_table
from navette.cli.bag.text import (
    count_text,
    duration_text,
    gap_text,
    rate_text,
    size_text,
    stamp_text,
)
from navette.errors import UnknownNameError

_FORMATS = {"mcap": "MCAP", "rosbag1": "ROS 1 bag", "sqlite3": "rosbag2 SQLite"}
# Mark gaps in which at least this number of messages is missing.
_GAP_MESSAGES = 5
# Messages arrive in bursts if the median rate exceeds the mean rate by this factor.
_BURST = 10
_MOST_ROWS = 2000
_MOST_REMARKS = 20


def show_info(summary: BagSummary, *, verbose: bool = False) -> None:
    """Print the summary in the layout of ``rosbag info`` and ``ros2 bag info``."""
    console = open_console()
    for name, value in _head(summary).items():
        console.print(Text.assemble((f"{name + ':':<13}", "dim"), value))
    if verbose and len(summary.files) > 1:
        for path in summary.files:
            console.print(Text(f"{'':<13}{path.name}", style="dim"))
    _show_problems(console, summary)
    if not summary.topics:
        return
    console.print()
    show_table(console, _table(summary))
    if len(summary.topics) > _MOST_ROWS:
        more = len(summary.topics) - _MOST_ROWS
        console.print(Text(f"… and {more} more; --json prints all", style="dim"))
    if verbose:
        _show_details(console, summary)
    if any(not each.known for each in summary.topics):
        console.print(
            Text("* not installed or another version; still readable", style="dim")
        )


def _show_problems(console: Console, summary: BagSummary) -> None:
    for problem in summary.problems:
        console.print(Text.assemble((f"{'damaged:':<13}", "bold yellow"), problem))
    for remark in summary.remarks[:_MOST_REMARKS]:
        console.print(Text.assemble((f"{'note:':<13}", "dim"), remark))
    if is_being_recorded(summary.path):
        text = "being recorded; it has no index until then"
        console.print(Text.assemble((f"{'note:':<13}", "dim"), text))
    elif summary.problems:
        hint = f"navette bag recover {summary.path} -o FILE.mcap writes an intact copy"
        console.print(Text.assemble((f"{'':<13}", "dim"), (hint, "dim")))


def value_of(summary: BagSummary, key: str) -> str:
    """Return one value as plain text.

    Raises:
        UnknownNameError: unknown key; the message lists the known ones.
    """
    values = {name: str(value) for name, value in summary.to_json().items()}
    values |= {
        "duration": f"{summary.duration_s:.9f}",
        "start": f"{summary.start_ns / 1e9:.9f}",
        "end": f"{summary.end_ns / 1e9:.9f}",
        "compression": _compression(summary),
        "topics": "\n".join(each.topic.name for each in summary.topics),
        "types": "\n".join(sorted({each.topic.type_name for each in summary.topics})),
        "problems": "\n".join(summary.problems),
        "files": "\n".join(map(str, summary.files)),
    }
    if key not in values:
        raise UnknownNameError.of("key", key, sorted(values))
    return values[key]


def _head(summary: BagSummary) -> dict[str, str]:
    files = f" in {len(summary.files)} files" if len(summary.files) > 1 else ""
    return {
        "path": str(summary.path),
        "format": f"{_FORMATS[summary.storage]} {summary.version}",
        "duration": duration_text(summary.duration_s),
        "start": stamp_text(summary.start_ns),
        "end": stamp_text(summary.end_ns),
        "size": size_text(summary.size) + files,
        "messages": count_text(summary.messages),
        "compression": _compression(summary),
    }


def _compression(summary: BagSummary) -> str:
    kinds = summary.compression
    if summary.storage == "sqlite3":
        return ", ".join(kinds) or "none"
    chunks = sum(kinds.values())
    return (
        ", ".join(
            f"{kind} [{count}/{chunks} chunks]" for kind, count in sorted(kinds.items())
        )
        or "none [no chunks]"
    )


def _table(summary: BagSummary) -> Table:
    table = new_table("topic", "~type", ">messages", ">rate", ">longest gap", "qos")
    for each in summary.topics[:_MOST_ROWS]:
        table.add_row(
            Text(each.topic.name, style="cyan"),
            Text(each.topic.type_name + ("" if each.known else " *")),
            Text(count_text(each.count), style="" if each.count else "dim"),
            _rate(each),
            _gap(each),
            Text(_qos(each.topic.qos), style="dim"),
        )
    return table


def _comes_in_bursts(each: TopicSummary) -> bool:
    return each.mean_rate_hz is not None and (
        each.rate_hz is None or each.rate_hz > _BURST * each.mean_rate_hz
    )


def _rate(each: TopicSummary) -> str:
    """Format the median rate; for bursts the mean rate."""
    if _comes_in_bursts(each):
        return f"~{rate_text(each.mean_rate_hz)}"
    return rate_text(each.rate_hz)


def _gap(each: TopicSummary) -> Text:
    """Format the longest gap; highlighted if a regular topic was interrupted."""
    text = gap_text(each.longest_gap_s)
    interrupted = (
        each.longest_gap_s is not None
        and each.rate_hz is not None
        and not _comes_in_bursts(each)
        and each.count > 2 * _GAP_MESSAGES
        and each.longest_gap_s * each.rate_hz > _GAP_MESSAGES
    )
    if not interrupted or each.gap_start_s is None:
        return Text(text)
    return Text(f"{text} at {each.gap_start_s:.1f} s", style="yellow")


def _qos(offers: tuple[OfferedQos, ...]) -> str:
    """Return the policies that differ from the defaults."""
    words = []
    if any(each.reliability == "best_effort" for each in offers):
        words.append("best effort")
    if any(each.durability == "transient_local" for each in offers):
        words.append("latched")
    return ", ".join(words)


def _show_details(console: Console, summary: BagSummary) -> None:
    hashes = Counter(
        (each.topic.type_name, each.topic.type_hash) for each in summary.topics
    )
    console.print()
    for (name, type_hash), _ in sorted(hashes.items()):
        console.print(Text.assemble(f"{name}  ", (type_hash or "no hash", "dim")))
    console.print()
    for each in summary.topics:
        for offer in each.topic.qos:
            text = f"{offer.reliability}, {offer.durability}, {offer.history}"
            console.print(
                Text.assemble(
                    (f"{each.topic.name}  ", "cyan"), (f"{text} {offer.depth}", "dim")
                )
            )
