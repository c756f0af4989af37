"""Curves of several methods in one figure."""

from __future__ import annotations

import pytest
from matplotlib.figure import Figure

from rigid.report.curves import draw_curves, inline_curves, overlay
from tests.frontier.samples import measured

ONE, OTHER = measured({0: 0.5, 1: 0.6})[0], measured({0: 0.3, 1: 0.4})[0]


def drawn(methods):
    axis = Figure().subplots()
    overlay(axis, methods)
    return axis


def lines_of(axis):
    """Curves, by their width; dots have no line."""
    return [line.get_linewidth() for line in axis.lines if line.get_linestyle() != "None"]


def test_a_method_of_several_robots_has_their_curves_behind_its_mean():
    axis = drawn({"vanilla": [ONE, OTHER]})
    assert lines_of(axis) == [0.7, 0.7, 2.0]
    mean = axis.lines[2].get_ydata()
    both = [axis.lines[number].get_ydata() for number in (0, 1)]
    assert mean == pytest.approx((both[0] + both[1]) / 2)


def test_a_single_robot_has_its_interval_behind_its_curve():
    axis = drawn({"vanilla": [ONE], "robust": [OTHER]})
    assert lines_of(axis) == [2.0, 2.0]
    assert len(axis.collections) == 2


def test_many_robots_are_told_apart_by_colour_and_dashes():
    axis = drawn({f"robot {number}": [ONE] for number in range(12)})
    curves = [line for line in axis.lines if line.get_linestyle() != "None"]
    assert len({(line.get_color(), line.get_linestyle()) for line in curves}) == 12
    (legend,) = axis.figure.legends
    assert len(legend.get_texts()) == 12


def test_every_adversary_is_a_point():
    axis = drawn({"vanilla": [ONE]})
    (points,) = [line for line in axis.lines if line.get_linestyle() == "None"]
    assert sorted(zip(*points.get_data(), strict=True)) == [(0.9, 0.5), (0.9, 0.6)]


@pytest.mark.parametrize(
    ("ending", "begins"), [("svg", b"<?xml"), ("pdf", b"%PDF"), ("png", b"\x89PNG")]
)
def test_equal_data_give_equal_files(tmp_path, ending, begins):
    for name in ("one", "two"):
        draw_curves(tmp_path / f"{name}.{ending}", {"vanilla": [ONE]})
    one, two = ((tmp_path / f"{name}.{ending}").read_bytes() for name in ("one", "two"))
    assert one.startswith(begins)
    assert one == two


def test_a_name_is_neither_mathematics_nor_markup():
    text = inline_curves({r"_$\frac$ </svg><script>": [ONE]})
    assert text.startswith("<svg")
    assert r"_$\frac$ &lt;/svg&gt;&lt;script&gt;" in text
    assert "<script" not in text
