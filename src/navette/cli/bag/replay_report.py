"""Format the result of a replay as text and JSON."""

from pathlib import Path
from typing import Any

from navette.bags.compare import Comparison, TopicComparison
from navette.cli.bag.text import counted
from navette.cli.output import aligned, show, styled
from navette.cli.stderr import note
from navette.navigation.stack.replay import ReplaySummary


def report(
    summary: ReplaySummary, comparison: Comparison | None, record: Path | None
) -> None:
    """Print the summary on standard error and the differences on standard output."""
    factor = summary.duration_s / summary.wall_time_s if summary.wall_time_s else 0.0
    note(
        f"fed {counted(summary.fed, 'message')} on {', '.join(summary.inputs)}: "
        f"{summary.duration_s:.1f} s in {summary.wall_time_s:.1f} s (×{factor:.0f})"
    )
    if record is not None:
        note(f"recorded {counted(summary.recorded, 'message')} in {record}")
    if comparison is not None:
        show("\n".join(_comparison_lines(comparison, summary.begin_ns)))


def _comparison_lines(comparison: Comparison, begin_ns: int) -> list[str]:
    if not comparison.topics:
        return ["no messages of these nodes to compare", *_not_compared(comparison)]
    rows: list[list[str]] = [["", "topic", "compared", "differ", "missing", "extra"]]
    for topic in comparison.topics:
        counts = topic.compared, topic.differing, topic.missing, topic.extra
        rows.append(["✓" if topic.same else "✗", topic.name, *map(str, counts)])
    head, *rest = aligned(rows)
    colours = ("green" if topic.same else "red" for topic in comparison.topics)
    lines = [head, *map(_coloured, rest, colours)]
    for topic in comparison.topics:
        lines += _topic_lines(topic, begin_ns)
    return lines + _not_compared(comparison)


def _not_compared(comparison: Comparison) -> list[str]:
    lines = []
    if comparison.unexpected:
        lines.append(f"new topics, not compared: {', '.join(comparison.unexpected)}")
    if comparison.of_others:
        topics = ", ".join(comparison.of_others)
        lines.append(
            f"not compared: {topics}: other nodes published there too, and a recording "
            "does not state whose message is whose; in the replay nothing was published"
        )
    return lines


def _coloured(line: str, colour: str) -> str:
    return styled(line, fg=colour)


def _topic_lines(topic: TopicComparison, begin_ns: int) -> list[str]:
    if topic.problem:
        return ["", f"{topic.name}: {topic.problem}"]
    if not topic.fields:
        return []
    rows = [("field", "messages", "elements", "apart by", "first at", "e.g.")]
    for each in topic.fields.values():
        worst = each.worst
        assert worst is not None, "a field is listed with its first difference"
        apart = "" if worst.largest is None else f"{worst.largest:.3g}"
        of = f"{worst.differing} of {worst.elements}" if worst.elements > 1 else ""
        first = f"{(each.first_ns - begin_ns) / 1e9:.3f} s"
        example = f"{worst.expected} → {worst.got}"
        rows.append((each.path, str(each.messages), of, apart, first, example))
    return ["", styled(topic.name, bold=True), *(f"  {x}" for x in aligned(rows))]


def as_document(
    summary: ReplaySummary, comparison: Comparison | None, record: Path | None
) -> dict[str, Any]:
    """Return the result for JSON."""
    document: dict[str, Any] = {
        "inputs": list(summary.inputs),
        "outputs": list(summary.outputs),
        "fed": summary.fed,
        "recorded": summary.recorded,
        "record": None if record is None else str(record),
        "duration_s": summary.duration_s,
        "wall_time_s": round(summary.wall_time_s, 3),
    }
    if comparison is not None:
        document["same"] = comparison.same
        document["new_topics"] = list(comparison.unexpected)
        document["not_compared"] = list(comparison.of_others)
        document["topics"] = [_topic_document(topic) for topic in comparison.topics]
    return document


def _topic_document(topic: TopicComparison) -> dict[str, Any]:
    return {
        "topic": topic.name,
        "type": topic.type_name,
        "same": topic.same,
        "compared": topic.compared,
        "differing": topic.differing,
        "missing": topic.missing,
        "extra": topic.extra,
        "problem": topic.problem or None,
        "fields": [
            {
                "field": each.path,
                "messages": each.messages,
                "first_at_ns": each.first_ns,
                "largest": None if each.worst is None else each.worst.largest,
                "expected": None if each.worst is None else each.worst.expected,
                "got": None if each.worst is None else each.worst.got,
            }
            for each in topic.fields.values()
        ],
    }
