"""What a callback raised comes out named, and is still of its own class."""

import pytest

from navette.errors import CallbackError


class DemandingError(LookupError):
    """Cannot be made of one text."""

    def __init__(self, thing: str, place: int) -> None:
        super().__init__(f"{thing} at {place}")
        self.thing = thing


class SealedError(Exception):
    """Does not like heirs."""

    def __init_subclass__(cls) -> None:
        raise TypeError("no heirs")


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
def test_it_names_node_source_and_time_whatever_was_raised(cause: Exception) -> None:
    error = CallbackError.of("/node", "/topic", 1_500_000_000, cause)
    assert "node /node: callback of /topic raised at 1.500 s" in str(error)
    assert type(cause).__name__ in str(error)
    assert "three" in str(error)
    assert isinstance(error, CallbackError)
    assert error.original is cause
    if not isinstance(cause, SealedError | ExceptionGroup):
        assert isinstance(error, type(cause))


def test_what_the_original_knows_is_known() -> None:
    error = CallbackError.of("/node", "/topic", 0, DemandingError("spoon", 4))
    assert isinstance(error, DemandingError)
    assert error.thing == "spoon"
