"""Loggers of the output of processes, and where the output of each stream goes."""

import logging
from typing import Any

from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.logging.config import LOG_FILE, launch_config
from navette.ros2.packages.launch.logging.console import get_logger
from navette.ros2.packages.launch.logging.formats import LaunchFormatter

STREAMS = ("stdout", "stderr")
_PLACES = ("screen", "log", "own_log")
_MODES: dict[str, dict[str, set[str]]] = {
    "screen": {"stdout": {"screen"}, "stderr": {"screen"}},
    "log": {"stdout": {"log"}, "stderr": {"log", "screen"}},
    "both": {"both": {"log", "screen"}},
    "own_log": {
        "both": {"own_log"},
        "stdout": {"own_log"},
        "stderr": {"own_log"},
    },
    "full": {
        "both": {"log", "own_log", "screen"},
        "stdout": {"own_log"},
        "stderr": {"own_log"},
    },
}


def output_places(value: Any) -> dict[str, set[str]]:
    """Return the places of the output of ``stdout``, ``stderr`` and ``both`` streams.

    Args:
        value: a mode, or a dict of streams whose values are modes or places:
            ``screen``, ``log`` (the log file of the launch), ``own_log`` (a file of the
            process).

    Raises:
        InvalidLaunchValueError: an unknown mode, stream or place; lists the known ones.
    """
    places: dict[str, set[str]] = {stream: set() for stream in (*STREAMS, "both")}
    if not isinstance(value, dict):
        if not isinstance(value, str) or value not in _MODES:
            raise InvalidLaunchValueError(
                f"output {value!r}; expected {', '.join(_MODES)}, or a dict of streams"
            )
        return places | _MODES[value]
    for stream, words in value.items():
        if stream not in places:
            raise InvalidLaunchValueError(
                f"output: stream {stream!r}; expected stdout, stderr or both"
            )
        for word in [words] if isinstance(words, str) else words:
            if word in _PLACES:
                places[stream].add(word)
                continue
            mode = output_places(word)
            chosen = STREAMS if stream == "both" else (stream,)
            places[stream] |= mode["both"].union(*(mode[each] for each in chosen))
    return places


def places_of_stream(places: dict[str, set[str]], stream: str) -> set[str]:
    """Return the places of one stream's output."""
    return places[stream] | places["both"]


def get_output_loggers(
    process_name: str, output_config: Any, main_log_file_name: str = LOG_FILE
) -> tuple[logging.Logger, logging.Logger]:
    """Return the loggers of a process's standard output and standard error.

    Args:
        output_config: see :func:`output_places`.
    """
    places = output_places(output_config)
    loggers = []
    for stream in STREAMS:
        logger = get_logger(f"{process_name}-{stream}")
        logger.setLevel(logging.DEBUG)
        logger.propagate = False
        for handler in tuple(logger.handlers):
            logger.removeHandler(handler)
        chosen = places_of_stream(places, stream)
        if "screen" in chosen:
            _add(logger, launch_config.get_screen_handler(), "{msg}")
        if "log" in chosen:
            main = launch_config.get_log_file_handler(main_log_file_name)
            _add(logger, main, "{created:.7f} {msg}")
        for key, file in (
            (stream, f"{process_name}-{stream}.log"),
            ("both", f"{process_name}.log"),
        ):
            if "own_log" in places[key]:
                _add(logger, launch_config.get_log_file_handler(file), "{msg}")
        loggers.append(logger)
    return loggers[0], loggers[1]


def _add(logger: logging.Logger, handler: Any, text: str) -> None:
    handler.setFormatterFor(logger, LaunchFormatter(text, style="{", validate=False))
    logger.addHandler(handler)
