"""Child processes: started, listened to, ended, and never orphaned."""

from navette.processes.child import (
    INTERRUPT,
    KILL,
    TERMINATE,
    ChildProcess,
    Listener,
)
from navette.processes.ending import SIGNAL_NAMES, Ending, Patience
from navette.processes.guard import sweep, without_marks
from navette.processes.keeper import Keeper, ProcessError, StartOptions
from navette.processes.lines import LineCutter
from navette.processes.outcome import describe_exit

__all__ = [
    "ChildProcess",
    "Ending",
    "INTERRUPT",
    "KILL",
    "Keeper",
    "LineCutter",
    "Listener",
    "Patience",
    "ProcessError",
    "SIGNAL_NAMES",
    "StartOptions",
    "TERMINATE",
    "describe_exit",
    "sweep",
    "without_marks",
]
