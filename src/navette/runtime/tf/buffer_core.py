"""Tree of frames over time and the chains of transforms between frames.

A lookup follows the parents of both frames to their common ancestor (the method of
tf2's BufferCore; T. Foote, "tf: The transform library", 2013).
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


class _Chain:
    """Frames from target and from source to the common ancestor (excluded)."""

    def __init__(
        self, from_target: list[FrameHistory], from_source: list[FrameHistory]
    ) -> None:
        self._from_target = [(h, h.parent) for h in from_target]
        self._from_source = [(h, h.parent) for h in from_source]

    def newest_common_ns(self) -> int:
        """Return the newest time at which all moving frames have a sample, or 0."""
        return min(
            (
                history.newest_ns
                for history, _ in (*self._from_target, *self._from_source)
                if not history.is_static
            ),
            default=0,
        )

    def at(self, stamp_ns: int) -> Transform3 | None:
        """Return target_T_source; None if a frame had another parent at that time."""
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
    """Return top_T_bottom along a path that starts at the bottom."""
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
    """Buffer of transforms by frame names and integer nanoseconds, without messages.

    Args:
        cache_ns: how long samples of moving frames are kept.
    """

    def __init__(self, cache_ns: int) -> None:
        self.cache_ns = cache_ns
        self._frames: dict[str, FrameHistory] = {}
        self._parents: set[str] = set()
        self._chains: dict[tuple[str, str], _Chain] = {}
        # Lookups of the newest time since the last sample. Replaced, not cleared: a
        # lookup of another thread must not store its result after the change.
        self._newest: dict[tuple[str, str], tuple[Transform3, int]] = {}

    def set(
        self,
        parent: str,
        child: str,
        stamp_ns: int,
        parent_T_child: Transform3,
        *,
        is_static: bool,
    ) -> None:
        """Add a sample.

        Raises:
            InvalidArgumentException: a frame name or a number is invalid.
        """
        parent, child = frame_name(parent), frame_name(child)
        if parent == child:
            raise InvalidArgumentException(f"frame {child!r} cannot be its own parent")
        parent_T_child = _checked(parent_T_child, child)  # before any change
        history = self._frames.get(child)
        if history is None or history.is_static != is_static:
            history = FrameHistory(child, self.cache_ns, is_static=is_static)
            self._frames[child] = history
            self._chains.clear()
        elif history.parent != parent:
            self._chains.clear()
        history.insert(stamp_ns, parent_T_child, parent)
        self._parents.add(parent)
        self._newest = {}

    def lookup(self, target: str, source: str, stamp_ns: int) -> tuple[Transform3, int]:
        """Return target_T_source and its stamp; 0 stands for the newest common time.

        Raises:
            LookupException: a frame is unknown.
            ConnectivityException: the frames are not connected.
            ExtrapolationException: no data at the time.
        """
        if stamp_ns != 0:
            return self._found(target, source, stamp_ns)
        newest = self._newest
        found = newest.get((target, source))
        if found is None:
            found = newest[target, source] = self._found(target, source, 0)
        return found

    def _found(self, target: str, source: str, stamp_ns: int) -> tuple[Transform3, int]:
        target, source = frame_name(target), frame_name(source)
        if target == source:
            self._check_known(target)
            return Transform3.identity(), stamp_ns
        chain = self._chain(target, source)
        if stamp_ns == 0:
            stamp_ns = chain.newest_common_ns()
        target_T_source = chain.at(stamp_ns)
        if target_T_source is None:
            target_T_source = self._former_chain(target, source, stamp_ns)
        return target_T_source, stamp_ns

    def newest_common_ns(self, target: str, source: str) -> int:
        """Return the newest time at which all moving frames in between have samples."""
        target, source = frame_name(target), frame_name(source)
        self._check_known(target, source)
        return 0 if target == source else self._chain(target, source).newest_common_ns()

    def frames(self) -> list[str]:
        """Return all known frames, parents included, sorted."""
        return sorted(self._parents | self._frames.keys())

    def histories(self) -> dict[str, FrameHistory]:
        return self._frames

    def contains(self, frame: str) -> bool:
        return frame in self._frames or frame in self._parents

    def drop_moving(self) -> None:
        """Delete all moving frames, after a jump backward in time."""
        self._frames = {n: h for n, h in self._frames.items() if h.is_static}
        self._chains.clear()
        self._newest = {}

    def _chain(self, target: str, source: str) -> _Chain:
        chain = self._chains.get((target, source))
        if chain is None:
            self._check_known(target, source)
            up_target, up_source = self._ancestors(target), self._ancestors(source)
            common = next((frame for frame in up_source if frame in up_target), None)
            if common is None:
                raise self._not_connected(target, source)
            chain = self._chains[target, source] = _Chain(
                [self._frames[f] for f in up_target[: up_target.index(common)]],
                [self._frames[f] for f in up_source[: up_source.index(common)]],
            )
        return chain

    def _former_chain(self, target: str, source: str, stamp_ns: int) -> Transform3:
        """Return target_T_source at a time at which the tree was different."""
        up_target, top_of_target = self._up(target, stamp_ns)
        up_source, top_of_source = self._up(source, stamp_ns)
        for frame, common_T_source in up_source.items():
            if frame in up_target:
                return up_target[frame].inverse() @ common_T_source
        raise top_of_source or top_of_target or self._not_connected(target, source)

    def _up(
        self, frame: str, stamp_ns: int
    ) -> tuple[dict[str, Transform3], ExtrapolationException | None]:
        """Return ancestor_T_frame of all ancestors, and the error at the end."""
        upper_T_frame = Transform3.identity()
        found = {frame: upper_T_frame}
        while (history := self._frames.get(frame)) and len(found) < _MAX_DEPTH:
            try:
                upper_T_lower, frame = history.at(stamp_ns)
            except ExtrapolationException as error:
                return found, error  # higher frames may not be needed
            upper_T_frame = upper_T_lower @ upper_T_frame
            found[frame] = upper_T_frame
        return found, None

    def _ancestors(self, frame: str) -> list[str]:
        """Return the frame and its ancestors in the current tree."""
        path = [frame]
        for _ in range(_MAX_DEPTH):
            history = self._frames.get(path[-1])
            if history is None:
                return path
            path.append(history.parent)
        raise InvalidArgumentException(f"frames form a cycle: {' → '.join(path[:5])} …")

    def _check_known(self, *frames: str) -> None:
        for frame in frames:
            if not self.contains(frame):
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
    """Return the name without a leading slash, which tf1 used.

    Raises:
        InvalidArgumentException: the name is empty.
    """
    if not isinstance(name, str) or not name.strip("/"):
        raise InvalidArgumentException(f"frame name {name!r}: must not be empty")
    return name.removeprefix("/")


def _checked(transform: Transform3, child: str) -> Transform3:
    """Return the transform, normalised; it must be finite and nearly normalised."""
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
            f"{norm:.4f}, expected 1"
        )
    return Transform3((tx, ty, tz), (x / norm, y / norm, z / norm, w / norm))
