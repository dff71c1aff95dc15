"""Options of a simulation run."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from navette.errors import InvalidValueError
from navette.geometry import Pose2


@dataclass(frozen=True, kw_only=True)
class RunOptions:
    """Options of one run of the simulated robot.

    ``world`` and ``robot`` are built-in names or files. ``sensors`` are mounted on the
    robot: ``TYPE`` or ``TYPE@PLACE`` (:mod:`navette.sim.sensor_catalogue`).
    ``speed`` is a factor of real time; infinity means as fast as possible.
    ``record`` is a new file; ``overwrite``
    replaces an existing recording. ``methods`` chooses the stages' methods: the keys of
    :data:`navette.navigation.stack.methods.METHOD_PARAMETERS` → name or place;
    ``replacements`` are nodes of the stack → the user's class of nodes;
    ``parameters`` are node → name → value, over those of all files. ``verb``
    is the command that starts the run. With ``share``, the run joins the network that
    all programs share; otherwise only this user's programs can join it.
    """

    world: str = "arena"
    robot: str | None = None
    sensors: tuple[str, ...] = ()
    start: Pose2 | None = None
    goals: tuple[tuple[float, float], ...] = ()
    headless: bool = False
    speed: float = 1.0
    seed: int = 0
    record: Path | None = None
    record_images: bool = False
    overwrite: bool = False
    tree: Path | None = None
    known_map: Path | None = None
    keepout: Path | None = None
    speed_zones: Path | None = None
    params_files: tuple[Path, ...] = field(default=())
    methods: Mapping[str, str] = field(default_factory=dict)
    replacements: Mapping[str, str] = field(default_factory=dict)
    parameters: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    max_time_s: float | None = None
    port: int = 8765
    host: str = "127.0.0.1"
    unencrypted: bool = False
    origins: tuple[str, ...] = ()
    share: bool = False
    verb: str = "sim"

    def __post_init__(self) -> None:
        if not self.speed > 0:
            raise InvalidValueError(f"speed {self.speed!r}: expected above 0, or max")
        if self.seed < 0:
            raise InvalidValueError(f"seed {self.seed!r}: expected 0 or more")
        if self.max_time_s is not None and not 0 < self.max_time_s < math.inf:
            raise InvalidValueError(
                f"max time {self.max_time_s!r}: must be more than 0 seconds, finite"
            )
        if self.start is not None and not all(map(math.isfinite, self.start)):
            raise InvalidValueError(
                f"start {tuple(self.start)}: expected finite numbers"
            )

    @property
    def ends_with_goals(self) -> bool:
        """Whether the run ends with its last goal."""
        return self.headless and bool(self.goals)
