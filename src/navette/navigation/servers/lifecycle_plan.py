"""Which transition brings a managed node closer to a state."""

from navette.errors import InvalidValueError
from navette.msgs.lifecycle_msgs.msg import Transition
from navette.msgs.nav2_msgs.srv import ManageLifecycleNodes

_T = Transition
_UP = {"unconfigured": _T.TRANSITION_CONFIGURE, "finalized": _T.TRANSITION_CONFIGURE}
_DOWN = {"active": _T.TRANSITION_DEACTIVATE}

# State to reach, and the transition from each other state.
_STEPS = {
    "active": _UP | {"inactive": _T.TRANSITION_ACTIVATE},
    "inactive": _UP | _DOWN,
    "unconfigured": _DOWN | {"inactive": _T.TRANSITION_CLEANUP},
    "not active": _DOWN,
    "finalized": _DOWN
    | {
        "inactive": _T.TRANSITION_INACTIVE_SHUTDOWN,
        "unconfigured": _T.TRANSITION_UNCONFIGURED_SHUTDOWN,
    },
}

_Command = ManageLifecycleNodes.Request
_PAUSED = "not active"
_GOALS = {
    _Command.STARTUP: "active",
    _Command.PAUSE: _PAUSED,
    _Command.RESUME: "active",
    _Command.RESET: "unconfigured",
    _Command.SHUTDOWN: "finalized",
}
if hasattr(_Command, "CONFIGURE"):  # since Jazzy
    _GOALS |= {_Command.CONFIGURE: "inactive", _Command.CLEANUP: "unconfigured"}


def state_of_command(command: int) -> str:
    """Return the state that a command of ``ManageLifecycleNodes`` leads to.

    Raises:
        InvalidValueError: unknown command.
    """
    if command not in _GOALS:
        known = ", ".join(f"{number} ({state})" for number, state in _GOALS.items())
        raise InvalidValueError(f"command {command}: unknown; known: {known}")
    return _GOALS[command]


def next_transition(state: str, goal: str) -> int | None:
    """Return the id of the next transition towards a state; None if it is reached.

    Raises:
        InvalidValueError: no transition leads there, such as from a transition state.
    """
    if state == goal or (goal == _PAUSED and state in _STEPS and state != "active"):
        return None
    step = _STEPS[goal].get(state)
    if step is None:
        raise InvalidValueError(f"no transition from {state} to {goal}")
    return step
