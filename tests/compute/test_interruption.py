"""A run is safe: whatever kills it, the same command goes on and the numbers stay the same."""

from __future__ import annotations

import contextlib
import io
import json
import signal
import time
from pathlib import Path
from typing import NamedTuple

import pytest

from rigid import presets
from rigid.cli import run
from rigid.errors import UserError
from rigid.frontier.result import Frontier
from tests.compute.tiny import (
    TINY,
    Notes,
    hasten_referees,
    interrupt_at,
    start_rigid,
    without_times,
)

PATIENCE = 300.0
"""Seconds until a stage counts as hung; a shared machine may be slow."""


class Disturbed(NamedTuple):
    """A measurement that was killed twice, interrupted once and then finished."""

    frontier: Frontier
    exit_code: int
    output: str
    message: str


def options_of(base: Path, out: Path) -> tuple[str, ...]:
    pair = base / "pair"
    return (
        "frontier", "--task", "toy-reach", "--robot", str(pair / "robot"),
        "--human", str(pair / "human"), "--preset", "tiny", "--seeds", "0", "--out", str(out),
    )  # fmt: skip


def killed_at(path: Path, process) -> int:
    """Exit code of a process that is killed as soon as `path` exists."""
    give_up = time.monotonic() + PATIENCE
    while not path.exists():
        assert process.poll() is None, process.communicate(timeout=PATIENCE)
        assert time.monotonic() < give_up, f"{path} did not appear"
        time.sleep(0.01)
    process.kill()
    process.communicate(timeout=PATIENCE)
    return process.returncode


@pytest.fixture(scope="module")
def disturbed(base, site, measure, tmp_path_factory) -> Disturbed:
    out = tmp_path_factory.mktemp("disturbed") / "run"
    groups, options = out / "groups", options_of(base, out)
    for moment in ("s0-r1.safetensors", "s0-r1.json"):  # A checkpoint, and a finished group.
        assert killed_at(groups / moment, start_rigid(site, *options)) == -signal.SIGKILL
    output, message = io.StringIO(), io.StringIO()
    with (
        pytest.MonkeyPatch.context() as patch,
        contextlib.redirect_stdout(output),
        contextlib.redirect_stderr(message),
    ):
        patch.syspath_prepend(site)
        patch.setitem(presets.PRESETS, "tiny", TINY)
        hasten_referees(patch)
        with interrupt_at(groups / "s0-r2.safetensors"):
            exit_code = run(options)
    assert not (out / "frontier.json").exists()
    return Disturbed(measure(out, seeds=[0]), exit_code, output.getvalue(), message.getvalue())


def test_a_run_that_was_killed_twice_ends_with_the_same_numbers(disturbed, single_run):
    assert without_times(disturbed.frontier) == without_times(single_run)


def test_learning_curves_of_a_killed_run_have_neither_gaps_nor_repeats(disturbed, single_run):
    for path in single_run.directory.rglob("metrics.jsonl"):
        place = path.relative_to(single_run.directory)
        assert (disturbed.frontier.directory / place).read_bytes() == path.read_bytes()


def test_discriminators_of_a_killed_run_are_seen_alike(disturbed, single_run):
    place = "discriminators/s0.json"
    stored = [run.directory / place for run in (disturbed.frontier, single_run)]
    assert stored[0].read_bytes() == stored[1].read_bytes()


def test_an_interrupted_command_exits_with_130_and_says_how_to_go_on(disturbed):
    assert disturbed.exit_code == 130
    assert disturbed.output == ""
    how = f"rigid: interrupted; the same command goes on in {disturbed.frontier.directory}\n"
    assert disturbed.message.endswith(how)
    assert "Traceback" not in disturbed.message


def test_settings_of_a_killed_run_keep_the_command_that_began_it(disturbed):
    settings = json.loads((disturbed.frontier.directory / "settings.json").read_text())
    assert "frontier --task toy-reach" in settings["provenance"]["command"]


@pytest.fixture
def halted(single_copy, measure):
    """A run that stopped in its second round, one iteration after a checkpoint."""
    for path in (single_copy / "frontier.json", single_copy / "groups" / "s0-r2.json"):
        path.unlink()
    checkpoint = single_copy / "groups" / "s0-r2.safetensors"
    with pytest.raises(KeyboardInterrupt):
        measure(single_copy, seeds=[0], listener=Notes(stop=checkpoint.exists))
    return checkpoint


def test_steps_of_earlier_calls_are_told_at_the_beginning_and_not_again(
    halted, single_copy, measure
):
    assert halted.exists()
    notes = Notes()
    measure(single_copy, seeds=[0], listener=notes)
    assert notes.work.done > notes.work.steps / 2  # The first of two rounds, and a checkpoint.
    assert notes.complete


def test_a_truncated_checkpoint_is_refused_and_deleting_it_helps(
    halted, single_copy, single_run, measure
):
    halted.write_bytes(halted.read_bytes()[:1000])
    cure = r"s0-r2\.safetensors is damaged .*: delete this file to train from the start"
    with pytest.raises(UserError, match=cure):
        measure(single_copy, seeds=[0])
    halted.unlink()
    assert without_times(measure(single_copy, seeds=[0])) == without_times(single_run)


@pytest.mark.parametrize("rest", ['{"iteration": 0}\n', '{"iteration": 0}\n{"iter'])
def test_learning_curves_that_do_not_reach_the_checkpoint_are_refused(
    rest, halted, single_copy, measure
):
    (single_copy / "adversaries" / "s0-r2-l1" / "metrics.jsonl").write_text(rest)
    cure = r"metrics\.jsonl is damaged .*: delete .*s0-r2\.safetensors to train from the start"
    with pytest.raises(UserError, match=cure):
        measure(single_copy, seeds=[0])
    assert halted.exists()
