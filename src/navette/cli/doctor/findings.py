"""What the doctor found: each finding says what is, and what to do about it."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from enum import Enum
from typing import Any


class Level(Enum):
    """How bad it is; the value is the mark that a person sees."""

    GOOD = "✓"
    NOTE = "·"
    WARNING = "!"
    PROBLEM = "✗"


@dataclass(frozen=True)
class Finding:
    """One line of the report.

    Args:
        section: heading that it stands under.
        what: the thing looked at, in a word or two.
        text: what is the matter with it.
        advice: what a person can do; empty where nothing needs doing.
        data: the same for a program, beside the words.
    """

    level: Level
    section: str
    what: str
    text: str
    advice: str = ""
    data: dict[str, Any] = field(default_factory=dict)

    def as_dict(self) -> dict[str, Any]:
        return {
            "level": self.level.name.lower(),
            "section": self.section.lower(),
            "what": self.what,
            "text": self.text,
            "advice": self.advice,
            **({"data": self.data} if self.data else {}),
        }


def count(findings: Iterable[Finding], level: Level) -> int:
    return sum(finding.level is level for finding in findings)


def plural(number: int, thing: str) -> str:
    """``1 node``, ``2 nodes``, ``no nodes``."""
    return f"{number or 'no'} {thing}{'' if number == 1 else 's'}"


def listed(names: Iterable[str], most: int = 6) -> str:
    """Names with commas between; the rest of a long list as a number."""
    every = sorted(names)
    if len(every) <= most:
        return ", ".join(every)
    return f"{', '.join(every[:most])} and {len(every) - most} more"
