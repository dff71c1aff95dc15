"""Services that read and set log levels."""

from typing import Any

from navette.msgs.rcl_interfaces.msg import LoggerLevel, SetLoggerLevelsResult
from navette.runtime.log import LogHub
from navette.runtime.log_levels import LoggingSeverity
from navette.runtime.node_services import NodeServices


class LoggingService:
    """Server of ``~/get_logger_levels`` and ``~/set_logger_levels`` for a node."""

    def __init__(self, hub: LogHub, services: NodeServices) -> None:
        self._hub = hub
        package = "rcl_interfaces/srv"
        services.serve(f"{package}/GetLoggerLevels", "~/get_logger_levels", self._get)
        services.serve(f"{package}/SetLoggerLevels", "~/set_logger_levels", self._set)

    def _get(self, request: Any, response: Any) -> Any:
        response.levels = [
            LoggerLevel(name=name, level=int(self._hub.get_level(name)))
            for name in request.names
        ]
        return response

    def _set(self, request: Any, response: Any) -> Any:
        response.results = [self._try_set(each) for each in request.levels]
        return response

    def _try_set(self, requested: LoggerLevel) -> SetLoggerLevelsResult:
        known = [int(level) for level in LoggingSeverity]
        if requested.level not in known:
            return SetLoggerLevelsResult(
                successful=False,
                reason=f"logger {requested.name!r}: level {requested.level}; "
                f"known: {known}",
            )
        self._hub.set_level(requested.name, requested.level)
        return SetLoggerLevelsResult(successful=True)
