"""Trainings for tasks whose episodes are longer than those that the recipes were made for."""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar

from rigid.learning.cooptimisation import CoOptimisationSettings
from rigid.learning.personalisation import PersonalisationSettings

RECIPE_HORIZON = 100
"""Steps of an episode of itch scratching: `episodes` of the recipes' settings means so many."""
FEWEST = 8
"""Episodes of an iteration, so that starts differ and each human of a population has some. Ours."""
_Settings = TypeVar("_Settings", CoOptimisationSettings, PersonalisationSettings)


def fitted(settings: _Settings, horizon: int) -> _Settings:
    """The settings with fewer episodes where they are long: the same steps an iteration.

    Args:
        settings: For episodes of 100 steps.
        horizon: Steps of the task's episodes; short ones change nothing.

    Example:
        >>> fitted(CoOptimisationSettings(), 1000).episodes
        19
    """
    share = min(RECIPE_HORIZON / horizon, 1.0)
    return replace(settings, episodes=max(round(settings.episodes * share), FEWEST))
