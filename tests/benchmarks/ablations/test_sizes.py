"""Judges that have few canonical episodes, on Gaussian motion."""

from __future__ import annotations

import jax
import numpy as np
import pytest

from benchmarks.ablations.humans import Parts
from benchmarks.ablations.plan import Sizes
from benchmarks.ablations.sizes import by_discriminator, by_referee, settled
from rigid.naturalness.lsgan import DiscriminatorSettings
from rigid.naturalness.views import all_sound
from tests.compute.tiny import hasten_referees

SIZES = Sizes(episodes=(10, 20), repeats=1, iterations=4, train=20, validation=10, test=20)


def motion(seed, episodes, shift):
    rng = np.random.default_rng(seed)
    return rng.normal(shift, 1, (episodes, 20, 3)).astype(np.float32)


def human(shift):
    return Parts(*(all_sound(motion(seed, n, shift)) for seed, n in enumerate((20, 10, 20))), None)


POOL, FRESH = motion(8, 20, 0.0), all_sound(motion(9, 20, 0.0))


def test_a_reading_settles_where_no_later_one_is_far_from_the_last():
    assert settled({5: 0.9, 10: 0.5, 20: 0.52, 40: 0.5}, 0.05) == 10
    assert settled({5: 0.5, 10: 0.9, 20: 0.5}, 0.05) == 20
    assert settled({5: 0.5, 10: 0.5}, 0.05) == 5


@pytest.mark.parametrize("episodes", [10, 20])
def test_both_judges_pass_a_canonical_human_and_hold_back_another(episodes, monkeypatch):
    hasten_referees(monkeypatch, "benchmarks.ablations.sizes", block=50, blocks=2)
    for shift, least, most in ((0.0, 0.9, 1.0), (6.0, 0.0, 0.05)):
        key = jax.random.key(0)
        discriminator = by_discriminator(
            POOL, episodes, human(shift), FRESH, SIZES, DiscriminatorSettings(), key
        )
        referee = by_referee(POOL[:episodes], human(shift), FRESH, key)
        for verdict in (discriminator, referee):
            assert least <= verdict.naturalness <= most
            assert verdict.canonical_passed >= 0.9
