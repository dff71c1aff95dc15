"""Start, watch, restart and end child processes; ``navette up`` and ``navette launch``.

One mechanism for both: :class:`ProcessManager` starts child processes and guards them,
:class:`ManagedProcess` restarts and terminates one of them.
"""

from navette.supervisor.child import (
    INTERRUPT,
    KILL,
    TERMINATE,
    ChildProcess,
    ProcessHandle,
    ProcessListener,
)
from navette.supervisor.exit_code import describe_exit
from navette.supervisor.fork_server import ForkServer
from navette.supervisor.lines import LineSplitter
from navette.supervisor.managed_process import ManagedProcess
from navette.supervisor.process_manager import (
    ProcessError,
    ProcessManager,
    StartOptions,
)
from navette.supervisor.service_config import (
    ProcessConfig,
    ProcessState,
    RestartPolicy,
    ServiceConfig,
)
from navette.supervisor.terminator import GracePeriods

__all__ = [
    "ChildProcess",
    "ForkServer",
    "GracePeriods",
    "INTERRUPT",
    "KILL",
    "LineSplitter",
    "ManagedProcess",
    "ProcessError",
    "ProcessHandle",
    "ProcessListener",
    "ProcessManager",
    "ProcessConfig",
    "ProcessState",
    "RestartPolicy",
    "ServiceConfig",
    "StartOptions",
    "TERMINATE",
    "describe_exit",
]
