"""CallbackError: names node, topic and time, keeps the original class."""

import pytest

from navette.errors import CallbackError


class DemandingError(LookupError):
    """Takes two arguments."""

    def __init__(self, thing: str, place: int) -> None:
        super().__init__(f"{thing} at {place}")
        self.thing = thing


class SealedError(Exception):
    """Forbids subclasses."""

    def __init_subclass__(cls) -> None:
        raise TypeError("no subclasses")


@pytest.mark.parametrize(
    "cause",
    [
        ValueError("three"),
        KeyError("three"),
        OSError(5, "three"),
        DemandingError("three", 4),
        UnicodeDecodeError("utf-8", b"three", 0, 1, "three"),
        SealedError("three"),
        ExceptionGroup("three", [ValueError("x")]),
        StopIteration("three"),
    ],
    ids=lambda cause: type(cause).__name__,
)
def test_the_message_names_node_source_and_time(cause: Exception) -> None:
    error = CallbackError.of("/node", "/topic", 1_500_000_000, cause)
    assert "node /node: callback of /topic raised at 1.500 s" in str(error)
    assert type(cause).__name__ in str(error)
    assert "three" in str(error)
    assert isinstance(error, CallbackError)
    assert error.original is cause
    if not isinstance(cause, SealedError | ExceptionGroup):
        assert isinstance(error, type(cause))


def test_attributes_of_the_original_are_available() -> None:
    error = CallbackError.of("/node", "/topic", 0, DemandingError("spoon", 4))
    assert isinstance(error, DemandingError)
    assert error.thing == "spoon"
