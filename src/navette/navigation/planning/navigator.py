"""Navigation to a goal: when to plan, when to keep the path, when to give up.

Two states, as documented for the course's planner: waiting for a goal, and waiting for
the robot to reach it. A path stays valid while the footprint fits along the rest of it.
It is replaced by another path only if that is cheaper by a margin, so that the robot
does not oscillate between paths of equal cost.
"""

import copy
import math
from dataclasses import replace
from typing import Any

import numpy as np

from navette.geometry import Pose2, angle_difference
from navette.navigation.planning.avoided_places import AvoidedPlaces
from navette.navigation.planning.footprint_check import check_path
from navette.navigation.planning.new_map import NewMap
from navette.navigation.planning.outcome import Outcome
from navette.navigation.planning.params import PlannerParams
from navette.navigation.planning.path_progress import PathProgress
from navette.navigation.planning.path_shape import Poses, lengths
from navette.navigation.planning.planner import Goal, Plan, Planner
from navette.navigation.planning.progress_checker import ProgressChecker
from navette.navigation.planning.reports import (
    NavigatorReport,
    Phase,
    RobotMotion,
    State,
)

_STOP = np.empty((0, 3))
# Share of the margin that a path must keep when the map changes by a cell.
_VALID_SHARE = 0.5
# A new path must also be cheaper by this: plans vary by centimetres.
_WORTH_SWITCHING_M = 0.5
# Progress after which a path counts as being driven.
_SET_OUT_M = 0.1
# Period of looking for a cheaper path, if any cost in the map fell.
_COMPARE_PERIOD_NS = 2_000_000_000
# Least time between plans because the controller is blocked.
_BLOCKED_PERIOD_NS = 1_000_000_000
# Of the plans because of it from one place, every third keeps more clearance, each time
# by so much, up to the most. What the controller measures differs by millimetres: it
# would refuse the same path for ever.
_BLOCKED_PLANS, _MORE_MARGIN_M, _MOST_MORE_M = 3, 0.01, 0.05
# A plan that took a search of so many cells, tens of milliseconds, is replaced at most
# with this period while what blocks it is this far ahead and seconds away.
_MANY_CELLS, _FAR_PERIOD_NS, _FAR_M, _FAR_S = 500_000, 2_000_000_000, 5.0, 3.0
# Within this distance of the path's end, every odometry is checked for arrival.
_NEAR_END_M = 1.0


