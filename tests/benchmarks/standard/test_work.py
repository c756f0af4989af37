"""Estimates of time follow what is done, and what fits into a time."""

from __future__ import annotations

import shutil

import pytest

from benchmarks.standard.making import Workplace
from benchmarks.standard.plan import Part
from benchmarks.standard.work import (
    GAIN_OF_PROCESSES,
    Work,
    search_seconds,
    training_seconds,
    work_of,
)
from rigid.compute.executors.executor import Local
from rigid.compute.executors.processes import Processes
from rigid.cores import cores
from tests.benchmarks.standard.planting import SMALL, VANILLA, store_robot

STANDARD, PAPER = Part(VANILLA, "standard", 0), Part(VANILLA, "paper", 0)
FIXED = 8.0


class Time:
    """A time that tests set."""

    def __init__(self):
        self.seconds = 50.0

    def __call__(self):
        return self.seconds


@pytest.fixture
def time():
    return Time()


@pytest.fixture
def work(time):
    """Two parts of 100 and 900 s, on two workers."""
    search = {"standard": 100.0 - FIXED, "paper": 900.0 - FIXED}
    return Work({STANDARD: 0.0, PAPER: 0.0}, search, workers=2, now=time)


def test_a_search_takes_its_steps_and_its_scoring():
    budget = SMALL.search("paper")
    assert search_seconds(budget, 100, speed=1000.0) == 18 * 2 + 18 * 120 * 48 * 100 / 1000


def test_what_is_left_is_shared_by_the_workers(work):
    assert work.left == 500.0


def test_a_search_that_is_over_takes_no_more_training_time(work):
    work.advance(PAPER, 1.0)
    assert work.left == pytest.approx((100 + FIXED) / 2)


def test_what_is_left_is_corrected_once_a_part_is_finished(work, time):
    work.advance(PAPER, 0.25)
    time.seconds += 1000
    assert work.left < 500.0
    work.finish(STANDARD)
    done = (100 + 0.25 * (900 - FIXED)) / 2
    assert work.left == pytest.approx((500 - done) * 1000 / done)


def test_when_everything_is_finished_nothing_is_left(work):
    work.finish(STANDARD)
    work.finish(PAPER)
    assert (work.parts, work.left) == (0, 0.0)


def test_a_part_alone_takes_one_worker_its_whole_time(work):
    assert work.seconds_with(PAPER) == 900.0


def test_a_part_waits_for_what_is_under_way_where_all_workers_are_busy(time):
    parts = [PAPER._replace(seed=seed) for seed in range(3)]
    work = Work(dict.fromkeys(parts, 0.0), {"paper": 900.0 - FIXED}, workers=2, now=time)
    for part in parts[:2]:
        work.begin(part)
    assert work.seconds_with(parts[2]) == 3 * 900.0 / 2


def test_processes_share_the_speed_of_all_cores_and_gain(tmp_path):
    place = Workplace(SMALL, tmp_path / "runs", tmp_path / "results")
    alone, two = (
        work_of(place, [PAPER], executor, 1000.0).expected for executor in (Local(), Processes(2))
    )
    fixed = FIXED + 18 * 2
    speed = GAIN_OF_PROCESSES / len(cores())
    assert two == pytest.approx((fixed + (alone - fixed) / speed) / 2)


def test_rounds_that_are_done_are_not_expected_again(tmp_path):
    place = Workplace(SMALL, tmp_path / "runs", tmp_path / "results")
    groups = place.raw(PAPER) / "groups"
    groups.mkdir(parents=True)
    (groups / "s0-r1.json").touch()
    assert place.searched_share(PAPER) == pytest.approx(1 / 3)
    (groups.parent / "frontier.json").touch()
    assert place.searched_share(PAPER) == 1.0


def test_a_robot_that_is_to_be_trained_takes_time(tmp_path):
    store_robot(tmp_path / "runs")
    place = Workplace(SMALL, tmp_path / "runs", tmp_path / "results")
    assert training_seconds(place, speed=1000.0) == 0
    shutil.rmtree(tmp_path / "runs" / "i100-s0")
    assert training_seconds(place, speed=1000.0) == pytest.approx(6 + 100 * 96 * 100 / 1000.0)
