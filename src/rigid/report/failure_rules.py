"""What went wrong in an episode: one kind of failure, by few rules in a fixed order.

The paper shows failures one by one (appendix 'More Visualizations of Robot Failure Cases'); kinds
are ours. `RULES` lists them: the first rule that holds names the failure, so that what hurts comes
first, then what no robot could help, then what the robot did. All limits are ours; they were set on
adversaries of `builtin:vanilla`, whose canonical play lies far from each of them.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, NamedTuple

import numpy as np
from jaxtyping import Bool, Float

from rigid.report.episodes import Arm, Episode, arm_of
from rigid.report.failure_kinds import Kind
from rigid.report.payload import Failure

AT_ITCH: Final = 0.035
"""Tip and itch so near that it can scratch [m]: 2.5 cm, within which a contact counts (Assistive
Gym), and the tip's radius of 1 cm."""
SPOT: Final = 0.025
"""A contact farther than this from the itch cannot count [m] (Assistive Gym)."""
LONG: Final = 0.25
"""Share of an episode that makes a mode: a quarter of 10 s, as long as the 25 counted contacts take
that would have helped."""
BEGUN: Final = 5
"""Counted contacts from which on the robot had found the itch: a fifth of the 25 that help."""
SPILLED: Final = 3
"""Fallen pieces of food from which on no robot can help: it takes 6 of 8."""
RESTLESS: Final = 1.5
"""The tip's way over that of canonical play from the same start. Canonical ways to one itch differ
by 3 % from start to start; robots that swing about go 1.6 to 2.7 times as far."""
BRISK: Final = 0.1
"""No robot thrashes below this mean speed [m/s]: canonical play has 0.16 to 0.19, and a robot that
fails canonically may have next to none."""
STILL: Final = 0.05
"""The tip hardly moves within this distance of its mean place [m]; in canonical play it leaves it
by 0.13 to 0.24, since the itch moves."""
STRAYED: Final = 0.3
"""So much farther from the itch than at the start [m]: at the start it is 0.12 to 0.27."""
SLACK: Final = 0.05
"""So much farther from the robot than canonical play ever brings the itch [m]: by 0.03 canonical
episodes differ among themselves."""


class Found(NamedTuple):
    """A rule that holds."""

    frame: int
    """When it showed."""
    says: str
    part: str | None = None
    """Of the person, where kinds are told apart by it."""


Rule = Callable[[Episode, Episode | None], Found | None]


def classify(episode: Episode | None, canonical: Episode | None) -> Failure | None:
    """What went wrong; None for a helped episode, and for one that tells too little.

    Args:
        episode: Of the human who is judged.
        canonical: Canonical play from the same start; None where there is none: rules that need it
            then never hold.
    """
    if episode is None or episode.outcome not in {"unhelped", "unwanted_contact"}:
        return None
    for kind, rule in RULES:
        found = rule(episode, canonical)
        if found is not None:
            return {
                "kind": kind,
                "part": found.part,
                "frame": found.frame,
                "time": round(found.frame * episode.dt, 3),
                "says": found.says,
            }
    raise AssertionError("the last rule always holds")


def _unwanted_contact(episode: Episode, _: Episode | None) -> Found | None:
    """By the task's own outcome; what touched what is read where the force is greatest."""
    if episode.outcome != "unwanted_contact":
        return None
    contacts, forces = episode.contacts, episode.force_unwanted
    hits = np.flatnonzero(contacts.unwanted)
    if not len(hits):
        return Found(int(np.argmax(forces)), "a touch too brief for the replay to show")
    if forces.max() > 0:  # Else at the hardest contact that is known.
        late = np.abs(contacts.frame[hits] - np.argmax(forces))
        hits = hits[late == late.min()]
    hardest = hits[np.argmax(contacts.force[hits])]
    force = forces.max() or contacts.force[hardest]
    robot = episode.name(int(contacts.robot[hardest])) or "robot"
    part = episode.name(int(contacts.person[hardest]))
    said = f"the {robot} touched the {part or 'person'}, at its hardest with {force:.1f} N"
    return Found(int(contacts.frame[hardest]), said, part)


def _out_of_reach(episode: Episode, canonical: Episode | None) -> Found | None:
    arm = None if canonical is None else arm_of([episode, canonical])
    if arm is None:
        return None
    gap = _gap(episode, arm)
    beyond = gap > arm.length
    if np.mean(beyond) < 0.5:
        return None
    return Found(
        _first(beyond),
        f"the {episode.goal} was up to {gap.max():.2f} m from the robot's shoulder; its arm "
        f"reaches {arm.length:.2f} m",
    )


def _thrashing(episode: Episode, canonical: Episode | None) -> Found | None:
    if canonical is None:
        return None
    steps, usual = _steps(episode), _steps(canonical).sum()
    brisk = BRISK * len(steps) * episode.dt
    if steps.sum() <= max(RESTLESS * usual, brisk):
        return None
    return Found(
        int(np.argmax(steps)) + 1,  # At its fastest.
        f"the tool went {steps.sum():.1f} m (canonical play: {usual:.1f} m), and was up to "
        f"{_length(episode.distance.max())} from the {episode.goal}",
    )


def _spilled(episode: Episode, _: Episode | None) -> Found | None:
    if episode.spilled is None or episode.spilled[-1] < SPILLED:
        return None
    frame = _first(episode.spilled >= SPILLED)
    return Found(
        frame,
        f"{episode.spilled[-1]:.0f} pieces of food fell, the third when the tool was "
        f"{_length(episode.distance[frame])} from the {episode.goal}",
    )


