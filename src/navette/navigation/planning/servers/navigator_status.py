"""Publish and log the navigator's status."""

from navette.msgs import topics
from navette.navigation.planning.outcome import Outcome
from navette.navigation.planning.reports import NavigatorReport, Phase
from navette.runtime import StageNode
from navette.runtime.stage.status import StatusReporter, spelled

# Temporary failures; all others end the goal.
_TEMPORARY = (Outcome.STALE_ODOMETRY, Outcome.LOST)


class NavigatorStatus:
    """Publisher of the status on ``/planner/status``, which also logs changes."""

    def __init__(self, node: StageNode) -> None:
        self._reporter = StatusReporter(node, topics.PLANNER_STATUS.name)
        self._logger = node.get_logger()
        self._logged = self._fault = ""

    def report(self, report: NavigatorReport, *, is_logged: bool = False) -> None:
        """Log the status if it has changed and was not logged already; publish it.

        Logged first, because nodes that end with the goal may end the program.
        """
        text = f"{report.message} {report.plan}"
        if text != self._logged:
            self._logged = text
            if not is_logged:
                self._log(report)
        self._reporter.report(
            report.message,
            _level(report),
            phase=report.state.value,
            goal_id=report.goal_id,
            retry=report.retry,
            goal_x=report.goal_x,
            goal_y=report.goal_y,
            distance_left_m=report.distance_left_m,
            result=report.result,
            plan=report.plan,
            margin_m=report.margin_m,
            replans=report.replans,
        )

    def _log(self, report: NavigatorReport) -> None:
        logger = self._logger
        goal = goal_text(report)
        if report.fault and report.fault != self._fault:
            self._fault = report.fault
            logger.error(f"{goal}: {report.message}: {report.fault}")
        elif report.failed:
            logger.warning(f"{goal}: {spelled(report.message)}")
        elif report.message == Phase.FOLLOWING:
            near = "" if report.plan == Outcome.OK else f" ({report.plan})"
            logger.info(f"{goal}: {report.distance_left_m:.1f} m to go{near}")
        else:
            logger.info(
                f"{goal}: {report.message}" if report.goal_id else "no goal yet"
            )


def goal_text(report: NavigatorReport) -> str:
    """Return the goal with the number of its first attempt."""
    first = report.goal_id - report.retry
    again = f", retry {report.retry}" if report.retry else ""
    return f"goal {first} ({report.goal_x:.6g}, {report.goal_y:.6g}){again}"


def _level(report: NavigatorReport) -> bytes:
    if not report.failed:
        return StatusReporter.OK
    mild = report.message in (*_TEMPORARY, Outcome.CANCELED)
    return StatusReporter.WARN if mild else StatusReporter.ERROR
