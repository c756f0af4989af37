"""A task with another range of adversarialness than its own, or with one where it has none."""

from __future__ import annotations

import math
from collections.abc import Sequence

from rigid.errors import UserError
from rigid.tasks.protocol import Task
from rigid.tasks.views.view import TaskView


def with_range(task: Task, range_: Sequence[float]) -> Task:
    """`task` with another range of adversarialness; in everything else it is the same task.

    Args:
        task: Any task.
        range_: The returns (worst, best) that map to adversarialness 1 and 0.

    Raises:
        UserError: They are not finite, or `worst` is not below `best`.

    Example:
        >>> from rigid.tasks.registry import make_task
        >>> with_range(make_task("analytic/hand-tracking"), (-10, 0)).return_range
        (-10.0, 0.0)
    """
    view = TaskView(task)
    view.return_range = checked_range(range_)
    return view


def checked_range(range_: Sequence[float]) -> tuple[float, float]:
    """(worst, best) as numbers.

    Raises:
        UserError: They are not finite, or `worst` is not below `best`.
    """
    worst, best = (float(value) for value in range_)
    if not (math.isfinite(worst) and math.isfinite(best) and worst < best):
        raise UserError(
            f"the range of adversarialness is {worst:g},{best:g}, but must be two returns LOW,HIGH "
            "with LOW < HIGH: the one that maps to 1 comes first"
        )
    return worst, best
