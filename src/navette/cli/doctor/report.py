"""Format the report as text and as JSON."""

from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import Any

from navette.cli.doctor.findings import Diagnosis, Rating, count, plural
from navette.cli.output import harmless, is_terminal, styled, wrapped

_COLOURS = {
    Rating.GOOD: "green",
    Rating.NOTE: None,
    Rating.WARNING: "yellow",
    Rating.PROBLEM: "red",
}


_MOST_LABEL = 20  # characters of a label beside its text


def report_lines(findings: Sequence[Diagnosis], *, everything: bool) -> list[str]:
    """Format findings under headings; the advice follows on the next line.

    Args:
        everything: include good findings and notes, not only warnings and problems.
    """
    shown = [
        each
        for each in findings
        if everything or each.level in (Rating.WARNING, Rating.PROBLEM)
    ]
    lengths = [len(each.what) for each in shown]
    width = max((each for each in lengths if each <= _MOST_LABEL), default=0)
    lines: list[str] = []
    for section, group in groupby(shown, key=lambda each: each.section):
        lines += (
            ["", styled(section, bold=True)] if lines else [styled(section, bold=True)]
        )
        for each in group:
            lines += _finding_lines(each, width)
    return lines


def _finding_lines(finding: Diagnosis, width: int) -> Iterator[str]:
    mark = styled(finding.level.value, fg=_COLOURS[finding.level], bold=True)
    head = f"  {mark} {finding.what.ljust(width)}  "
    indent = " " * (width + 6)
    if len(finding.what) > width and is_terminal():
        yield head.rstrip()  # a label above its text keeps the column
        head = indent
    quiet = {"dim": True} if finding.level is Rating.NOTE else {}
    for line in wrapped(harmless(finding.text), len(indent)):
        yield head + styled(line, **quiet)
        head = indent
    arrow = styled("→", fg="cyan")
    for line in wrapped(finding.advice, len(indent) + 2):
        yield f"{indent}{arrow} {line}"
        arrow = " "


def summary(findings: Sequence[Diagnosis]) -> str:
    """Return the last line of the report."""
    problems = count(findings, Rating.PROBLEM)
    warnings = count(findings, Rating.WARNING)
    if not problems and not warnings:
        return styled("no problems", fg="green", bold=True)
    parts = []
    if problems:
        parts.append(styled(plural(problems, "problem"), fg="red", bold=True))
    if warnings:
        text = plural(warnings, "warning")
        parts.append(styled(text, fg="yellow", bold=True))
    return ", ".join(parts)


def as_json(findings: Sequence[Diagnosis]) -> dict[str, Any]:
    return {
        "problems": count(findings, Rating.PROBLEM),
        "warnings": count(findings, Rating.WARNING),
        "findings": [each.as_dict() for each in findings],
    }
