"""Start, watch and end child processes; keep the services of ``navette up`` running."""

from navette.supervisor.child import (
    INTERRUPT,
    KILL,
    TERMINATE,
    ChildProcess,
    Listener,
)
from navette.supervisor.ending import SIGNAL_NAMES, Ending, Patience
from navette.supervisor.guard import sweep, without_marks
from navette.supervisor.keeper import Keeper, ProcessError, StartOptions
from navette.supervisor.lines import LineCutter
from navette.supervisor.outcome import describe_exit
from navette.supervisor.specs import ModuleSpec, ProcessSpec, RestartPolicy

__all__ = [
    "ChildProcess",
    "Ending",
    "INTERRUPT",
    "KILL",
    "Keeper",
    "LineCutter",
    "Listener",
    "ModuleSpec",
    "Patience",
    "ProcessError",
    "ProcessSpec",
    "RestartPolicy",
    "SIGNAL_NAMES",
    "StartOptions",
    "TERMINATE",
    "describe_exit",
    "sweep",
    "without_marks",
]
