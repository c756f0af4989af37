"""`rigid bench` says of a figure how sure it is, of what physics, and what the last run found."""

from __future__ import annotations

import pytest

from rigid.commands.speed_tables import growth_table, other_makers, speed_table

MACHINE = {
    "processor": "Xeon", "cores": 2, "system": "Linux 6", "python": "3.11", "mujoco": "3.17",
    "jax": "0.10", "load": 0.1,
}  # fmt: skip
FIGURES = (
    "physics_env_steps_per_s", "training_env_steps_per_s", "training_over_physics",
    "discriminator_updates_per_s", "referee_s", "report_s", "startup_s",
)  # fmt: skip
FOUND = {
    **dict.fromkeys(FIGURES, 2000),
    "paper_core_hours": 1.5,
    "standard_wall_s": None,
    "assistive_gym": None,
    "repeats": 7,
    "rigid": "1.0",
    "threads": 2,
    "physics_step": 0.02,
    "substeps": 5,
    "machine": MACHINE,
    "budget_per_env_step_us": {"physics": 25.0, "total": 40.5},
    "spread": {
        **{key: [1900, 2100] for key in FIGURES},
        "budget_per_env_step_us": {"physics": [24.0, 26.0], "total": [40.0, 41.0]},
    },
}


def line_of(text, begins):
    (line,) = [line for line in text.splitlines() if line.strip().startswith(begins)]
    return line.strip()


def test_a_figure_stands_with_quartiles_physics_and_the_ratio_to_the_last_run():
    line = line_of(speed_table(FOUND, {"training_env_steps_per_s": 1600}), "adversary training")
    figure = "2,000 [1,900, 2,100] env steps/s at physics 0.02 s × 5"
    assert line == f"adversary training      {figure}   (last run: 1,600, now × 1.25)"


def test_a_first_run_is_compared_with_nothing():
    text = speed_table(FOUND, {})
    assert "last run" not in text
    assert line_of(text, "preset standard") == "preset standard         not measured"


@pytest.mark.parametrize("old", ["fast", None, [1]])
def test_what_is_no_number_in_the_last_file_is_left_out(old):
    assert "last run" not in speed_table(FOUND, {"referee_s": old})


def test_the_budget_of_a_step_names_its_physics():
    text = speed_table(FOUND, {})
    assert "µs per env step of training, physics 0.02 s × 5" in text
    assert line_of(text, "physics  ").split() == ["physics", "25.00", "[24.00,", "26.00]"]


def test_a_last_run_on_another_machine_is_named():
    before = {**FOUND, "threads": 4, "machine": {**MACHINE, "processor": "Epyc", "jax": "0.9"}}
    wanted = "threads 4 then, 2 now; processor Epyc then, Xeon now; jax 0.9 then, 0.10 now"
    assert wanted in speed_table(FOUND, before)


def test_a_busier_machine_is_the_same_machine():
    assert other_makers({**FOUND, "machine": {**MACHINE, "load": 9.0}}, FOUND) == []


def test_assistive_gym_is_said_to_be_measured_elsewhere():
    row = {"ours": 25500, "spread": [25000, 26000], "theirs": 255.0, "ratio": 100.0}
    rows = {"control_hz": 10.0, "stepping": row, "with_resets": {**row, "theirs": 39.0}}
    text = speed_table({**FOUND, "assistive_gym": rows}, {})
    assert "at 10 Hz, physics 0.02 s × 5; Assistive Gym's were measured elsewhere" in text
    assert "25,500 [25,000, 26,000], Assistive Gym 255: × 100" in line_of(text, "stepping alone")


GROWTH_ROW = {
    "axis": "seeds", "sizes": [1, 2], "peak_mb": [600.0, 700.0], "seconds": [5.0, 9.0],
    "compiling_mb": [900.0, 910.0],
    "mb_per_unit": 100.0, "seconds_per_unit": 4.0, "memory_exponent": 0.22, "time_exponent": 0.85,
    "must_be_flat": True, "is_flat": False,
}  # fmt: skip


@pytest.mark.parametrize(
    ("changed", "verdict"),
    [
        ({}, "exponents 0.22, 0.85; MEMORY GROWS, BUT MUST NOT"),
        ({"is_flat": True}, "exponents 0.22, 0.85; memory is flat"),
        ({"must_be_flat": False}, "exponents 0.22, 0.85"),
    ],
)
def test_growth_that_must_not_be_stands_out(changed, verdict):
    growth = {"base": {"seeds": 1}, "rows": [{**GROWTH_ROW, **changed}], "twice_the_lambdas": {}}
    line = line_of(growth_table(growth), "per unit")
    assert line == f"per unit 100 MB, 4 s; {verdict}"


def test_twice_the_lambdas_stand_with_what_is_wanted():
    twice = {"lambdas": [6, 12], "ratio": 1.9, "training_ratio": 2.0, "must_be_at_most": 2.05}
    growth = {"base": {"seeds": 1}, "rows": [], "twice_the_lambdas": {"paper": twice}}
    wanted = "time of 12 λ over 6, preset paper: 1.9, at most 2.05 wanted (training alone 2)"
    assert growth_table(growth).splitlines()[-1] == wanted
