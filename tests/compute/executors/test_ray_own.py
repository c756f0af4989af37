"""`rigid frontier --executor ray` where no Ray runs: it starts one, and ends it."""

from __future__ import annotations

import pytest

from rigid.compute.executors.executor import Local
from rigid.frontier.result import load_frontier
from tests.compute.tiny import measured_once, start_rigid, without_times

PATIENCE = 900.0
"""Seconds until the command counts as hung; a shared machine may be slow."""


@pytest.fixture(scope="module")
def finished(base, site, tmp_path_factory):
    """Exit code, standard error and run directory of the command."""
    pair, out = base / "pair", tmp_path_factory.mktemp("own") / "run"
    process = start_rigid(
        site, "frontier", "--task", "toy-reach", "--robot", str(pair / "robot"),
        "--human", str(pair / "human"), "--preset", "tiny", "--seeds", "0", "--out", str(out),
        "--executor", "ray",
    )  # fmt: skip
    _, err = process.communicate(timeout=PATIENCE)
    return process.returncode, err, out


@pytest.mark.slow
def test_the_command_ends_well_and_tells_only_of_its_workers(finished):
    code, err, _ = finished
    assert code == 0, err
    assert "Ray: " in err
    assert "Warning" not in err
    assert "WARNING" not in err


@pytest.mark.slow
def test_the_numbers_are_those_of_a_single_process(base, finished):
    alone = measured_once(base, "single-alone", executor=Local(), seeds=[0])
    assert without_times(load_frontier(finished[2])) == without_times(alone)
