"""The tree of frames over time: who is whose parent, and chains between frames.

Lookup walks from both frames to the root, at one time, and cuts the paths where
they meet (the method of tf2's BufferCore; T. Foote, "tf: The transform library", 2013).
"""

from navette.geometry import Transform3
from navette.runtime.tf.exceptions import (
    ConnectivityException,
    InvalidArgumentException,
    LookupException,
)
from navette.runtime.tf.frame_history import FrameHistory

_MAX_DEPTH = 1000
_NORM_TOLERANCE = 1e-3


class BufferCore:
    """Transforms by frame names and integer nanoseconds; knows no messages.

    Args:
        cache_ns: how far back the samples of moving frames are kept.
    """

    def __init__(self, cache_ns: int) -> None:
        self.cache_ns = cache_ns
        self._frames: dict[str, FrameHistory] = {}
        self._parents: set[str] = set()

    def set(
        self,
        parent: str,
        child: str,
        stamp_ns: int,
        parent_T_child: Transform3,
        *,
        is_static: bool,
    ) -> None:
        """Take a sample over.

        Raises:
            InvalidArgumentException: names or numbers that make no transform.
        """
        parent, child = frame_name(parent), frame_name(child)
        if parent == child:
            raise InvalidArgumentException(f"frame {child!r} cannot be its own parent")
        history = self._frames.get(child)
        if history is None or history.is_static != is_static:
            history = FrameHistory(child, self.cache_ns, is_static=is_static)
            self._frames[child] = history
        history.insert(stamp_ns, _checked(parent_T_child, child), parent)
        self._parents.add(parent)

    def lookup(self, target: str, source: str, stamp_ns: int) -> tuple[Transform3, int]:
        """target_T_source and its stamp; ``stamp_ns`` 0 = the newest common time.

        Raises:
            LookupException, ConnectivityException, ExtrapolationException
        """
        target, source = frame_name(target), frame_name(source)
        self._check_known(target, source)
        if target == source:
            return Transform3.identity(), stamp_ns
        if stamp_ns == 0:
            stamp_ns = self.newest_common_ns(target, source)
        return self._chain(target, source, stamp_ns), stamp_ns

    def newest_common_ns(self, target: str, source: str) -> int:
        """The newest time at which every moving frame between the two has a sample."""
        target, source = frame_name(target), frame_name(source)
        self._check_known(target, source)
        up_target = self._ancestors(target)
        up_source = self._ancestors(source)
        common = next((frame for frame in up_source if frame in up_target), None)
        if common is None:
            raise self._not_connected(target, source)
        stamps = [
            history.newest_ns
            for path in (up_target, up_source)
            for frame in path[: path.index(common)]
            if not (history := self._frames[frame]).is_static
        ]
        return min(stamps, default=0)

    def frames(self) -> list[str]:
        """All known frames, parents included, sorted."""
        return sorted(self._parents | self._frames.keys())

    def histories(self) -> dict[str, FrameHistory]:
        """child → its samples."""
        return self._frames

    def knows(self, frame: str) -> bool:
        return frame in self._frames or frame in self._parents

    def clear(self) -> None:
        self._frames.clear()
        self._parents.clear()

    def drop_moving(self) -> None:
        """Forget what is not static (after a jump back in time)."""
        self._frames = {n: h for n, h in self._frames.items() if h.is_static}

    def _chain(self, target: str, source: str, stamp_ns: int) -> Transform3:
        # root_T_source for every frame on the way up from the source, then the same
        # from the target until the two ways meet.
        up: dict[str, Transform3] = {source: Transform3.identity()}
        frame, upper_T_source = source, up[source]
        failure: Exception | None = None
        for _ in range(_MAX_DEPTH):
            history = self._frames.get(frame)
            if history is None or frame == target:
                break
            try:
                upper_T_frame, frame = history.at(stamp_ns)
            except Exception as error:
                failure = error
                break
            upper_T_source = upper_T_frame @ upper_T_source
            up[frame] = upper_T_source
        frame, upper_T_target = target, Transform3.identity()
        for _ in range(_MAX_DEPTH):
            if frame in up:
                return upper_T_target.inverse() @ up[frame]
            history = self._frames.get(frame)
            if history is None:
                break
            upper_T_frame, frame = history.at(stamp_ns)
            upper_T_target = upper_T_frame @ upper_T_target
        raise failure or self._not_connected(target, source)

    def _ancestors(self, frame: str) -> list[str]:
        """The frame, its parent and so on, as they are now."""
        path = [frame]
        for _ in range(_MAX_DEPTH):
            history = self._frames.get(path[-1])
            if history is None:
                return path
            path.append(history.parent)
        raise InvalidArgumentException(
            f"frames run in a circle: {' → '.join(path[:5])} …"
        )

    def _check_known(self, *frames: str) -> None:
        for frame in frames:
            if not self.knows(frame):
                raise LookupException(
                    f"frame {frame!r} does not exist; "
                    f"known: {', '.join(self.frames()) or 'none'}"
                )

    def _not_connected(self, target: str, source: str) -> ConnectivityException:
        return ConnectivityException(
            f"{target!r} and {source!r} are not in the same tree "
            f"(roots {self._ancestors(target)[-1]!r} "
            f"and {self._ancestors(source)[-1]!r})"
        )


def frame_name(name: str) -> str:
    """Without a leading slash (tf1 habit).

    Raises:
        InvalidArgumentException: empty.
    """
    if not isinstance(name, str) or not name.strip("/"):
        raise InvalidArgumentException(f"frame name {name!r}: must not be empty")
    return name.removeprefix("/")


def _checked(transform: Transform3, child: str) -> Transform3:
    """Finite, with a unit quaternion (normalised within tf2's tolerance)."""
    x, y, z, w = transform.rotation
    tx, ty, tz = transform.translation
    norm = (x * x + y * y + z * z + w * w) ** 0.5
    total = tx + ty + tz + norm
    if total - total != 0.0:  # inf or nan
        raise InvalidArgumentException(
            f"transform of {child!r} is not finite: {transform}"
        )
    if abs(norm - 1.0) > _NORM_TOLERANCE:
        raise InvalidArgumentException(
            f"transform of {child!r}: quaternion {transform.rotation} has norm "
            f"{norm:.4f}, wanted 1"
        )
    return Transform3((tx, ty, tz), (x / norm, y / norm, z / norm, w / norm))