def _lost_contact(episode: Episode, _: Episode | None) -> Found | None:
    if episode.counted is None:
        return None
    total = int(episode.counted[-1])
    if total < BEGUN:
        return None
    last = _first(episode.counted == total)
    rest = episode.distance[last + 1 :]
    if len(rest) < LONG * episode.frames or np.mean(rest < AT_ITCH) >= 0.5:
        return None
    return Found(
        last,
        f"{total} counted contacts and none after {last * episode.dt:.1f} s: from then on the tool "
        f"was {_length(np.median(rest))} from the itch",
    )


def _wrong_limb(episode: Episode, _: Episode | None) -> Found | None:
    return _elsewhere(episode, itching=False)


def _missed_spot(episode: Episode, _: Episode | None) -> Found | None:
    return _elsewhere(episode, itching=True)


def _elsewhere(episode: Episode, *, itching: bool) -> Found | None:
    """Touches the arms, but not at the itch, on the limb that itches or on the others."""
    if episode.counted is None:
        return None
    contacts = episode.contacts
    gap = np.linalg.norm(contacts.place - episode.itch[contacts.frame], axis=1)
    off = ~contacts.unwanted & (gap > SPOT) & (episode.distance[contacts.frame] >= AT_ITCH)
    here = off & ((contacts.person == episode.itching) == itching)
    frames, others = np.unique(contacts.frame[here]), np.unique(contacts.frame[off & ~here])
    if len(frames) < max(LONG * episode.frames, len(others)):
        return None
    touched = episode.name(int(np.bincount(contacts.person[here] + 1).argmax()) - 1) or "person"
    where = (
        f"{_length(np.median(gap[here]))} from the itch" if itching
        else f"but the itch was on the {episode.name(episode.itching)}"
    )  # fmt: skip
    seconds = len(frames) * episode.dt
    return Found(int(frames[0]), f"it touched the {touched} for {seconds:.1f} s, {where}")


def _too_little(episode: Episode, _: Episode | None) -> Found | None:
    near = episode.distance < AT_ITCH
    if episode.counted is None or np.mean(near) < LONG:
        return None
    seconds, total = near.sum() * episode.dt, int(episode.counted[-1])
    return Found(_first(near), f"at the itch for {seconds:.1f} s, but {total} contacts counted")


def _stuck(episode: Episode, _: Episode | None) -> Found | None:
    half = episode.frames // 2
    away = np.linalg.norm(episode.tip - episode.tip[half:].mean(axis=0), axis=1) > STILL
    if away[half:].any():
        return None
    since = episode.frames - _first(away[::-1]) if away.any() else 0
    gap = np.median(episode.distance[since:])
    return Found(
        since,
        f"the tool hardly moved from {since * episode.dt:.1f} s on, {_length(gap)} from the "
        f"{episode.goal}",
    )


def _strayed(episode: Episode, _: Episode | None) -> Found | None:
    farther = episode.distance - episode.distance[0]
    tool, itch = (np.linalg.norm(path[-1] - path[0]) for path in (episode.tip, episode.itch))
    if farther[-1] <= STRAYED or tool <= itch:
        return None
    return Found(
        _first(farther > STRAYED),
        f"the tool ended {_length(episode.distance[-1])} from the {episode.goal}, which had moved "
        f"by {_length(itch)}",
    )


def _kept_away(episode: Episode, canonical: Episode | None) -> Found | None:
    arm = None if canonical is None else arm_of([episode, canonical])
    if arm is None or canonical is None:
        return None
    gap, usual = _gap(episode, arm), _gap(canonical, arm).max()
    beyond = gap > usual + SLACK
    if np.mean(beyond) < 0.5:
        return None
    return Found(
        _first(beyond),
        f"the {episode.goal} was up to {_length(gap.max())} from the robot's shoulder, in "
        f"canonical play up to {_length(usual)}",
    )


def _unclear(episode: Episode, _: Episode | None) -> Found:
    nearest = int(np.argmin(episode.distance))
    said = (
        f"the tool came no nearer to the {episode.goal} than {_length(episode.distance[nearest])}"
    )
    return Found(nearest, said)


RULES: Final[tuple[tuple[Kind, Rule], ...]] = (
    ("unwanted_contact", _unwanted_contact),
    ("out_of_reach", _out_of_reach),
    ("spilled", _spilled),
    ("thrashing", _thrashing),
    ("lost_contact", _lost_contact),
    ("wrong_limb", _wrong_limb),
    ("missed_spot", _missed_spot),
    ("too_little", _too_little),
    ("stuck", _stuck),
    ("strayed", _strayed),
    ("kept_away", _kept_away),
    ("unclear", _unclear),
)


def _gap(episode: Episode, arm: Arm) -> Float[np.ndarray, " F"]:
    """Itch to the robot's shoulder [m]."""
    gap: np.ndarray = np.linalg.norm(episode.itch - arm.shoulder, axis=1)
    return gap


def _steps(episode: Episode) -> Float[np.ndarray, " F1"]:
    """How far the tip goes from frame to frame [m]."""
    steps: np.ndarray = np.linalg.norm(np.diff(episode.tip, axis=0), axis=1)
    return steps


def _first(holds: Bool[np.ndarray, " n"]) -> int:
    return int(np.argmax(holds))


def _length(metres: float | np.floating) -> str:
    """In words for readers: centimetres below a metre.

    Example:
        >>> _length(0.064), _length(1.432)
        ('6 cm', '1.4 m')
    """
    return f"{metres:.1f} m" if metres >= 0.995 else f"{100 * metres:.0f} cm"