class Navigator:
    """State machine of one goal and its path; :meth:`step` plans and monitors.

    After a call, :attr:`report` is current and :meth:`take_path` returns the path to
    publish. Without a goal, a map or the robot's pose nothing is planned.
    """

    def __init__(self, params: PlannerParams) -> None:
        self.params = params
        self.planner = Planner(params)
        self.report = NavigatorReport()
        self._map: NewMap | None = None
        self._avoided = AvoidedPlaces()
        self._has_map = False
        self._map_changed = False
        self._goal: Goal | None = None
        self._plan: Plan | None = None
        self._progress: PathProgress | None = None
        self._checker = ProgressChecker(params)
        self._published: Poses | None = None
        self._to_publish: Poses | None = None
        self._stepped_ns = self._compared_ns = self._planned_ns = 0
        self._blocked = False
        self._blocked_ns = -_BLOCKED_PERIOD_NS  # of the last plan because of it
        self._blocked_plans = 0  # since the robot last drove
        self._set_out = False
        self._jumped = False
        self._paused_ns: int | None = None

    def copy(self) -> "Navigator":
        """Return a navigator in the same state that changes independently."""
        other = copy.copy(self)
        other.planner = self.planner.copy()
        other._avoided = self._avoided.copy()
        other._progress = copy.copy(self._progress)
        other._checker = copy.copy(self._checker)
        return other

    def set_map(self, new: NewMap) -> None:
        """Replace the map; the next step checks the path against it."""
        self._map = new._replace(changed=None)
        self._apply_map(new)

    def _apply_map(self, new: NewMap | None = None) -> None:
        new = self._map if new is None else new
        if new is not None:
            if self._avoided:
                marked = self._avoided.marked(new.cells, new.spec)
                new = new._replace(cells=marked, changed=None)
            self.planner.set_map(new)
            self._has_map = self._map_changed = True

    def avoid_place(self) -> bool:
        """Plan around the place where the robot got stuck; False if there is none."""
        avoided = self._avoided.avoid()
        if avoided:
            self._apply_map()
        return avoided

    def set_goal(self, goal: Goal, now_ns: int) -> None:
        """Replace the goal; the next step plans."""
        self._replace_goal(goal)
        if not all(map(math.isfinite, (goal.x, goal.y, goal.yaw or 0.0))):
            self._finish(Outcome.GOAL_NOT_FINITE)
            return
        self._goal = goal
        if self._avoided.note_goal((goal.x, goal.y)):
            self._apply_map()
        self._set_out = False
        self._checker.begin(now_ns)
        if self._paused_ns is not None:
            self._paused_ns = now_ns
        phase = Phase.PAUSED if self.is_paused else Phase.PLANNING
        self._set_status(phase, state=State.WAITING_FOR_ROBOT)

    def refuse_goal(self, goal: Goal, why: Outcome) -> None:
        """Count a goal that cannot be planned to (unknown frame), and stop."""
        self._replace_goal(goal)
        self._finish(why)

    def cancel(self) -> bool:
        """End the goal and stop; return whether there was one."""
        if self._goal is None:
            return False
        self._finish(Outcome.CANCELED)
        return True

    def pause(self, now_ns: int) -> None:
        """Keep goal and path while another source moves the robot.

        The time until :meth:`resume` does not count as lack of progress.
        """
        if self._paused_ns is None:
            self._paused_ns = now_ns
            if self._goal is not None:
                self._set_status(Phase.PAUSED)

    def resume(self, now_ns: int) -> None:
        """Continue to the goal; the next step plans from where the robot is."""
        if self._paused_ns is None:
            return
        span_ns = max(0, now_ns - self._paused_ns)
        self._paused_ns = None
        self._compared_ns += span_ns
        self._checker.skip(span_ns)
        if self._goal is not None:
            self._plan = self._progress = self._published = None
            self._set_status(Phase.PLANNING)

    @property
    def is_paused(self) -> bool:
        return self._paused_ns is not None

    def note_blocked(self) -> None:
        """Note that obstacles stop the controller; the next step plans from there."""
        self._blocked = True

    def note_jump(self) -> None:
        """Note that the robot's pose was corrected; the next step plans from there."""
        self._jumped = True

    def note_stalled(self, now_ns: int) -> None:
        """Avoid a place where something that no sensor detects stops the robot."""
        if self._progress is None or now_ns - self._blocked_ns < _BLOCKED_PERIOD_NS:
            return
        self._checker.spend()
        self._avoided.note_stuck(self._progress.ahead, self._front_m())
        if self._checker.exhausted:
            self._finish(Outcome.STUCK)
        else:
            self.avoid_place()
            self._blocked = True

    def take_path(self) -> Poses | None:
        """Return poses (N, 3) to publish, empty = stop; None if unchanged."""
        path, self._to_publish = self._to_publish, None
        return path

    @property
    def has_path(self) -> bool:
        """Whether a path is published and not finished."""
        return self._plan is not None

    def configure(self, params: PlannerParams) -> None:
        """Replace the parameters; the next step plans with them."""
        self.params = params
        self.planner = self.planner.with_params(params)
        self._checker.configure(params)
        self._plan = self._progress = None

    def note(self, robot: RobotMotion, now_ns: int) -> bool:
        """Update the robot's motion between steps; return whether it just arrived."""
        if self._goal is None or self._progress is None or self.is_paused:
            return False
        if self._progress.distance_to_end(robot.pose) < _NEAR_END_M:
            self._progress.update(robot.pose)
        if not self._arrived(robot, now_ns):
            return False
        self._finish(Phase.REACHED)
        return True

    def step(
        self,
        robot: RobotMotion | None,
        now_ns: int,
        *,
        stale: bool,
        unlocated: Outcome | Phase | None = None,
    ) -> None:
        """Look after the goal.

        Args:
            robot: newest state; None before the first.
            stale: whether that is too old to drive by.
            unlocated: why that is not the pose of the robot; None: it is.
        """
        if self._goal is None or self.is_paused:
            return
        if now_ns < self._stepped_ns:  # the clock was set back
            self._checker.begin(now_ns)
            self._compared_ns = now_ns
        self._stepped_ns = now_ns
        self.planner.map.hold(self._goal.x, self._goal.y)
        if unlocated is not None:
            self._drop_path()
            self._set_status(unlocated)
        elif robot is None or stale:
            self._drop_path()
            self._set_status(Phase.WAITING_FOR_ODOMETRY if robot is None
                      else Outcome.STALE_ODOMETRY)  # fmt: skip
        elif not self._has_map:
            self._set_status(Phase.WAITING_FOR_MAP)
        elif self._arrived(robot, now_ns):
            self._finish(Phase.REACHED)
        elif self._checker.goal_timed_out(now_ns):
            self._finish(Outcome.TIMED_OUT)
        elif self._plan is None or self._progress is None:
            self._replan(robot.pose, self._goal)
        else:
            self._monitor(self._plan, self._progress, robot, now_ns)

    def _monitor(
        self, plan: Plan, progress: PathProgress, robot: RobotMotion, now_ns: int
    ) -> None:
        assert self._goal is not None, "a path implies a goal"
        progress.update(robot.pose)
        here = robot.pose.x, robot.pose.y
        self._checker.note(progress.covered, here, now_ns)
        if progress.covered >= _SET_OUT_M:
            self._set_out, self._blocked_plans = True, 0
        changed, self._map_changed = self._map_changed, False
        blocked, self._blocked = self._blocked, False
        jumped, self._jumped = self._jumped, False
        if self._checker.no_progress(now_ns):
            if self._checker.exhausted:
                self._avoided.note_stuck(progress.ahead, self._front_m())
                never = self._blocked_plans > 0 and not self._set_out
                self._finish(Outcome.START_BLOCKED if never else Outcome.STUCK)
                return
            # The path may have been lost: publish it again even if unchanged.
            self._published = None
            self._replan(robot.pose, self._goal)
        elif blocked and now_ns - self._blocked_ns >= _BLOCKED_PERIOD_NS:
            self._blocked_ns = now_ns
            self._blocked_plans += 1
            self._replan(robot.pose, self._goal, exact_start=True)
        elif (
            jumped
            or progress.off_path_m > self.params.deviation_m
            or (
                changed
                and (
                    self._plans_freely(plan) or self._is_blocked(plan, progress, robot)
                )
            )
        ):
            self._replan(robot.pose, self._goal)
        elif now_ns - self._compared_ns >= _COMPARE_PERIOD_NS:
            self._compared_ns = now_ns
            self._switch_if_better(progress, robot.pose, self._goal)
        if self._plan is not None and self._progress is not None:
            left = self._progress.distance_left_m
            self._set_status(Phase.FOLLOWING, distance_left_m=left)

    def _plans_freely(self, plan: Plan) -> bool:
        """Return whether a new plan costs nothing.

        The robot has not started. A drive that cannot turn in place needs the search
        with headings for nearly every plan, a third of the CPU with every map.
        """
        searched = plan.expansions > 0 and not self.params.turns_in_place
        return not (self._set_out or searched or plan.cells > _MANY_CELLS)

    def _is_blocked(
        self, plan: Plan, progress: PathProgress, robot: RobotMotion
    ) -> bool:
        """Return whether the body does not fit along the rest of the path any more.

        If that is far ahead and plans take long, the next steps look again.
        """
        margin = _VALID_SHARE * plan.margin_m
        grid = self.planner.grid()
        bad = check_path(progress.ahead, grid, self.planner.body, margin).first_bad
        if bad is None or plan.cells <= _MANY_CELLS:
            return bad is not None
        away_m = lengths(progress.ahead[: bad + 1]).sum()
        is_far = away_m > max(_FAR_M, _FAR_S * abs(robot.speed_mps))
        since_ns = self._stepped_ns - self._planned_ns
        self._map_changed = is_far and 0 <= since_ns < _FAR_PERIOD_NS
        return not self._map_changed

    def _switch_if_better(
        self, progress: PathProgress, here: Pose2, goal: Goal
    ) -> None:
        """Replace a valid path only by one that is cheaper by the margin."""
        if not self.planner.map.take_cost_fall():
            return
        now_costs = self.planner.cost_of(progress.ahead)
        worth = (1 - self.params.switch_gain) * now_costs
        worth = min(worth, now_costs - _WORTH_SWITCHING_M)
        reach = math.dist((here.x, here.y), (goal.x, goal.y))
        if reach - self.params.goal_tolerance_m >= worth:
            return  # not even the straight line is cheaper by the margin
        if self.planner.least_cost(here, goal) >= worth:
            return  # nor is it through what is known
        other = self.planner.plan_on_grid(here, goal, below_m=worth)
        if other is not None and other.cost < worth:
            self._accept(other, here)

    def _replan(self, here: Pose2, goal: Goal, *, exact_start: bool = False) -> None:
        first = not self.report.plan
        more_m = self._more_margin_m() if exact_start else 0.0
        plan = self.planner.plan(
            here, goal, exact_start=exact_start, more_margin_m=more_m
        )
        if not plan.outcome.has_path and more_m > 0.0:  # what is in the way may move
            plan = self.planner.plan(here, goal, exact_start=exact_start)
        if not plan.outcome.has_path and self._avoided.clear():
            self._apply_map()  # no other path exists
            plan = self.planner.plan(here, goal, exact_start=exact_start)
        self.planner.map.take_cost_fall()
        self._map_changed = False
        self._planned_ns = self._stepped_ns
        if plan.outcome.has_path:
            self._accept(plan, here)
            return
        self._checker.spend()
        # A robot that has not started gets one more attempt only.
        failed = plan.outcome is Outcome.METHOD_FAILED
        final = first or failed or (not self._set_out and self._checker.spent > 1)
        if final or self._checker.exhausted:
            self._finish(plan.outcome, plan.fault)
            return
        # The map may improve: retry until the attempts are exhausted.
        self._drop_path()
        self._set_status(Phase.PLANNING, plan=plan.outcome.value)

    def _more_margin_m(self) -> float:
        """Return the clearance that this plan keeps in addition to the tight one."""
        times, rest = divmod(self._blocked_plans, _BLOCKED_PLANS)
        return 0.0 if rest else min(times * _MORE_MARGIN_M, _MOST_MORE_M)

    def _accept(self, plan: Plan, here: Pose2) -> None:
        before = None if self._progress is None else self._progress.poses
        new = before is None or not np.array_equal(plan.poses, before)
        replans = self.report.replans + int(new) if self.report.plan else 0
        self._plan, self._progress = plan, PathProgress(plan.poses)
        # Where a path passes its start again, the robot is matched farther along it
        # at once, which does not count as progress.
        self._progress.update(here)
        self._checker.new_path(self._progress.covered)
        self._publish(plan.poses)
        self._set_status(
            Phase.FOLLOWING,
            plan=plan.outcome.value,
            margin_m=plan.margin_m,
            replans=replans,
            distance_left_m=self._progress.distance_left_m,
        )

    def _arrived(self, robot: RobotMotion, now_ns: int) -> bool:
        """Return whether the robot is at the path's end, or at rest near the goal."""
        assert self._goal is not None, "called with a goal only"
        at_rest = self._checker.rests(robot, now_ns)
        goal, progress = self._goal, self._progress
        if not self._heading_reached(goal, robot.pose):
            return False
        off = math.dist((robot.pose.x, robot.pose.y), (goal.x, goal.y))
        if at_rest and off <= self.params.goal_tolerance_m:
            return True
        near = self.params.path_end_tolerance_m
        return (
            progress is not None
            and progress.distance_left_m <= 2 * near
            and progress.distance_to_end(robot.pose) <= (2 * near if at_rest else near)
        )

    def _heading_reached(self, goal: Goal, pose: Pose2) -> bool:
        if goal.yaw is None:
            return True
        error = abs(angle_difference(goal.yaw, pose.yaw))
        return error <= self.params.goal_yaw_tolerance_rad

    def _front_m(self) -> float:
        """Return the distance of the body's farthest corner."""
        corners = np.array(self.params.footprint_m).reshape(-1, 2)
        return float(np.hypot(*corners.T).max())

    def _replace_goal(self, goal: Goal) -> None:
        if self.has_path:
            self._drop_path()
        self.report = self.report.followed_by(goal.x, goal.y)

    def fail(self, why: Outcome) -> None:
        """End the goal, if there is one, and stop."""
        if self._goal is not None:
            self._finish(why)

    def _finish(self, how: Outcome | Phase, fault: str = "") -> None:
        """End the goal, reached or failed, and stop the robot."""
        self._goal = None
        if how is Phase.REACHED and self._avoided.clear():
            self._apply_map()
        if how is not Phase.REACHED:
            self._published = None  # a failure publishes an empty path in any case
        self._drop_path()
        state = State.WAITING_FOR_GOAL
        self._set_status(how, state=state, result=how.value, fault=fault)

    def _drop_path(self) -> None:
        self._plan = self._progress = None
        self._publish(_STOP)

    def _publish(self, poses: Poses) -> None:
        before = self._published
        if before is None or not np.array_equal(poses, before):
            self._to_publish = self._published = poses

    def _set_status(self, message: Phase | Outcome, **details: Any) -> None:
        self.report = replace(self.report, message=message.value, **details)
