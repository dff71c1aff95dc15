"""Services that pause, step, reset and pace a simulation.

The types are those of simulation_interfaces, which Gazebo, Isaac Sim and others serve
too; the rate is that of rosbag2's player. Time that does not advance is not measured:
the run computes the same as without a pause.
"""

import math
from collections.abc import Callable, Mapping
from typing import Any, Protocol

from navette.msgs.rosbag2_interfaces.srv import GetRate, SetRate
from navette.msgs.simulation_interfaces.msg import Result, SimulationState
from navette.msgs.simulation_interfaces.srv import (
    GetSimulationState,
    ResetSimulation,
    SetSimulationState,
    StepSimulation,
)

_MOST_STEPS_NS = 60 * 10**9  # of one request: the program does nothing else meanwhile
_RATES = (0.01, 100.0)


class PausableClock(Protocol):
    """Virtual time that can be stopped."""

    paused: bool

    def step(self, duration_ns: int) -> None: ...


class Pace(Protocol):
    """Virtual time that follows the wall clock; ``factor``: virtual by wall time."""

    factor: float


ResetWorld = Callable[[], None]
"""Puts robot and world back to their start."""


class RunControl:
    """Serves the run of a simulation.

    Args:
        clock: None if its time cannot be stopped.
        pace: None if it is not paced.
        step_ns: duration of a step.
    """

    def __init__(
        self,
        clock: PausableClock | None,
        pace: Pace | None,
        step_ns: int,
        *,
        reset: ResetWorld,
    ) -> None:
        self._clock, self._pace = clock, pace
        self._step_ns, self._reset = step_ns, reset

    @property
    def services(self) -> Mapping[str, tuple[type, Callable[[Any, Any], Any]]]:
        """Name below the node's name → type and callback."""
        return {
            "get_simulation_state": (GetSimulationState, self._get_state),
            "set_simulation_state": (SetSimulationState, self._set_state),
            "step_simulation": (StepSimulation, self._step),
            "reset_simulation": (ResetSimulation, self._on_reset),
            "get_rate": (GetRate, self._get_rate),
            "set_rate": (SetRate, self._set_rate),
        }

    def _get_state(self, request: Any, response: Any) -> Any:
        paused = self._clock is not None and self._clock.paused
        playing = SimulationState.STATE_PLAYING
        response.state.state = SimulationState.STATE_PAUSED if paused else playing
        response.result = _ok()
        return response

    def _set_state(self, request: Any, response: Any) -> Any:
        response.result = self._change(request.state.state)
        return response

    def _change(self, state: int) -> Result:
        if self._clock is None:
            return _lockstep()
        if state == SimulationState.STATE_STOPPED:
            self._reset()
        elif state not in (SimulationState.STATE_PLAYING, SimulationState.STATE_PAUSED):
            return _failed(
                Result.RESULT_FEATURE_UNSUPPORTED,
                f"state {state}: known are 0 (stopped), 1 (playing) and 2 (paused)",
            )
        paused = state != SimulationState.STATE_PLAYING
        if paused == self._clock.paused and state != SimulationState.STATE_STOPPED:
            text = "paused" if paused else "playing"
            already = SetSimulationState.Response.ALREADY_IN_TARGET_STATE
            return _failed(already, f"the simulation is {text} already")
        self._clock.paused = paused
        return _ok()

    def _step(self, request: Any, response: Any) -> Any:
        response.result = self._advance(request.steps)
        return response

    def _advance(self, steps: int) -> Result:
        most = _MOST_STEPS_NS // self._step_ns
        if self._clock is None:
            return _lockstep()
        if not self._clock.paused:
            return _failed(
                Result.RESULT_INCORRECT_STATE,
                "only a paused simulation can be stepped: set the state to 2 (paused)",
            )
        if not 1 <= steps <= most:
            return _failed(
                Result.RESULT_OPERATION_FAILED,
                f"{steps} steps: expected 1 to {most} of {self._step_ns / 1e6:g} ms",
            )
        self._clock.step(steps * self._step_ns)
        return _ok()

    def _on_reset(self, request: Any, response: Any) -> Any:
        """Reset robot and world; the clock continues, since nodes depend on it."""
        if request.scope & ResetSimulation.Request.SCOPE_TIME:
            response.result = _failed(
                Result.RESULT_FEATURE_UNSUPPORTED,
                "time cannot be reset: use scope 2 (state), or start the run again",
            )
            return response
        self._reset()
        response.result = _ok()
        return response

    def _get_rate(self, request: Any, response: Any) -> Any:
        response.rate = math.inf if self._pace is None else self._pace.factor
        return response

    def _set_rate(self, request: Any, response: Any) -> Any:
        """Set the rate of a run that was started with one; others run without limit."""
        low, high = _RATES
        response.success = False
        if self._pace is not None and low <= request.rate <= high:
            self._pace.factor = request.rate
            response.success = True
        return response


def _ok() -> Result:
    return Result(result=Result.RESULT_OK)


def _failed(result: int, message: str) -> Result:
    return Result(result=result, error_message=message)


def _lockstep() -> Result:
    return _failed(
        Result.RESULT_FEATURE_UNSUPPORTED,
        "other processes share the time (--lockstep): it cannot be paused here",
    )
