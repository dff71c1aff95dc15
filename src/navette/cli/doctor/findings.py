"""Findings of the doctor."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

from navette.errors import join_names

TOPICS = "Topics"


class Rating(Enum):
    """Severity; the value is the printed mark."""

    GOOD = "✓"
    NOTE = "·"
    WARNING = "!"
    PROBLEM = "✗"


@dataclass(frozen=True)
class Diagnosis:
    """One line of the report.

    Args:
        section: heading in the report.
        what: the checked object, in one or two words.
        text: state or problem of the object.
        advice: what to do; empty if nothing.
        data: details for programs.
    """

    level: Rating
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


def count(findings: Iterable[Diagnosis], level: Rating) -> int:
    return sum(finding.level is level for finding in findings)


def plural(number: int, thing: str) -> str:
    """Return ``1 node``, ``2 nodes`` or ``no nodes``."""
    return f"{number or 'no'} {thing}{'' if number == 1 else 's'}"


def listed(names: Iterable[str]) -> str:
    """Join the sorted names with commas; of many, the rest is a number."""
    return join_names(sorted(names), most=6)
