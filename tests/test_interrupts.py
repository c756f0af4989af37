"""What a termination signal does to whoever lets it interrupt."""

from __future__ import annotations

import signal
import threading

import pytest

from rigid.interrupts import interrupts_held, terminated_as_interrupted


def test_a_termination_signal_interrupts_within_the_block_and_means_afterwards_what_it_did_before():
    before = signal.getsignal(signal.SIGTERM)
    with pytest.raises(KeyboardInterrupt), terminated_as_interrupted():
        signal.raise_signal(signal.SIGTERM)
    assert signal.getsignal(signal.SIGTERM) == before


@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_waits_for_what_must_not_stay_half_done(sent):
    done = []

    def hold() -> None:
        with interrupts_held():
            signal.raise_signal(sent)
            done.append("the rest of the block")
        done.append("what comes after it")

    with pytest.raises(KeyboardInterrupt), terminated_as_interrupted():
        hold()
    assert done == ["the rest of the block"]


def test_once_nothing_is_held_a_signal_interrupts_as_before():
    with interrupts_held():
        pass
    with pytest.raises(KeyboardInterrupt):
        signal.raise_signal(signal.SIGINT)


def test_a_signal_that_means_something_else_is_not_held():
    heard: list[int] = []
    before = signal.signal(signal.SIGTERM, lambda number, _: heard.append(number))
    try:
        with interrupts_held():
            signal.raise_signal(signal.SIGTERM)
            assert heard == [signal.SIGTERM]
    finally:
        signal.signal(signal.SIGTERM, before)


def test_a_thread_that_nothing_interrupts_may_hold_too():
    held: list[bool] = []

    def hold() -> None:
        with interrupts_held():
            held.append(True)

    thread = threading.Thread(target=hold)
    thread.start()
    thread.join()
    assert held == [True]
