"""Works are timed by turns, and the first turn does not count."""

from __future__ import annotations

import subprocess
import sys

import jax.numpy as jnp
import numpy as np

from rigid.compute.memory import peak_memory
from rigid.compute.speed.timing import in_turns, wait_for


def test_every_turn_does_every_work_after_what_comes_before():
    done = []
    works = {name: lambda name=name: done.append(name) for name in ("a", "b")}
    in_turns(works, 2, before=lambda: done.append("before"))
    assert done == ["before", "a", "b"] * 3


def test_the_first_turn_is_not_among_the_times():
    found = in_turns({"a": lambda: None, "b": lambda: None}, 2)
    assert {name: len(times) for name, times in found.items()} == {"a": 2, "b": 2}


def test_only_arrays_are_waited_for():
    wait_for({"array": jnp.ones(3), "other": (np.ones(3), "text", None)})


def test_the_peak_of_a_process_is_not_that_of_the_one_that_started_it():
    """`ru_maxrss` would begin there."""
    held = np.ones(40_000_000)  # 305 MB, so that this process is larger than the other one.
    script = "from rigid.compute.memory import peak_memory; print(peak_memory())"
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True, timeout=120
    )
    assert held.nbytes / 2**20 < peak_memory()
    assert float(done.stdout) < held.nbytes / 2**20
