"""The shared search of studies."""

from __future__ import annotations

from dataclasses import replace

from benchmarks.ablations.plan import PLAN as ABLATIONS
from benchmarks.measures.plan import PLAN as MEASURES
from benchmarks.short_search import short_settings
from rigid.compute.preparation import settings_for
from rigid.presets import PRESETS


def test_an_iteration_has_as_many_gradient_steps_as_in_the_papers_budget():
    whole = settings_for(PRESETS["paper"]).ppo
    short = short_settings(MEASURES.preset).ppo
    batches = [
        preset.episodes * 100 // ppo.minibatch
        for preset, ppo in ((PRESETS["paper"], whole), (MEASURES.preset, short))
    ]
    assert batches[0] == batches[1]


def test_the_sum_of_learning_rates_is_that_of_the_papers_budget():
    for preset in (MEASURES.preset, ABLATIONS.preset):
        short, whole = short_settings(preset), settings_for(PRESETS["paper"])
        assert short.ppo.learning_rate * short.iterations == (
            whole.ppo.learning_rate * whole.iterations
        )


def test_nothing_else_is_changed():
    preset = MEASURES.preset
    short, usual = short_settings(preset, "mmd"), settings_for(preset, search_measure="mmd")
    assert replace(short, ppo=usual.ppo) == usual
    same = {"learning_rate": usual.ppo.learning_rate, "minibatch": usual.ppo.minibatch}
    assert replace(short.ppo, **same) == usual.ppo
