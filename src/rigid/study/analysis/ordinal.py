"""Scores on a scale against both axes: a cumulative logit model with raters and pairs at random.

Scores from 0 to 7 are ordered but have no distance, and those of one rater, one pair or one episode
are alike. So the model (Agresti, Analysis of Ordinal Categorical Data, chapter 10) is

    logit P(score ≤ k) = c_k - (β_x x + β_y y + u_rater + v_pair + w_episode),

with all three intercepts normal. The appendix names no test. The intercept of the episode is ours:
x and y belong to the episode, and without it every rating of one episode would count as a new one.

Priors, ours, weak on this scale: the shares of the categories of a middling episode are uniform
(Dirichlet with ones), which orders the c_k; β ~ N(0, 5) for the whole width of an axis; the
standard deviations of the intercepts ~ half-normal(1.5). Sampled by NUTS in NumPyro; what has not
converged is refused and not reported.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from rigid.frontier.intervals import Interval
from rigid.study.analysis.judged import Scores

MOST_RHAT, LEAST_ESS = 1.01, 400.0
"""Limits of Vehtari, Gelman, Simpson, Carpenter & Bürkner, 'Rank-normalization, folding, and
localization' (Bayesian Analysis 16, 2021), section 4; R-hat here is the split one."""
MOST_DIVERGENT = 0.001
"""Share of transitions; ours: a handful may stand, since they are then no region."""
AXES = ("naturalness", "adversarialness")
FEWEST_RATERS, FEWEST_PAIRS = 2, 3
_FAR, _NEAR = 40.0, 1e-7
"""Log-odds beyond which nothing lies, and least distance of two cutpoints; single precision."""
_PATIENCE = 3
"""How many times more samples the second try takes."""


@dataclass(frozen=True, kw_only=True)
class Slope:
    """How a score changes along an axis."""

    log_odds: float
    """Posterior mean of β: change of the log-odds of a higher score over the whole axis."""
    interval: Interval
    """Central posterior interval."""
    positive: float
    """Posterior probability that β > 0."""


@dataclass(frozen=True, kw_only=True)
class OrdinalFit:
    """What the model says, or why it says nothing."""

    refused: str | None
    """Why there are no slopes; None where there are."""
    slopes: Mapping[str, Slope]
    """By axis; empty where the fit was refused."""
    deviations: Mapping[str, float]
    """Posterior mean of the standard deviation of raters, pairs and episodes [log-odds]."""
    answers: int
    raters: int
    pairs: int
    r_hat: float | None
    """The worst of all parameters."""
    ess: float | None
    """The smallest effective number of samples of all parameters."""
    divergent: int | None


class _Data:
    """What the model conditions on."""

    def __init__(self, scores: Scores) -> None:
        self.levels, self.level = np.unique(scores.score, return_inverse=True)
        self.groups: dict[str, Int[np.ndarray, " n"]] = {
            "rater": np.unique(scores.rater, return_inverse=True)[1],
            "pair": np.unique(scores.pair, return_inverse=True)[1],
            "episode": np.unique(scores.member, return_inverse=True)[1],
        }
        places = np.stack([scores.naturalness, scores.adversarialness], axis=1)
        self.places: Float[np.ndarray, "n 2"] = places - places.mean(axis=0)

    def size(self, group: str) -> int:
        return int(self.groups[group].max()) + 1


def fit_ordinal(
    scores: Scores, *, chains: int, samples: int, seed: int, confidence: float = 0.95
) -> OrdinalFit:
    """Fits the model; tries once more with a longer and more careful run before it refuses.

    Args:
        scores: At least two levels, two raters and three pairs, else the fit is refused.
        chains: Markov chains; R-hat is over their halves.
        samples: Of each chain, after as many to warm up.
        seed: Of the sampler.
        confidence: Of the posterior intervals.
    """
    lacking = _lacking(scores)
    if lacking is not None:
        return _refusal(scores, lacking)
    data = _Data(scores)
    draws, divergent = _sample(data, chains=chains, samples=samples, accept=0.9, seed=seed)
    worst = _diagnose(draws)
    if _complaint(*worst, divergent, chains * samples) is not None:
        more = _PATIENCE * samples
        draws, divergent = _sample(data, chains=chains, samples=more, accept=0.99, seed=seed + 1)
        worst = _diagnose(draws)
    total = int(np.prod(draws["slope"].shape[:2]))
    complaint = _complaint(*worst, divergent, total)
    if complaint is not None:
        return _refusal(scores, complaint, worst, divergent)
    slope = draws["slope"].reshape(-1, len(AXES))
    tail = (1 - confidence) / 2
    ends = np.quantile(slope, [tail, 1 - tail], axis=0)
    return OrdinalFit(
        refused=None,
        slopes={
            axis: Slope(
                log_odds=float(slope[:, n].mean()), interval=Interval(*ends[:, n].tolist()),
                positive=float((slope[:, n] > 0).mean()),
            )
            for n, axis in enumerate(AXES)
        },
        deviations={name: float(draws[f"sd_{name}"].mean()) for name in data.groups},
        **_counts(scores), r_hat=worst[0], ess=worst[1], divergent=divergent,
    )  # fmt: skip


