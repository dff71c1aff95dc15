"""diagnostic_updater: diagnostics of a node on ``/diagnostics``."""

from navette.ros2.packages.diagnostic_updater._diagnostic_status_wrapper import (
    DiagnosticStatusWrapper,
)
from navette.ros2.packages.diagnostic_updater._diagnostic_updater import (
    CompositeDiagnosticTask,
    DiagnosticTask,
    DiagnosticTaskVector,
    FunctionDiagnosticTask,
    Updater,
)
from navette.ros2.packages.diagnostic_updater._publisher import (
    DiagnosedPublisher,
    HeaderlessTopicDiagnostic,
    TopicDiagnostic,
)
from navette.ros2.packages.diagnostic_updater._update_functions import (
    FrequencyStatus,
    FrequencyStatusParam,
    Heartbeat,
    TimeStampStatus,
    TimeStampStatusParam,
)
