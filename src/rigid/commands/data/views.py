"""Which views of episodes `rigid data export` writes, and where."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rigid.errors import UserError

if TYPE_CHECKING:
    from rigid.commands.data.exporting import ExportCommand
    from rigid.data.episodes import CanonicalEpisodes
    from rigid.data.minari_files import View
    from rigid.tasks.protocol import Step, Task


def export(command: ExportCommand) -> str:
    """Writes what the command asks for; returns what to print.

    Raises:
        UserError: The file is damaged, lacks what the view needs, or the place is taken.
    """
    from rigid.data.episodes import load_episodes
    from rigid.data.minari_files import known_to_file, write_minari

    episodes = load_episodes(command.file, task=None)
    if command.to == "csv":
        return _csv(command, episodes)
    if command.robot is not None:
        view = _again(command, episodes)
    elif command.agent == "robot":
        raise UserError(
            f"{command.file} holds what the human saw and did: name the robot that it met with "
            "--robot, which then plays the episodes again"
        )
    else:
        view = known_to_file(episodes, command.file)
    directory = write_minari(episodes, view, command.out)
    said = "".join(f"\n{name}: {text}" for name, text in view.remarks.items())
    return (
        f"{len(episodes)} episodes, the {view.agent}'s view: {directory}\n"
        f'opens as minari.MinariDataset("{directory / "data"}"){said}'
    )


def _csv(command: ExportCommand, episodes: CanonicalEpisodes) -> str:
    from rigid.data.csv_files import beside_csv, write_csv
    from rigid.files import make_room, writing_to

    out = Path(command.out)
    make_room(out)
    for path in (out, beside_csv(out)):
        if path.exists():
            raise UserError(f"{path} exists already: choose a new file with --out")
    with writing_to(out):
        write_csv(episodes, out)
    return f"{len(episodes)} episodes: {out}, and what a table has no room for: {beside_csv(out)}"


def _again(command: ExportCommand, episodes: CanonicalEpisodes) -> View:
    """A view of the episodes as they are played again."""
    from rigid.compute.people.completing import complete
    from rigid.compute.people.recorded import play_again
    from rigid.data.minari_files import View
    from rigid.policies.discrete import taken
    from rigid.policies.loading import load_policy
    from rigid.policies.opening import Opening

    assert command.robot is not None
    task = _task(command, episodes)
    opening = Opening(trust=command.trust)
    robot = load_policy(command.robot, task=task, agent="robot", opening=opening)
    same = complete(task, robot, episodes, where=command.file).same
    if not same.all():
        raise UserError(
            f"{int((~same).sum())} of {len(same)} episodes of {command.file} do not come out again "
            f"with {command.robot}: name the robot that they were recorded with"
        )
    ends: list[tuple[np.ndarray, np.ndarray]] = []

    def watch(number: int, step: Step) -> None:
        if number in {0, task.horizon}:
            ends.append((task.features(step), getattr(step, f"{command.agent}_observation")))

    played = play_again(task, robot, episodes, where=command.file, watch=watch)
    (begun, _), (_, ended) = ends
    human = command.agent == "human"
    seen = played.human_observation if human else played.robot_observation
    done = played.human_action if human else played.robot_action
    done = taken(done, task.human if human else task.robot)
    seen, done, reward = (array.swapaxes(0, 1) for array in (seen, done, played.reward))
    if human:  # What was recorded stands, to its last digit.
        seen = seen if episodes.observations is None else episodes.observations
        done = done if episodes.actions is None else episodes.actions
    features = np.concatenate([begun[:, np.newaxis], episodes.features], axis=1)
    rows = np.concatenate([seen, ended[:, np.newaxis]], axis=1)
    return View(
        command.agent, rows.astype(np.float32), done, reward if episodes.rewards is None
        else episodes.rewards, features.astype(np.float32), {},
    )  # fmt: skip


def _task(command: ExportCommand, episodes: CanonicalEpisodes) -> Task:
    from rigid.data.checks import check_task
    from rigid.tasks.registry import make_task, task_from_description

    task = None if command.task is not None else task_from_description(episodes.task)
    if task is None:
        name = command.task or str(episodes.task.get("name"))
        if command.task is None and ":" in name:  # As `exec:COMMAND`, by whoever made the file.
            raise UserError(
                f"{command.file} names its task {name!r}, which would run code: if you trust "
                "whoever made the file, say so with --task"
            )
        task = make_task(name)
    check_task(episodes.task, episodes.feature_names, task, where=command.file)
    return task