def _lacking(scores: Scores) -> str | None:
    """What is too little for a model, None where all is there."""
    raters, pairs = len(np.unique(scores.rater)), len(np.unique(scores.pair))
    if raters < FEWEST_RATERS or pairs < FEWEST_PAIRS:
        return (
            f"{raters} raters and {pairs} pairs, but the model needs at least {FEWEST_RATERS} and "
            f"{FEWEST_PAIRS}"
        )
    if len(np.unique(scores.score)) < 2:
        return "every score is the same"
    return None


def _complaint(r_hat: float, ess: float, divergent: int, total: int) -> str | None:
    """Why the samples are not to be believed, None where they are; NaN is not."""
    if not r_hat <= MOST_RHAT:
        return f"the chains have not met: R-hat is {r_hat:.3f} and must be at most {MOST_RHAT}"
    if not ess >= LEAST_ESS:
        return f"too few effective samples: {ess:.0f} and must be at least {LEAST_ESS:.0f}"
    if divergent > MOST_DIVERGENT * total:
        return f"{divergent} of {total} transitions diverged"
    return None


def _refusal(
    scores: Scores, why: str, worst: tuple[float, float] | None = None, divergent: int | None = None
) -> OrdinalFit:
    return OrdinalFit(
        refused=why, slopes={}, deviations={}, **_counts(scores), divergent=divergent,
        r_hat=None if worst is None else worst[0], ess=None if worst is None else worst[1],
    )  # fmt: skip


def _counts(scores: Scores) -> dict[str, int]:
    return {
        "answers": len(scores.score), "raters": len(np.unique(scores.rater)),
        "pairs": len(np.unique(scores.pair)),
    }  # fmt: skip


def _sample(
    data: _Data, *, chains: int, samples: int, accept: float, seed: int
) -> tuple[dict[str, np.ndarray], int]:
    """Draws by name, each (chains, samples, …), and how many transitions diverged."""
    import jax
    from numpyro.infer import MCMC, NUTS, init_to_uniform

    # NumPyro's own broadcasting is its business.
    with jax.numpy_rank_promotion("allow"):
        sampler = MCMC(
            NUTS(
                _model(data),
                target_accept_prob=accept,
                init_strategy=init_to_uniform(radius=1.0),
            ),
            num_warmup=samples, num_samples=samples, num_chains=chains,
            chain_method="vectorized", progress_bar=False,
        )  # fmt: skip
        sampler.run(jax.random.key(seed), extra_fields=("diverging",))
        draws = {
            name: np.asarray(array)
            for name, array in sampler.get_samples(group_by_chain=True).items()
        }
        return draws, int(np.asarray(sampler.get_extra_fields()["diverging"]).sum())


def _model(data: _Data) -> Callable[[], None]:
    """The model of the module's docstring, as NumPyro takes it."""
    import jax.numpy as jnp
    import numpyro
    from numpyro import distributions as dist

    def model() -> None:
        shares = numpyro.sample("shares", dist.Dirichlet(jnp.ones(len(data.levels))))
        # Sums from both ends, since 1 - a sum near 1 is nothing in single precision.
        above = jnp.cumsum(shares[::-1])[::-1][1:]
        inner = jnp.log(jnp.cumsum(shares)[:-1]) - jnp.log(above)
        slope = numpyro.sample("slope", dist.Normal(jnp.zeros(len(AXES)), 5.0).to_event(1))
        predictor = data.places @ slope
        for name, group in data.groups.items():
            deviation = numpyro.sample(f"sd_{name}", dist.HalfNormal(1.5))
            with numpyro.plate(f"{name}s", data.size(name)):
                standard = numpyro.sample(name, dist.Normal(0.0, 1.0))
            predictor += deviation * standard[group]
        numpyro.factor("score", log_share(data.level, inner, predictor))

    return model


def log_share(level: Any, cutpoints: Any, predictor: Any) -> Any:
    """Log-probability of each answer: log(σ(c_k - η) - σ(c_(k-1) - η)).

    In parts that keep their gradient where a category is rare, as NumPyro's `OrderedLogistic`
    does not in single precision: a chain that began there would never leave.

    Args:
        level: Category of each answer from 0, (n,).
        cutpoints: Ascending [log-odds], one fewer than there are categories.
        predictor: η of each answer [log-odds], (n,).
    """
    import jax.numpy as jnp
    from jax.nn import log_sigmoid

    ends = jnp.concatenate([jnp.array([-_FAR]), jnp.asarray(cutpoints), jnp.array([_FAR])])
    low, high = ends[level] - predictor, ends[level + 1] - predictor
    # σ(b) - σ(a) = σ(b) σ(-a) (1 - e^(a - b)).
    between = jnp.log(-jnp.expm1(jnp.minimum(low - high, -_NEAR)))
    return log_sigmoid(high) + log_sigmoid(-low) + between


def _diagnose(draws: Mapping[str, np.ndarray]) -> tuple[float, float]:
    """The worst split R-hat and the smallest effective number of samples of all parameters."""
    from numpyro.diagnostics import effective_sample_size, split_gelman_rubin

    def each(measure: Any) -> np.ndarray:
        return np.concatenate([np.ravel(measure(array)) for array in draws.values()])

    return float(each(split_gelman_rubin).max()), float(each(effective_sample_size).min())
