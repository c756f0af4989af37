"""The comparison of robots or methods as JSON: every number with its interval."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rigid.frontier.comparison import Number
    from rigid.frontier.result import Frontier
    from rigid.frontier.standings import Standing
    from rigid.frontier.successes import Success


def robots_as_json(standings: Sequence[Standing], *, asked: bool) -> list[dict[str, Any]]:
    """An entry for each robot, where every method is one.

    Args:
        standings: Each of one robot; the first is the baseline.
        asked: Whether unseen humans were.
    """
    from rigid.frontier.comparison import differences, numbers_of

    (first,) = standings[0].robots
    baseline = numbers_of(first)
    entries = []
    for standing in standings:
        (frontier,) = standing.robots
        numbers = numbers_of(frontier)
        against = None if frontier is first else differences(numbers, baseline)
        entries.append({
            "robot": standing.method.name,
            **_of_robot(frontier),
            **_successes(standing, asked=asked),
            **{
                key: {
                    **_of_number(number),
                    "minus_baseline": None if against is None else against[key]._asdict(),
                }
                for key, number in numbers.items()
            },
        })  # fmt: skip
    return entries


def methods_as_json(standings: Sequence[Standing], *, asked: bool) -> list[dict[str, Any]]:
    """An entry for each method, with its robots.

    Args:
        standings: The first is the baseline.
        asked: Whether unseen humans were.
    """
    return [
        {
            "method": standing.method.name,
            "robot_seeds": standing.method.robots,
            "search_seeds": standing.method.seeds,
            "auc_paper_axis": standing.method.auc_paper_axis,
            **_successes(standing, asked=asked),
            **_numbers(standing),
            "robots": [_whole_robot(frontier) for frontier in standing.robots],
        }
        for standing in standings
    ]


def _numbers(standing: Standing) -> dict[str, Any]:
    against = standing.method.against
    return {
        key: {
            "mean": found.mean,
            "interval": found.interval,
            "minus_baseline": None if against is None else {
                "mean": against[key].mean, "interval": against[key].interval,
            },
        }
        for key, found in standing.method.numbers.items()
    }  # fmt: skip


def _whole_robot(frontier: Frontier) -> dict[str, Any]:
    from rigid.frontier.comparison import numbers_of

    numbers: Mapping[str, Number] = numbers_of(frontier)
    return {
        **_of_robot(frontier),
        "success": frontier.data["canonical"]["success"],
        **{key: _of_number(number) for key, number in numbers.items()},
    }


def _of_robot(frontier: Frontier) -> dict[str, Any]:
    from rigid.compute.run.directory import RunDirectory
    from rigid.frontier.comparison import HEADLINE_LEVEL

    found, _ = frontier.seeds_at(HEADLINE_LEVEL)
    report = RunDirectory(frontier.directory).report
    return {
        "directory": str(frontier.directory),
        "report": str(report) if report.exists() else None,
        "auc_paper_axis": frontier.data.get("auc_paper_axis"),
        "seeds_found": {f"{HEADLINE_LEVEL:g}": found},
    }


def _of_number(number: Number) -> dict[str, Any]:
    from rigid.frontier.comparison import repeat_spread

    return {
        "mean": number.mean,
        "interval": number.interval,
        "by_seed": dict(number.by_seed),
        "repeat_spread": repeat_spread(number),
    }


def _successes(standing: Standing, *, asked: bool) -> dict[str, Any]:
    own = _success("success", standing.success)
    return {**own, **_success("unseen", standing.unseen)} if asked else own


def _success(name: str, found: Success | None) -> dict[str, Any]:
    return {
        name: None if found is None else found.mean,
        f"{name}_interval": None if found is None else found.interval,
    }
