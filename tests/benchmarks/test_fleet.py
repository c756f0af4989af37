"""The model of a fleet: its parameters come from finished runs, and the longest bound counts."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.fleet import Costs, account, main
from rigid.errors import UserError
from rigid.frontier.result import Frontier


def run_of(*, core, driver, wall=1000.0, seeds=2):
    """A finished run that took these seconds."""
    times = {"core_seconds": core, "driver_seconds": driver, "wall_seconds": wall}
    by_seed = {str(seed): 0.5 for seed in range(seeds)}
    return Frontier(Path("runs/mine"), {"auc_by_seed": by_seed, **times})


def test_costs_are_the_mean_of_measured_runs():
    runs = [run_of(core=410.0, driver=10.0), run_of(core=830.0, driver=30.0)]
    assert Costs.of(runs) == Costs(driver=20.0, workers=600.0, seeds=2.0)


def test_groups_of_a_seed_come_in_a_row_and_seeds_side_by_side():
    assert Costs(driver=20.0, workers=600.0, seeds=2.0).chain == 320.0


@pytest.mark.parametrize(
    ("robots", "workers", "longest"), [(1000, 10, "workers"), (1000, 60, "driver"), (1, 9, "chain")]
)
def test_the_longest_bound_is_what_to_expect(robots, workers, longest):
    bounds = Costs(driver=20.0, workers=600.0, seeds=2.0).wall(robots, workers)
    assert max(bounds, key=bounds.__getitem__) == longest
    assert f"{longest}  ← longest" in account(Costs(20.0, 600.0, 2.0), robots, workers, None)


def test_a_measured_fleet_stands_beside_the_model():
    text = account(Costs(driver=20.0, workers=600.0, seeds=2.0), 10, 2, 3300.0)
    assert text.splitlines()[0] == (
        "one robot: 20.0 s of the driver, 600 core-s of workers, 320 s at least"
    )
    assert text.endswith(
        "one driver keeps 30 workers busy\nmeasured: 55 min, 1.10 times the longest"
    )


@pytest.mark.parametrize("driver", [None, 0.0, 950.0])
def test_a_run_whose_driver_did_the_groups_as_well_is_refused(driver):
    with pytest.raises(UserError) as caught:
        Costs.of([run_of(core=1800.0, driver=driver)])
    assert str(caught.value) == (
        "runs/mine does not tell the driver's time from that of workers: measure it with "
        "--executor ray"
    )


def test_a_directory_that_is_no_run_exits_with_2(tmp_path, capsys):
    assert main([str(tmp_path)]) == 2
    assert f"fleet: {tmp_path / 'frontier.json'} does not exist" in capsys.readouterr().err
