"""The page of a study: findings, figures and tables in one file.

Words of a study are strangers': every one of them is escaped, and the page allows no script.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from importlib import resources

from rigid.frontier.intervals import Interval
from rigid.frontier.standings import TITLES
from rigid.report.plain_page import plain_page, safe, table
from rigid.study.analysis.counting import Control, Count
from rigid.study.analysis.figures import drawings, inline
from rigid.study.analysis.judgements import Judged, ScoreFindings
from rigid.study.analysis.ordinal import AXES, OrdinalFit
from rigid.study.analysis.placing import Placed
from rigid.study.analysis.robots import RobotOrder
from rigid.study.analysis.whole import Analysis
from rigid.study.analysis.wording import (
    QUESTIONS,
    judged_lines,
    notes,
    order_lines,
    sentences,
    spoken_interval,
    spoken_share,
)

_TEMPLATE = resources.files("rigid.study.analysis") / "study.html"
_UNKNOWN = "–"
_PEOPLE = (
    "Players under the frontier. Each stands at the mean adversarialness of its episodes and at an "
    "upper bound of its naturalness; whiskers are one standard error over its episodes. Grey "
    "crosses are scripted players, no people. Hollow marks are of devices of which nothing is "
    "claimed. The shaded steps are what adversaries and canonical play dominate."
)
_PREFERENCE = (
    "Which of two motions of like naturalness is closer to the reference, the recorded one or the "
    "one that RIGID found. The thick line inside the shaded margin means: no preference."
)
_SCORES = "What raters gave to episodes, by where these lie on the frontier's axis."


def study_page(analysis: Analysis) -> str:
    """The page as text."""
    drawn = {name: inline(draw) for name, draw in drawings(analysis)}
    figures = list(drawn.values())
    robots, judged = figures[: len(analysis.met)], figures[len(analysis.met) :]
    return plain_page(
        _TEMPLATE,
        title=f"{analysis.title} · RIGID",
        facts=safe(_facts(analysis)),
        stamps="".join(f'<p class="stamp">{safe(stamp)}</p>' for stamp in _stamps(analysis)),
        findings=_list(sentences(analysis)),
        people="".join(
            _robot(key, figure, analysis) for key, figure in zip(analysis.met, robots, strict=True)
        ),
        order=_order(analysis.order),
        judged="".join(
            _questionnaire(one, figure) for one, figure in zip(analysis.judged, judged, strict=True)
        ),
        notes="".join(f"<li>{safe(note)}.</li>" for note in notes(analysis)),
    )


def _facts(analysis: Analysis) -> str:
    people = ", ".join(f"{count} {role}" for role, count in analysis.people.items()) or "no people"
    scripted = f" · {analysis.scripted} scripted" if analysis.scripted else ""
    return f"{analysis.task} · {people}{scripted}"


def _stamps(analysis: Analysis) -> list[str]:
    stamps = []
    if not analysis.people and analysis.scripted:
        stamps.append("pilot: nobody but scripts took part")
    if analysis.registered is False:
        stamps.append("exploratory: not the analysis that was registered")
    return stamps


def _robot(key: str, figure: str, analysis: Analysis) -> str:
    placed = [p for p in analysis.placed if p.player.robot == key]
    counts = [c for c in analysis.counts if c.robot == key]
    controls = [c for c in analysis.controls if c.robot == key]
    spec = str(analysis.robots[key].frontiers[0].data["robot"])
    parts = [
        f"<h2>People under the frontier of robot {safe(key)}</h2>",
        f'<p class="facts">{safe(spec)}</p>',
        f"<figure>{figure}<figcaption>{safe(_PEOPLE)}</figcaption></figure>",
    ]
    if controls:
        parts.append(f"<h3>Devices</h3>{_controls(controls)}")
    if counts:
        parts.append(f"<h3>Above the frontier</h3>{_counts(counts)}")
    summary = f"<summary>All {len(placed)} players</summary>"
    parts.append(f"<details>{summary}{_players(placed)}</details>")
    return "\n".join(parts)


def _controls(controls: Sequence[Control]) -> str:
    rows = [
        [
            safe(c.device), str(c.people), _number(c.naturalness, c.interval),
            _number(c.adversarialness), "yes" if c.claim else "no", safe(c.why),
        ]
        for c in controls
    ]  # fmt: skip
    heads = (
        "device", "benign players", "their naturalness, at most", "adversarialness", "claim", "why",
    )  # fmt: skip
    return table(heads, rows, text=(5,))


def _counts(counts: Sequence[Count]) -> str:
    rows = [
        [
            safe(c.role), safe(c.device), safe(spoken_share(c.people) if c.claim else "no claim"),
            str(c.clearly), str(c.above_hull),
            safe(spoken_share(c.on_device) if c.claim else "no claim"),
            f"{c.episodes_above} of {c.episodes}",
            safe(spoken_share(c.people_with_episodes_above) if c.claim else "no claim"),
        ]
        for c in counts
    ]  # fmt: skip
    heads = (
        "role", "device", "people above", "clearly", "above the hull",
        "people above, x against practice",
        "episodes above", "people with one",
    )  # fmt: skip
    return table(heads, rows, text=(1, 2, 5, 7))


def _players(placed: Sequence[Placed]) -> str:
    rows = []
    for one in placed:
        who = one.player
        shown = f"{who.name}, scripted" if who.scripted else who.code
        place = "dominated" if not one.above else "clearly above" if one.above_clearly else "above"
        rows.append([
            safe(shown), safe(who.role), safe(who.device), str(len(who.played)),
            _number(one.naturalness), _number(one.on_device), _number(one.adversarialness),
            _number(one.success), _number(one.height), safe(one.unplaced or place),
            _UNKNOWN if one.episodes_above is None else str(one.episodes_above),
        ])  # fmt: skip
    heads = (
        "player", "role", "device", "episodes", "x at most", "x against practice", "y", "success",
        "frontier at x", "", "episodes above",
    )  # fmt: skip
    return table(heads, rows, text=(1, 2, 9))


def _order(order: RobotOrder | None) -> str:
    if order is None:
        return ""
    rows = [
        [
            safe(f"{pair.first}, {pair.second}"), safe(TITLES[one.name]),
            _number(one.mean, one.interval, "+.3f"),
            _number(pair.people.mean, pair.people.interval, "+.2f"),
            _number(pair.people.p, form=".3f"),
            _number(pair.harm.mean, pair.harm.interval, "+.2f"), safe(one.verdict),
        ]
        for pair in order.pairs
        for one in pair.headlines
    ]  # fmt: skip
    heads = (
        "robots", "headline number", "second − first", "failures with people, second − first", "p",
        "adversarialness, second − first", "",
    )  # fmt: skip
    title = "<h2>Do people fail more with the robot that measures worse?</h2>"
    return f"{title}{_list(order_lines(order))}{table(heads, rows, text=(1, 6)) if rows else ''}"


def _questionnaire(judged: Judged, figure: str) -> str:
    caption = _PREFERENCE if judged.question == "correspondence" else _SCORES
    parts = [
        f"<h2>{safe(QUESTIONS[judged.question].capitalize())} · {safe(judged.pairs)}</h2>",
        _list(judged_lines(judged)),
        f"<figure>{figure}<figcaption>{safe(caption)}</figcaption></figure>",
    ]
    fits = [
        (label, found.model)
        for label, found in (("everybody", judged.everybody), ("attentive", judged.attentive))
        if isinstance(found, ScoreFindings)
    ]
    if fits:
        parts.append(f"<h3>Cumulative logit mixed model</h3>{_models(fits)}")
    return "\n".join(parts)


def _models(fits: Iterable[tuple[str, OrdinalFit]]) -> str:
    rows = []
    for label, fit in fits:
        slopes = [
            _number(fit.slopes[axis].log_odds, fit.slopes[axis].interval)
            if fit.slopes
            else _UNKNOWN
            for axis in AXES
        ]
        spread = [_number(fit.deviations.get(name)) for name in ("rater", "pair", "episode")]
        rows.append([
            label, *slopes, *spread, _number(fit.r_hat, form=".3f"), _number(fit.ess, form=".0f"),
            safe(fit.refused or ""),
        ])  # fmt: skip
    heads = (
        "", *(f"slope on {axis}" for axis in AXES), "sd of raters", "of pairs", "of episodes",
        "R-hat", "effective samples", "refused",
    )  # fmt: skip
    return table(heads, rows, text=(8,))


def _list(lines: Sequence[str]) -> str:
    if not lines:
        return '<p class="facts">Nothing yet.</p>'
    return f'<ul class="findings">{"".join(f"<li>{safe(line)}.</li>" for line in lines)}</ul>'


def _number(
    value: float | None, interval: tuple[float, float] | None = None, form: str = ".2f"
) -> str:
    if value is None:
        return _UNKNOWN
    shown = f"{value:{form}}"
    if interval is None:
        return shown
    return f"{shown}<small>{safe(spoken_interval(Interval(*interval), form))}</small>"
