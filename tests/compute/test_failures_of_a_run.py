"""From a run directory to the modes in which its robot fails, in the report and for programs."""

from __future__ import annotations

import json
import shutil

import numpy as np
import pytest

from rigid.compute.run.directory import RunDirectory, read_settings
from rigid.errors import UserError
from rigid.frontier.result import load_frontier
from rigid.report import gather as gathering
from rigid.report.failures import failure_modes
from rigid.report.gather import EPISODES, gather, replays, write_report
from rigid.report.payload import Failure, FailureModes
from tests.compute.tiny import FilmedReach
from tests.report.planted_episodes import SCENE, planted, still


class TellingReach(FilmedReach):
    """Shows a robot that never moves, whatever happened."""

    def scene(self):
        return SCENE

    def replay(self, snapshots):
        del snapshots
        return planted(still())


@pytest.fixture
def run(small_run, tmp_path):
    """A copy of `small_run`, to be changed."""
    return shutil.copytree(small_run.directory, tmp_path / "run")


@pytest.fixture
def telling(monkeypatch):
    """Takes the task of every run for one of RIGID's own that tells how episodes failed."""
    monkeypatch.setattr(gathering, "task_of", lambda _: TellingReach())


def test_each_failed_episode_of_an_adversary_comes_with_its_failure(small_run):
    shown = replays(small_run, TellingReach())
    canonical = shown.pop("canonical")
    episodes = [entry[kind] for entry in shown.values() for kind in EPISODES]
    failed = [episode for episode in episodes if episode["outcome"] != "helped"]
    assert failed
    for episode in failed:
        assert set(episode["failure"]) == set(Failure.__annotations__)
        assert episode["failure"]["kind"] == "stuck"
    assert all(e["failure"] is None for e in episodes if e not in failed)
    assert all("failure" not in episode for episode in canonical.values())


def test_a_replay_that_does_not_tell_has_no_failure(small_run):
    shown = replays(small_run, FilmedReach())
    del shown["canonical"]
    assert all(entry[kind]["failure"] is None for entry in shown.values() for kind in EPISODES)


def test_an_episode_that_ran_away_is_not_judged(run):
    for path in run.rglob("episodes.npz"):
        with np.load(path) as file:
            arrays = {name: file[name] for name in file.files}
        arrays["faulted"] = np.ones_like(arrays["faulted"])
        np.savez_compressed(path, **arrays)
    shown = replays(load_frontier(run), TellingReach())
    del shown["canonical"]
    assert all(entry[kind]["failure"] is None for entry in shown.values() for kind in EPISODES)


def test_the_page_and_programs_get_the_same_modes(run, telling):
    del telling
    assert write_report(run) == run / "report.html"
    found = gather(load_frontier(run), read_settings(RunDirectory(run)))["failures"]
    assert set(found) == set(FailureModes.__annotations__)
    assert [mode["kind"] for mode in found["modes"]] == ["stuck"]
    stored = json.loads((run / "failures.json").read_text(encoding="utf-8"))
    assert {name: stored[name] for name in found} == found
    assert (stored["schema"], stored["task"]) == (1, "toy-reach")
    assert failure_modes(run) == found


def test_without_the_file_the_modes_are_found_again(run, telling):
    del telling
    found = failure_modes(run)
    assert [mode["kind"] for mode in found["modes"]] == ["stuck"]
    assert not (run / "failures.json").exists()


def test_a_report_that_goes_elsewhere_leaves_no_file(run, telling, tmp_path):
    del telling
    write_report(run, tmp_path / "page.html")
    assert not list(tmp_path.rglob("failures.json"))


def test_a_task_that_does_not_tell_has_neither_modes_nor_a_file(run):
    write_report(run)
    assert failure_modes(run) is None
    assert not (run / "failures.json").exists()


@pytest.mark.parametrize("text", ["{", "[]", '{"modes": []}'])
def test_a_damaged_file_is_named_with_its_cure(run, text):
    (run / "failures.json").write_text(text)
    with pytest.raises(UserError, match=r"failures\.json is damaged: delete it and run `rigid rep"):
        failure_modes(run)
