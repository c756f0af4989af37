"""What `rigid data` prints: a line for each episode, and what a file holds."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any

import numpy as np

from rigid.commands.parsing import printable
from rigid.compute.canonical import FEWEST
from rigid.data.episodes import CanonicalEpisodes, data_hash
from rigid.data.judging import Verdict

_SHOWN = 40
"""Lines of sound episodes that a terminal is shown; bad ones all are. Ours."""


def print_verdicts(verdicts: Sequence[Verdict]) -> None:
    """A line for each episode: what it is, whether it is used, and why not."""
    width = max((len(verdict.episode) for verdict in verdicts), default=7)
    width = min(max(width, len("episode")), 32)
    print(f"{'episode':{width}}  {'participant':12} {'rows':>6} {'seconds':>8}  verdict")
    shown = 0
    for verdict in verdicts:
        shown += verdict.used
        if verdict.used and shown > _SHOWN and not verdict.remark:
            continue
        seconds = "" if verdict.seconds is None else f"{verdict.seconds:.2f}"
        said = verdict.remark or "good" if verdict.used else f"LEFT OUT: {verdict.reason}"
        name, who = printable(verdict.episode)[:width], printable(verdict.participant)[:12]
        print(f"{name:{width}}  {who:12} {verdict.rows:6} {seconds:>8}  {printable(said)}")
    if shown > _SHOWN:
        print(f"… and {shown - _SHOWN} more good ones")


def too_few(episodes: int) -> str | None:
    """What is wrong with so few episodes."""
    if episodes >= FEWEST:
        return None
    return (
        f"{episodes} episodes are too few for a measurement: the referee needs {FEWEST}, and says "
        "more with 40"
    )


def described(episodes: CanonicalEpisodes) -> dict[str, Any]:
    """What a file holds, as JSON."""
    about = episodes.about
    met = Counter(note.participant for note in about.episodes)
    low, high = (
        reduced(episodes.features, axis=(0, 1)) if episodes.features.size else np.zeros(0)
        for reduced in (np.min, np.max)
    )
    return {
        "task": episodes.task.get("name"), "source": episodes.source,
        "episodes": len(episodes), "steps": episodes.features.shape[1],
        "control_period": episodes.control_period, "recorded_rate": about.recorded_rate,
        "consent": about.consent, "licence": about.licence,
        "participants": {name: count for name, count in sorted(met.items()) if name},
        "devices": sorted({note.device for note in about.episodes} - {""}),
        "robots": _robots(episodes),
        "observations": _width(episodes.observations), "actions": _width(episodes.actions),
        "rewards": episodes.rewards is not None,
        "returns_known": int(np.isfinite(episodes.returns).sum()),
        "return": _mean(episodes.returns), "success": _mean(episodes.success),
        "features": {
            name: {"low": float(low[i]), "high": float(high[i]), "unit": about.units.get(name)}
            for i, name in enumerate(episodes.feature_names)
        },
        "provenance": dict(episodes.provenance), "sha256": data_hash(episodes),
    }  # fmt: skip


def print_described(found: dict[str, Any]) -> None:
    """The same for people."""
    seconds = found["steps"] * found["control_period"]
    rate = found["recorded_rate"]
    lines = {
        "task": found["task"],
        "source": _SOURCES[found["source"]],
        "episodes": f"{found['episodes']}, each of {found['steps']} steps ({seconds:g} s at "
        f"{1 / found['control_period']:g} Hz)" + (f", recorded at {rate:g} Hz" if rate else ""),
        **_who(found),
        "observations": _numbers(found["observations"]),
        "actions": _numbers(found["actions"]),
        "returns": f"{found['returns_known']} known, mean {_text(found['return'])}"
        if found["returns_known"]
        else "none known",
        "success": _text(found["success"]),
        "sha256": found["sha256"],
    }
    for name, said in lines.items():
        print(f"{name:14}{printable(str(said))}")
    print(f"{'features':14}lowest to highest; units where the task or --map tells them")
    for name, span in found["features"].items():
        line = f"  {printable(name):24} {span['low']:10.3f} to {span['high']:8.3f}"
        print(f"{line} {printable(span['unit'])}" if span["unit"] else line)


_SOURCES = {
    "synthetic": "synthetic: a policy played the human",
    "recorded": "recorded from people",
}


def _robots(episodes: CanonicalEpisodes) -> list[str]:
    """Who was met: as each episode notes it, else as whoever made the whole file says."""
    noted = sorted({note.robot for note in episodes.about.episodes} - {""})
    whole = episodes.provenance.get("robot")
    return noted or ([str(whole)] if whole else [])


def _who(found: dict[str, Any]) -> dict[str, str]:
    """Who played, and under which terms; policies consent to nothing, so they miss nothing."""
    people, human = found["participants"], found["provenance"].get("human")
    told = {
        "participants": ", ".join(f"{name} ({n})" for name, n in people.items()),
        "devices": ", ".join(found["devices"]),
        "robots": ", ".join(map(_name, found["robots"])),
        "human": _name(str(human)) if human else "",
        "consent": found["consent"] or "",
        "licence": found["licence"] or "",
    }
    people_alone = {"participants", "devices", "consent", "licence"}
    unfit = people_alone if found["source"] == "synthetic" else {"human"}
    return {name: said or "not told" for name, said in told.items() if said or name not in unfit}


def _name(player: str) -> str:
    """A player as it was called, or the first digits of its weights' hash."""
    hashed = len(player) == 64 and set(player) <= set("0123456789abcdef")
    return f"policy with SHA-256 {player[:12]}…" if hashed else player


def _numbers(width: int | None) -> str:
    if not width:
        return "none: a human cannot be cloned from this"
    return "1 number a step" if width == 1 else f"{width} numbers a step"


def _width(array: np.ndarray | None) -> int | None:
    return None if array is None else int(array.shape[2])


def _mean(values: np.ndarray) -> float | None:
    known = values[np.isfinite(values)]
    return float(known.mean()) if len(known) else None


def _text(value: float | None) -> str:
    return "unknown" if value is None else f"{value:.3f}"
