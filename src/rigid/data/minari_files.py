"""Episodes to and from Minari (Younis et al., 2024), one agent at a time.

A Minari dataset is of one agent: T + 1 observations, T actions and T rewards an episode. Features
lie in its `infos`, consent, licence, task and notes in its metadata, so that none of it is lost.
`pip install "rigid-frontier[minari]"`.
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from gymnasium import spaces
from jaxtyping import Float

from rigid.data.episodes import CanonicalEpisodes, beside
from rigid.errors import UserError
from rigid.policies.native import Agent

PREFIX = "minari:"
OWN = "rigid"
"""Name of RIGID's entry in the metadata of a dataset."""


class View(NamedTuple):
    """Episodes as one agent lived them."""

    agent: Agent
    observations: Float[np.ndarray, "E T1 o"]
    """Before each step, and after the last one."""
    actions: Float[np.ndarray, "E T a"]
    rewards: Float[np.ndarray, "E T"]
    features: Float[np.ndarray, "E T1 f"]
    """After the reset (NaN where nobody knows) and after each step."""
    remarks: Mapping[str, str]
    """What of it was not recorded, and what stands there."""


def known_to_file(episodes: CanonicalEpisodes, where: Path) -> View:
    """The human's view, from what its file holds alone.

    Raises:
        UserError: Nobody recorded observations and actions.
    """
    if episodes.observations is None or episodes.actions is None:
        raise UserError(
            f"{where} holds no observations and actions of the human, of which a Minari dataset is "
            "made: export it with --to csv"
        )
    seen, missing = episodes.observations, np.full_like(episodes.features[:, :1], np.nan)
    remarks = {"last_observation": "the one before it, since nobody recorded it"}
    rewards = episodes.rewards
    if rewards is None:
        rewards = np.zeros(episodes.features.shape[:2], np.float32)
        rewards[:, -1] = episodes.returns
        remarks["rewards"] = "the return at the last step, since nobody recorded rewards"
    return View(
        "human", np.concatenate([seen, seen[:, -1:]], axis=1), episodes.actions, rewards,
        np.concatenate([missing, episodes.features], axis=1), remarks,
    )  # fmt: skip


def write_minari(episodes: CanonicalEpisodes, view: View, out: str) -> Path:
    """Writes a dataset of one agent.

    Args:
        episodes: What the view is of.
        view: What the agent saw and did.
        out: A new directory, or `minari:ID` for the place where `minari.load_dataset` looks.

    Returns:
        Directory of the dataset; `minari.MinariDataset(directory / "data")` opens it.

    Raises:
        UserError: Minari is not installed, there is something at `out`, or its name is no id.
    """
    minari = installed_minari()
    directory, name = _place(out)
    if directory.exists():
        raise UserError(f"{directory} exists already: choose a new directory with --out")
    # Absolute, since Minari counts the bytes of its files by names that it joins twice.
    directory.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=directory.parent.absolute(), prefix=".") as scratch:
        _fill(minari, Path(scratch) / "data", episodes, view, name)
        (Path(scratch) / "data").rename(_made(directory) / "data")
    return directory


def _made(directory: Path) -> Path:
    directory.mkdir()
    return directory


def _fill(
    minari: ModuleType, data: Path, episodes: CanonicalEpisodes, view: View, name: str
) -> None:
    from minari.data_collector.episode_buffer import EpisodeBuffer
    from minari.dataset.minari_storage import MinariStorage

    storage = MinariStorage.new(
        data, observation_space=_box(view.observations), action_space=_actions(view)
    )
    about = episodes.about
    storage.update_metadata({
        "dataset_id": name, "minari_version": minari.__version__,
        "algorithm_name": f"{episodes.source} ({view.agent})",
        "description": f"Task {episodes.task.get('name')}, the {view.agent}'s view. "
                       f"Licence: {about.licence or 'unknown'}. "
                       f"Consent: {about.consent or 'unknown'}.",
        OWN: {**beside(episodes), "agent": view.agent, "remarks": dict(view.remarks)},
    })  # fmt: skip
    count, steps = episodes.features.shape[:2]
    ends = np.arange(steps) == steps - 1
    storage.update_episodes([
        EpisodeBuffer(
            id=i, seed=int(episodes.seeds[i]), observations=view.observations[i],
            actions=view.actions[i], rewards=view.rewards[i],
            terminations=np.zeros(steps, dtype=bool), truncations=ends,
            infos={"features": view.features[i]} if view.features.shape[2] else {},
        )
        for i in range(count)
    ])  # fmt: skip
    storage.update_episode_metadata(_notes(episodes, i) for i in range(count))


def installed_minari() -> ModuleType:
    """Minari.

    Raises:
        UserError: It is not installed.
    """
    try:
        import h5py  # noqa: F401 - Asked for now: Minari misses it only in the middle of its work.
        import minari
    except ImportError:
        raise UserError('Minari is not installed: `pip install "rigid-frontier[minari]"`') from None
    module: ModuleType = minari
    return module


def _place(out: str) -> tuple[Path, str]:
    from minari.dataset.minari_dataset import parse_dataset_id
    from minari.storage.datasets_root_dir import get_dataset_path

    name = out.removeprefix(PREFIX) if out.startswith(PREFIX) else Path(out).name
    try:
        parse_dataset_id(name)
    except (ValueError, TypeError):  # TypeError: it has no version.
        raise UserError(
            f"--out {out!r}: {name!r} is no id of a Minari dataset: end it in a version, as in "
            f"{name or 'people'}-v0"
        ) from None
    return (get_dataset_path(name) if out.startswith(PREFIX) else Path(out)), name


def _box(rows: Float[np.ndarray, "E T o"]) -> spaces.Box:
    return spaces.Box(-np.inf, np.inf, rows.shape[2:], np.float32)


def _actions(view: View) -> spaces.Box:
    return spaces.Box(-1.0, 1.0, view.actions.shape[2:], np.float32)


def _notes(episodes: CanonicalEpisodes, index: int) -> dict[str, Any]:
    """What is told of one episode, as HDF5 keeps it."""
    notes = episodes.about.episodes
    told: dict[str, Any] = notes[index].model_dump() if notes else {}
    for name, value in (("return", episodes.returns[index]), ("success", episodes.success[index])):
        if np.isfinite(value):
            told[name] = float(value)
    return told
