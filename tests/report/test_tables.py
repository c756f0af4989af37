"""The table of a paper: columns of the contract, and LaTeX that prints any name."""

from __future__ import annotations

import csv
import io

import pytest

from rigid.frontier.standings import standings_of
from rigid.report.tables import csv_text, in_latex, latex, method_row, with_ends
from tests.frontier.samples import measured

COLUMNS = (
    "method,worst_at_0.9,worst_at_0.9_low,worst_at_0.9_high,worst_at_0.9_vs_vanilla_high,"
    "auc_natural,auc_natural_low,auc_natural_high,auc_natural_vs_vanilla_high,"
    "auc,auc_low,auc_high,auc_paper_axis,success,success_low,success_high,robot_seeds,search_seeds"
)


@pytest.fixture(scope="module")
def rows():
    """Two methods, the second of two robots; every adversary of it does 0.2 less harm."""
    standings = standings_of({
        "vanilla": [measured({0: 0.5, 1: 0.6})],
        "robust_gt": [measured({0: 0.3, 1: 0.4}), measured({0: 0.3, 1: 0.4}, success=0.9)],
    })  # fmt: skip
    return [method_row(standing.method, standing.success) for standing in standings]


def test_the_header_is_that_of_the_contract(rows):
    assert csv_text(rows).splitlines()[0] == COLUMNS


def test_the_first_method_has_no_bound_against_itself(rows):
    vanilla, robust = csv.DictReader(io.StringIO(csv_text(rows)))
    assert vanilla["worst_at_0.9_vs_vanilla_high"] == vanilla["auc_natural_vs_vanilla_high"] == ""
    assert float(robust["worst_at_0.9_vs_vanilla_high"]) == pytest.approx(-0.2)
    assert (robust["robot_seeds"], robust["search_seeds"]) == ("2", "2")
    assert float(robust["success"]) == pytest.approx(0.95)


def test_latex_has_the_papers_columns_and_intervals(rows):
    lines = latex(rows).splitlines()
    assert lines[0] == r"\begin{tabular}{lcccc}"
    assert lines[2].endswith(r"AUC $\downarrow$ & Success $\uparrow$ \\")
    assert lines[4].startswith("vanilla & 0.550 [0.000, 1.000] & ")
    assert lines[5].startswith(r"robust\_gt & 0.350 [")


def test_unseen_humans_get_the_last_column(rows):
    asked = [{**row, **with_ends("unseen", None)} for row in rows]
    assert csv_text(asked).splitlines()[0] == f"{COLUMNS},unseen,unseen_low,unseen_high"
    lines = latex(asked).splitlines()
    assert lines[2].endswith(r"& Success, unseen humans $\uparrow$ \\")
    assert lines[4].endswith(r"& -- \\")


def test_methods_may_be_called_otherwise_in_latex(rows):
    assert latex(rows, {"robust_gt": "Robust & GT"}).splitlines()[5].startswith(r"Robust \& GT &")


def test_no_name_is_a_command_in_latex():
    assert in_latex(r"\input{x}^~#$<") == (
        r"\textbackslash{}input\{x\}\textasciicircum{}\textasciitilde{}\#\$\textless{}"
    )
