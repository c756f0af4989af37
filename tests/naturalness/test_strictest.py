"""The strictest of many referees: chosen on one half of the episodes, asked on the other."""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rigid.naturalness.panel import Jury
from rigid.naturalness.rates import Rate
from rigid.naturalness.referee import Referee
from rigid.naturalness.standardise import Scale
from rigid.naturalness.strictest import strictest_naturalness
from rigid.naturalness.views import Episodes, all_sound

PLAIN = Scale(np.zeros(1, np.float32), np.ones((1, 1), np.float32))


def panel(slope, offset=0.0, alarms=0.0, **others):
    """One linear referee of single steps: log q/p - log 4 = slope · feature + offset."""
    layer = {"w": jnp.array([[slope]]), "b": jnp.array([offset + np.log(4.0)])}
    jury = Jury((Referee([layer], PLAIN),), {4.0: Rate(alarms, 0.0)})
    return {"step": jury, **others}


def episodes(*rows):
    """Episodes of one feature."""
    return all_sound(np.array(rows, np.float32)[..., None])


def test_half_of_the_episodes_choose_and_the_other_half_is_judged():
    # Even episodes are all +1, which the second referee never lets pass; odd ones are mixed.
    seen = episodes([1, 1, 1, 1], [1, -1, -1, -1], [1, 1, 1, 1], [1, 1, -1, -1])
    found = strictest_naturalness([panel(-1.0), panel(1.0)], seen)
    assert found.referee == 1
    assert found.naturalness == 5 / 8
    assert found.se == pytest.approx(1 / 8)


def test_false_alarms_of_the_strictest_referee_count_four_times():
    found = strictest_naturalness([panel(1.0, alarms=0.05)], episodes([1, 1], [1, 1]))
    assert found.naturalness == pytest.approx(0.2)


def test_of_equally_strict_referees_the_first_is_asked():
    assert strictest_naturalness(
        [panel(1.0), panel(1.0)], episodes([1], [1])
    ).referee == 0  # fmt: skip


def test_one_judged_episode_has_no_standard_error():
    assert strictest_naturalness([panel(1.0)], episodes([1], [1])).se is None


@given(st.integers(0, 99))
def test_referees_that_judge_windows_alone_have_no_say(seed):
    rng = np.random.default_rng(seed)
    seen = episodes(*rng.standard_normal((4, 5)))
    panels = [{"window16": panel(1.0)["step"]}, panel(1.0)]
    assert strictest_naturalness(panels, seen).referee == 1


def test_the_choice_among_referees_does_not_pull_the_bound_down():
    """Each of the two lets half of the steps pass; the lesser of them on the same episodes less."""
    rng = np.random.default_rng(0)
    panels = [panel(1.0), panel(-1.0)]
    found = [
        strictest_naturalness(panels, episodes(*rng.standard_normal((4, 5)))).naturalness
        for _ in range(400)
    ]
    assert np.mean(found) == pytest.approx(0.5, abs=0.03)  # 0.38 if both halves were one.


@pytest.mark.parametrize(
    ("panels", "seen", "message"),
    [
        ([panel(1.0)], episodes([1]), "at least 2 are needed"),
        ([], episodes([1], [1]), "no referee of single steps"),
        (
            [panel(1.0)],
            Episodes(np.zeros((2, 1, 1), np.float32), np.array([[True], [False]])),
            "ran away from the beginning",
        ),
    ],
)
def test_what_cannot_be_judged_is_refused(panels, seen, message):
    with pytest.raises(ValueError, match=message):
        strictest_naturalness(panels, seen)
