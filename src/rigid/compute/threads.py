"""How many threads XLA computes on: as many everywhere, since its sums depend on it.

XLA splits a sum over many rows, as the gradient of a layer is, among its threads, and the last
digits of the result tell into how many parts. It counts the cores to know how many threads to
start, so that a worker with one core, and a machine with eight, would each end in numbers of their
own; a search makes different humans of different last digits.
"""

from __future__ import annotations

import os
from collections.abc import MutableMapping

VARIABLE = "PJRT_NPROC"
"""What XLA takes for the number of cores when JAX starts."""
XLA_THREADS = 1
"""Ours. A long measurement has a process for each core, where a second thread only waits for the
first one's core: with two of them an update of preset `standard` took 584 ms of one core, with one
459 to 479. Physics takes every core that it is given, and its numbers do not depend on them."""


def fix_xla_threads(environment: MutableMapping[str, str] = os.environ) -> None:
    """Makes JAX start with the same threads on every machine, unless the user chose others.

    Child processes inherit it. It comes too late where JAX has started: in a program that uses JAX
    itself, set the variable before.
    """
    environment.setdefault(VARIABLE, str(XLA_THREADS))
