"""The tree of frames over time: who is whose parent, and chains between frames.

Lookup walks from both frames to the root, at one time, and cuts the paths where
they meet (the method of tf2's BufferCore; T. Foote, "tf: The transform library", 2013).
"""

from navette.geometry import Transform3
from navette.runtime.tf.exceptions import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
)
from navette.runtime.tf.frame_history import FrameHistory

_MAX_DEPTH = 1000
_NORM_TOLERANCE = 1e-3


class _Way:
    """The frames from target and from source up to where they meet (excluded)."""

    __slots__ = ("_from_source", "_from_target")

    def __init__(
        self, from_target: list[FrameHistory], from_source: list[FrameHistory]
    ) -> None:
        self._from_target = [(h, h.parent) for h in from_target]
        self._from_source = [(h, h.parent) for h in from_source]

    def newest_common_ns(self) -> int:
        """The newest time that all moving frames reach; 0 if none moves."""
        return min(
            (
                history.newest_ns
                for history, _ in (*self._from_target, *self._from_source)
                if not history.is_static
            ),
            default=0,
        )

    def at(self, stamp_ns: int) -> Transform3 | None:
        """target_T_source; None if a frame had another parent at that time."""
        common_T_source = _joined(self._from_source, stamp_ns)
        common_T_target = _joined(self._from_target, stamp_ns)
        if common_T_source is None or common_T_target is None:
            return None
        if not self._from_target:
            return common_T_source
        target_T_common = common_T_target.inverse()
        return (
            target_T_common @ common_T_source if self._from_source else target_T_common
        )


def _joined(path: list[tuple[FrameHistory, str]], stamp_ns: int) -> Transform3 | None:
    """top_T_bottom along a path that starts at the bottom."""
    top_T_bottom: Transform3 | None = None
    for history, expected_parent in path:
        parent_T_child, parent = history.at(stamp_ns)
        if parent != expected_parent:
            return None
        top_T_bottom = (
            parent_T_child if top_T_bottom is None else parent_T_child @ top_T_bottom
        )
    return Transform3.identity() if top_T_bottom is None else top_T_bottom


class BufferCore:
    """Transforms by frame names and integer nanoseconds; knows no messages.

    Args:
        cache_ns: how far back the samples of moving frames are kept.
    """

    def __init__(self, cache_ns: int) -> None:
        self.cache_ns = cache_ns
        self._frames: dict[str, FrameHistory] = {}
        self._parents: set[str] = set()
        self._ways: dict[tuple[str, str], _Way] = {}

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
        parent_T_child = _checked(parent_T_child, child)  # before it leaves a trace
        history = self._frames.get(child)
        if history is None or history.is_static != is_static:
            history = FrameHistory(child, self.cache_ns, is_static=is_static)
            self._frames[child] = history
            self._ways.clear()
        elif history.parent != parent:
            self._ways.clear()
        history.insert(stamp_ns, parent_T_child, parent)
        self._parents.add(parent)

    def lookup(self, target: str, source: str, stamp_ns: int) -> tuple[Transform3, int]:
        """target_T_source and its stamp; ``stamp_ns`` 0 = the newest common time.

        Raises:
            LookupException, ConnectivityException, ExtrapolationException
        """
        target, source = frame_name(target), frame_name(source)
        if target == source:
            self._check_known(target)
            return Transform3.identity(), stamp_ns
        way = self._way(target, source)
        if stamp_ns == 0:
            stamp_ns = way.newest_common_ns()
        target_T_source = way.at(stamp_ns)
        if target_T_source is None:
            target_T_source = self._chain(target, source, stamp_ns)
        return target_T_source, stamp_ns

    def newest_common_ns(self, target: str, source: str) -> int:
        """The newest time at which every moving frame between the two has a sample."""
        target, source = frame_name(target), frame_name(source)
        self._check_known(target, source)
        return 0 if target == source else self._way(target, source).newest_common_ns()

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
        self._ways.clear()

    def drop_moving(self) -> None:
        """Forget what is not static (after a jump back in time)."""
        self._frames = {n: h for n, h in self._frames.items() if h.is_static}
        self._ways.clear()

    def _way(self, target: str, source: str) -> "_Way":
        """The chain between two frames as the tree is now; kept until it changes."""
        way = self._ways.get((target, source))
        if way is None:
            self._check_known(target, source)
            up_target, up_source = self._ancestors(target), self._ancestors(source)
            common = next((frame for frame in up_source if frame in up_target), None)
            if common is None:
                raise self._not_connected(target, source)
            way = self._ways[target, source] = _Way(
                [self._frames[f] for f in up_target[: up_target.index(common)]],
                [self._frames[f] for f in up_source[: up_source.index(common)]],
            )
        return way

    def _chain(self, target: str, source: str, stamp_ns: int) -> Transform3:
        """target_T_source where parents were others at that time than they are now."""
        up_target, top_of_target = self._up(target, stamp_ns)
        up_source, top_of_source = self._up(source, stamp_ns)
        for frame, common_T_source in up_source.items():
            if frame in up_target:
                return up_target[frame].inverse() @ common_T_source
        raise top_of_source or top_of_target or self._not_connected(target, source)

    def _up(
        self, frame: str, stamp_ns: int
    ) -> tuple[dict[str, Transform3], ExtrapolationException | None]:
        """ancestor_T_frame of all ancestors, and what kept it from going higher."""
        upper_T_frame = Transform3.identity()
        found = {frame: upper_T_frame}
        while (history := self._frames.get(frame)) and len(found) < _MAX_DEPTH:
            try:
                upper_T_lower, frame = history.at(stamp_ns)
            except ExtrapolationException as error:
                return found, error  # what lies above may not be needed
            upper_T_frame = upper_T_lower @ upper_T_frame
            found[frame] = upper_T_frame
        return found, None

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
