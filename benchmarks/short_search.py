"""Adversaries in a ninth of the paper's steps, for studies that train many of them."""

from __future__ import annotations

from dataclasses import replace

from rigid.compute.preparation import settings_for
from rigid.learning.adversary_settings import AdversarySettings
from rigid.naturalness.choice import DEFAULT_MEASURE
from rigid.presets import Preset

ITERATIONS, EPISODES = 40, 16
"""Instead of 120 and 48."""
QUICK_PRESET = Preset(
    name="quick",
    seeds=(0, 1),
    per_round=(2,),
    iterations=2,
    episodes=4,
    scoring_episodes=6,
    referee_episodes=6,
    validation_episodes=3,
    referee_canonical=20,
)
"""The whole road with budgets that say nothing; a study gives it a name and a stamp."""


def short_settings(preset: Preset, measure: str = DEFAULT_MEASURE) -> AdversarySettings:
    """The search's settings but for the policy's: three times the rate, a third of the minibatch.

    Ours. In `ITERATIONS` of `EPISODES` a policy takes as many gradient steps in an iteration as in
    the paper's budget, each three times as long in a third of the iterations. At the search's own
    rate a study of so few steps would say nothing about natural attacks: adversaries that started
    at the synthetic human with λ = 0.4, 0.7 and 1.5 ended at an adversarialness of 0.006 or less
    after 30 iterations of 24 episodes. At this one λ = 0.4, 0.8 and 1.6 end at 0.46, 0.40 and 0.02,
    much as in the paper's budget (measured once each, with `builtin:vanilla` and `lsgan`).
    """
    settings = settings_for(preset, search_measure=measure)
    ppo = settings.ppo
    rate, minibatch = 3 * ppo.learning_rate, ppo.minibatch // 3
    return replace(settings, ppo=replace(ppo, learning_rate=rate, minibatch=minibatch))
