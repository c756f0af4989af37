"""What a termination signal does to whoever lets it interrupt."""

from __future__ import annotations

import signal

import pytest

from rigid.interrupts import terminated_as_interrupted


def test_a_termination_signal_interrupts_within_the_block_and_means_afterwards_what_it_did_before():
    before = signal.getsignal(signal.SIGTERM)
    with pytest.raises(KeyboardInterrupt), terminated_as_interrupted():
        signal.raise_signal(signal.SIGTERM)
    assert signal.getsignal(signal.SIGTERM) == before
