"""Format the findings of ``navette bag check`` as text and JSON."""

from pathlib import Path
from typing import Any

from rich.text import Text

from navette.bags.checking import CheckReport, Severity
from navette.cli.bag.tables import open_console
from navette.cli.bag.text import counted

_STYLES = {Severity.ERROR: "bold red", Severity.WARNING: "yellow"}


def size_of(path: Path) -> int | None:
    """Return the size in bytes of a file or of the files in a folder."""
    if path.is_file():
        return path.stat().st_size
    if path.is_dir():
        return sum(each.stat().st_size for each in path.iterdir() if each.is_file())
    return None


def show_report(report: CheckReport) -> None:
    """Print a line for each finding, and the verdict."""
    console = open_console()
    for finding in report.findings:
        severity = f"{finding.severity.value:<8}"
        style = _STYLES[finding.severity]
        console.print(Text.assemble((severity, style), finding.text))
    count = counted(report.messages, "message")
    if report.is_sound:
        verdict, rest = ("sound", "bold green"), f": {count} read"
    elif report.messages:
        hint = f"navette bag recover {report.path} -o …"
        verdict = ("damaged", "bold red")
        rest = f": {count} readable; {hint} saves what is readable"
    else:
        verdict, rest = ("damaged", "bold red"), ": nothing is readable"
    console.print(Text.assemble(f"{report.path}: ", verdict, rest))


def to_json(report: CheckReport) -> dict[str, Any]:
    """Return the findings for JSON."""
    return {
        "path": str(report.path),
        "sound": report.is_sound,
        "messages": report.messages,
        "findings": [
            {"severity": each.severity.value, "text": each.text}
            for each in report.findings
        ],
    }
