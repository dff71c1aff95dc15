"""Read single keys from a terminal in a thread, and restore the terminal afterwards.

POSIX only; elsewhere, or if standard input is not a terminal, there are no keys.
"""

import importlib.util
import os
import select
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

_NAMES = {
    "A": "up",
    "B": "down",
    "C": "right",
    "D": "left",
}
# The rest of an escape sequence follows at once; a lone escape is the Escape key.
_ESCAPE_S = 0.05


@contextmanager
def listening_to_keys(on_key: Callable[[str], object]) -> Iterator[bool]:
    """Call ``on_key`` from a thread for each key until the block ends.

    A key is its character, or ``up``, ``down``, ``left``, ``right``, ``escape``.
    Ctrl-C and Ctrl-Z keep their function. Yields whether keys can be read.
    """
    descriptor = _terminal()
    if descriptor is None:
        yield False
        return
    import termios
    import tty

    before = termios.tcgetattr(descriptor)
    done, wake = os.pipe()
    thread = threading.Thread(
        target=_listen, args=(descriptor, done, on_key), name="keys", daemon=True
    )
    try:
        tty.setcbreak(descriptor)
        thread.start()
        yield True
    finally:
        with suppress(termios.error):  # the terminal was closed
            termios.tcsetattr(descriptor, termios.TCSADRAIN, before)
        os.write(wake, b".")
        if thread.ident is not None:
            thread.join()
        os.close(done)
        os.close(wake)


def _terminal() -> int | None:
    """Return standard input if it is a terminal and this is the foreground job."""
    if importlib.util.find_spec("termios") is None:  # not on Windows
        return None
    try:
        descriptor = sys.stdin.fileno()
        if os.isatty(descriptor) and os.tcgetpgrp(descriptor) == os.getpgrp():
            return descriptor
    except (OSError, ValueError):  # closed, or not a file
        return None
    return None


def _listen(descriptor: int, done: int, on_key: Callable[[str], object]) -> None:
    while True:
        ready, _, _ = select.select([descriptor, done], [], [])
        if done in ready:
            return
        try:
            data = os.read(descriptor, 64)
        except OSError:  # the terminal was closed
            return
        if not data:
            return
        if data.endswith((b"\x1b", b"\x1b[", b"\x1bO")):
            more, _, _ = select.select([descriptor], [], [], _ESCAPE_S)
            data += os.read(descriptor, 64) if more else b""
        for key in split_keys(data.decode("utf-8", "replace")):
            on_key(key)


def split_keys(text: str) -> list[str]:
    """Split terminal input into characters and key names."""
    keys = []
    rest = text
    while rest:
        if rest[:2] in ("\x1b[", "\x1bO") and len(rest) > 2:
            length = _sequence_length(rest)
            name = _NAMES.get(rest[length - 1])
            keys += [name] if name else []
            rest = rest[length:]
        else:
            keys.append("escape" if rest[0] == "\x1b" else rest[0])
            rest = rest[1:]
    return keys


def _sequence_length(text: str) -> int:
    """Return the length of the leading control sequence: it ends with a-z, A-Z or ~."""
    for index in range(2, len(text)):
        if text[index].isalpha() or text[index] == "~":
            return index + 1
    return len(text)
