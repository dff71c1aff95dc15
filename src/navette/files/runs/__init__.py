"""Private runs of this user: found by the user's other programs, by no one else."""

from navette.files.runs.choice import (
    SHARED,
    VARIABLE,
    chosen_run,
    every_network,
    named_run,
    pin_run,
    shares,
    stay_shared,
)
from navette.files.runs.entry import RunInfo
from navette.files.runs.private_run import PrivateRun
from navette.files.runs.registry import live_runs

__all__ = [
    "PrivateRun",
    "RunInfo",
    "SHARED",
    "VARIABLE",
    "chosen_run",
    "every_network",
    "live_runs",
    "named_run",
    "pin_run",
    "shares",
    "stay_shared",
]
