"""What is varied."""

from __future__ import annotations

import json
from dataclasses import asdict

from benchmarks.ablations.plan import PLAN, QUICK


def changes(variant):
    """Names of the settings in which a variant departs from the default."""
    default = asdict(PLAN.default.settings)
    mine = asdict(variant.settings)
    own, usual = mine.pop("discriminator"), default.pop("discriminator")
    return {
        *(name for name in mine if mine[name] != default[name]),
        *(name for name in own if own[name] != usual[name]),
        *(["features"] if variant.features != "default" else []),
    }


def test_every_variant_changes_one_factor_of_the_default():
    allowed = {
        "noise": {"noise", "noise_decay", "noise_floor"},
        "gradient penalty": {"gradient_penalty"},
        "class weights": {"canonical_weight"},
        "features": {"features"},
        "start": {"natural_start"},
        "replay": {"replay_share"},
    }
    default, *others = PLAN.variants()
    assert changes(default) == set()
    for variant in others:
        assert changes(variant)
        assert changes(variant) <= allowed[variant.factor]


def test_variants_have_names_of_their_own_and_fit_into_json():
    names = [variant.name for variant in PLAN.variants()]
    assert len(set(names)) == len(names) == 13
    json.dumps([variant.describe() for variant in PLAN.variants()], allow_nan=False)


def test_every_size_divides_the_largest():
    for plan in (PLAN, QUICK):
        assert all(plan.sizes.episodes[-1] % size == 0 for size in plan.sizes.episodes)
