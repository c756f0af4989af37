"""What grows with what: every case in a fresh process, one size doubling at a time."""

from __future__ import annotations

from dataclasses import asdict, replace

import pytest

from rigid.compute.preparation import prepare, settings_for
from rigid.compute.search.group_plan import GroupInputs
from rigid.compute.speed.growth import (
    AXES,
    Axis,
    Cost,
    in_fresh_process,
    measured_growth,
    summed_up,
)
from rigid.compute.speed.growth_case import Case, measure_case
from rigid.compute.speed.growth_lambdas import ratio_of, time_of_twice_the_lambdas
from rigid.compute.subject import Subject
from rigid.learning.conditioned import Sharing
from rigid.presets import PRESETS
from tests.compute.tiny import TINY, FilmedReach


@pytest.fixture
def toy(base, hasty_referees):
    """The toy robot; its referees are hasty."""
    del hasty_referees
    robot, human = (str(base / "pair" / agent) for agent in ("robot", "human"))
    return Subject(FilmedReach(), robot, human)


def linear(case: Case) -> Cost:
    """400 MB and 5 s, and on top 10 MB for each λ and 2 s for each λ of each seed."""
    return Cost(400.0 + 10 * case.lambdas, 5.0 + 2 * case.lambdas * case.seeds, 900.0)


@pytest.mark.parametrize("axis", AXES, ids=lambda axis: axis.name)
def test_an_axis_doubles_one_size_of_the_base_case(axis):
    assert asdict(Case())[axis.name] in axis.sizes
    assert len(axis.sizes) >= 3
    assert all(after == 2 * size for size, after in zip(axis.sizes, axis.sizes[1:], strict=False))


def test_the_rows_say_what_each_unit_adds():
    axes = [Axis("lambdas", (2, 4, 8), flat=False), Axis("seeds", (1, 2, 4), flat=True)]
    lambdas, seeds = measured_growth(lambda _: None, axes, linear)["rows"]
    assert lambdas["peak_mb"] == [420.0, 440.0, 480.0]
    assert (lambdas["mb_per_unit"], lambdas["seconds_per_unit"]) == (10.0, 2.0)
    assert (seeds["mb_per_unit"], seeds["seconds_per_unit"]) == (0.0, 4.0)


def test_the_case_that_axes_share_is_measured_once():
    measured = []

    def cost(case):
        measured.append(case)
        return linear(case)

    axes = [Axis("lambdas", (2, 4), flat=False), Axis("seeds", (1, 2), flat=True)]
    measured_growth(lambda _: None, axes, cost)
    assert measured == [Case(), Case(lambdas=4), Case(seeds=2)]


@pytest.mark.parametrize(
    ("memory", "flat"),
    [
        pytest.param([400.0, 419.0, 401.0], True, id="less than a twentieth"),
        pytest.param([400.0, 400.0, 421.0], False, id="more at the end"),
        pytest.param([400.0, 421.0, 400.0], False, id="more in between"),
    ],
)
def test_memory_is_flat_within_what_a_heap_settles_by(memory, flat):
    axis = Axis("seeds", (1, 2, 4), flat=True)
    row = summed_up(axis, [Cost(each, 1.0, 900.0) for each in memory])
    assert (row["must_be_flat"], row["is_flat"]) == (True, flat)


def test_a_case_spends_what_it_says():
    preset = Case(lambdas=3, worlds=5, seeds=2, iterations=7).preset
    assert (preset.adversaries, preset.seeds) == (6, (0, 1))
    assert preset.env_steps(100) == 6 * 7 * 5 * 100


def test_robots_of_a_case_are_compared(toy):
    rows = measure_case(Case(robots=2, iterations=2, worlds=TINY.episodes), toy)
    assert [row.name for row in rows] == ["0", "1"]
    assert rows[1].against["auc"].mean == 0.0  # The same robot twice.


@pytest.mark.slow
def test_the_smallest_case_runs_in_a_fresh_process():
    cost = in_fresh_process(Case(iterations=2))
    assert cost.compiling_mb > cost.peak_mb > 100
    assert cost.seconds > 0


def test_twice_the_lambdas_are_timed_beside_those_of_the_preset(toy, tmp_path):
    sharing = Sharing(wild_slots=2, natural_slots=2)
    preset = replace(TINY, sharing=sharing, lambda_min=0.03)
    settings = settings_for(preset)
    prepared = prepare(toy, preset, settings)
    shared = (prepared.task, prepared.opponent, prepared.ruler)
    inputs = GroupInputs(*shared, preset, settings, tmp_path)
    found = time_of_twice_the_lambdas(inputs, 1)
    assert found["lambdas"] == [2, 4]
    assert min(*found["iteration_s"], *found["scoring_s"]) >= 0
    assert found["must_be_at_most"] is None


def test_the_ratio_weighs_scoring_by_all_iterations_of_the_preset():
    found = ratio_of(PRESETS["paper"], 6, (1.0, 30.0), (2.0, 66.0))
    assert found["training_ratio"] == 2.0
    assert found["ratio"] == 2.04  # (120 × 2 + 66) / (120 × 1 + 30)
    assert found["must_be_at_most"] == 2.05
