"""Ctrl-C while a kernel is compiled is not lost in a callback of LLVM."""

import ctypes
import signal
from typing import Any

import pytest

from navette.files.held_signals import held_signals
from navette.files.kernels import KernelCache, kernel


def test_the_handler_is_called_after_the_block() -> None:
    steps: list[str] = []

    def hold() -> None:
        with held_signals():
            signal.raise_signal(signal.SIGINT)
            steps.append("done")

    with pytest.raises(KeyboardInterrupt):
        hold()
    assert steps == ["done"]
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_no_handler_hides_another() -> None:
    arrived: list[int] = []
    before = signal.signal(signal.SIGTERM, lambda number, _: arrived.append(number))

    def hold() -> None:
        with held_signals():
            signal.raise_signal(signal.SIGINT)
            signal.raise_signal(signal.SIGTERM)
            assert not arrived

    try:
        with pytest.raises(KeyboardInterrupt):
            hold()
    finally:
        signal.signal(signal.SIGTERM, before)
    assert arrived == [signal.SIGTERM]


def test_a_callback_from_c_does_not_swallow_it() -> None:
    callback = ctypes.CFUNCTYPE(None)(lambda: signal.raise_signal(signal.SIGINT))
    with pytest.raises(KeyboardInterrupt), held_signals():
        callback()


def test_a_kernel_is_complete_before_the_interrupt(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def interrupt(*_: Any) -> None:
        signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(KernelCache, "load_overload", interrupt)
    monkeypatch.setattr(KernelCache, "save_overload", interrupt)

    @kernel
    def compiled(x: int) -> int:
        return x + 1

    with pytest.raises(KeyboardInterrupt):
        compiled(1)
    kernels: Any = compiled
    assert len(kernels.overloads) == 1
    assert compiled(1) == 2


def test_ignored_signals_stay_ignored() -> None:
    before = signal.signal(signal.SIGTERM, signal.SIG_IGN)
    try:
        with held_signals():
            assert signal.getsignal(signal.SIGTERM) is signal.SIG_IGN
            signal.raise_signal(signal.SIGTERM)
    finally:
        signal.signal(signal.SIGTERM, before)
