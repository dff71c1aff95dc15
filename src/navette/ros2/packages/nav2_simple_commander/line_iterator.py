"""Points along a straight line."""

# ruff: noqa: N802 - the names are Nav2's

import math


class LineIterator:
    """Iterator along a line from (x0, y0) to (x1, y1), both included.

    Steps of ``step_size`` are taken along x, for a vertical line along y.

    Raises:
        TypeError: an argument is not an int or float.
        ValueError: the step is not positive, or the line has no length.
    """

    def __init__(
        self, x0: float, y0: float, x1: float, y1: float, step_size: float = 1.0
    ) -> None:
        given = {"x0": x0, "y0": y0, "x1": x1, "y1": y1, "step_size": step_size}
        for name, value in given.items():
            if type(value) not in (int, float):
                raise TypeError(f"{name} must be a number (int or float)")
        if step_size <= 0:
            raise ValueError("step_size must be a positive number")
        if (x0, y0) == (x1, y1):
            raise ValueError(
                "Line has zero length (All 4 points have same coordinates)"
            )
        self.x0_, self.y0_, self.x1_, self.y1_ = x0, y0, x1, y1
        self.x_, self.y_ = x0, y0
        self.step_size_ = step_size
        self.valid_ = True

    def isValid(self) -> bool:
        """Whether the present point is on the line."""
        return self.valid_

    def advance(self) -> None:
        """Go to the next point; after the last one the iterator is invalid."""
        if self.x1_ != self.x0_:
            if self.x_ == self.x1_:
                self.valid_ = False
                return
            self.x_ = round(self._toward(self.x_, self.x1_), 5)
            share = (self.x_ - self.x0_) / (self.x1_ - self.x0_)
            self.y_ = round(self.y0_ + share * (self.y1_ - self.y0_), 5)
        elif self.y_ == self.y1_:
            self.valid_ = False
        else:
            self.y_ = round(self._toward(self.y_, self.y1_), 5)

    def getX(self) -> float:
        return self.x_

    def getY(self) -> float:
        return self.y_

    def getX0(self) -> float:
        return self.x0_

    def getY0(self) -> float:
        return self.y0_

    def getX1(self) -> float:
        return self.x1_

    def getY1(self) -> float:
        return self.y1_

    def get_line_length(self) -> float:
        return math.hypot(self.x1_ - self.x0_, self.y1_ - self.y0_)

    def clamp(self, n: float, min_n: float, max_n: float) -> float:
        """Return ``n`` limited to a range."""
        return min(max(n, min_n), max_n)

    def _toward(self, value: float, end: float) -> float:
        """Return the value one step nearer to the end."""
        if end > value:
            return min(value + self.step_size_, end)
        return max(value - self.step_size_, end)
