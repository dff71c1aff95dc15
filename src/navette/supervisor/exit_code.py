"""Exit codes in words."""

import signal


def describe_exit(code: int) -> str:
    """Describe an exit code: "ended", "exit code 3", "killed by SIGSEGV".

    A negative code is a signal number. Shells report a signal as 128 + its number.
    """
    if code == 0:
        return "ended"
    number = -code if code < 0 else code - 128 if code > 128 else 0
    if number:
        try:
            name = signal.Signals(number).name
        except ValueError:
            return f"exit code {code}"
        return f"killed by {name}" if code < 0 else f"exit code {code} ({name})"
    return f"exit code {code}"
