"""Which family serves which λ, and what its slots play."""

from __future__ import annotations

import numpy as np

from rigid.learning.conditioned import Sharing, codes_at
from rigid.learning.ranges import Range, draw, ranges_of

FEW = Sharing(wild_slots=2, natural_slots=3)
INF = float("inf")


def test_each_family_trains_beyond_the_lambdas_that_were_asked_for():
    wild, natural = ranges_of((1.0, 0.0, 0.1, INF), FEW)
    assert wild == Range((0.0, 0.1, FEW.wild_to), (0.0, 0.1), 2, natural=False)
    assert natural == Range((FEW.natural_from, 1.0, INF), (1.0, INF), 3, natural=True)


def test_no_family_is_made_where_no_lambda_belongs():
    assert [each.natural for each in ranges_of((1.0, 2.0), FEW)] == [True]
    assert [each.natural for each in ranges_of((0.0,), FEW)] == [False]


def test_each_slot_is_told_the_lambda_that_it_plays():
    """λ rises by the same factor from each to the next, so that its logarithm is its place."""
    drawn = draw(Range((0.1, 1.0, 10.0), (1.0,), 5, natural=True), np.random.default_rng(0))
    places = np.log10(np.asarray(drawn.lambdas)) + 1
    np.testing.assert_allclose(drawn.codes, codes_at(places, 3), atol=1e-5)
    assert np.all(np.diff(places) > 0)
