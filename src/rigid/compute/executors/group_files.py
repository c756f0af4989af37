"""The files of one group in a run directory, as bytes: how it travels between machines."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

from rigid.compute.search.group_plan import GroupPlan, checkpoint_of
from rigid.files import write_atomically


def read_group(directory: Path, plan: GroupPlan) -> dict[str, bytes]:
    """Everything that a group has left so far, by its path in the run directory."""
    return {
        path.relative_to(directory).as_posix(): path.read_bytes()
        for pattern in _patterns(plan)
        for path in sorted(directory.glob(pattern))
    }


def read_begun(directory: Path, plan: GroupPlan) -> dict[str, bytes]:
    """What a group that was interrupted goes on from; nothing where it has no checkpoint."""
    return read_group(directory, plan) if checkpoint_of(directory, plan).exists() else {}


def write_group(directory: Path, plan: GroupPlan, files: Mapping[str, bytes]) -> None:
    """Writes a group; of one that is done, what says so comes last, so that it holds at any time.

    A checkpoint that is not among `files` goes: the group is past it.
    """
    last = f"groups/{plan.name}.json"
    for name in sorted(files, key=lambda name: (name == last, name)):
        path = directory / name
        path.parent.mkdir(parents=True, exist_ok=True)
        write_atomically(path, files[name])
    checkpoint = checkpoint_of(directory, plan)
    if checkpoint.relative_to(directory).as_posix() not in files:
        checkpoint.unlink(missing_ok=True)


def _patterns(plan: GroupPlan) -> Iterator[str]:
    """Names with a leading dot are of writes that were cut off; no pattern matches them."""
    yield f"groups/{plan.name}.[!p]*"  # Progress is of one process and one moment.
    for index in range(len(plan.lambdas)):
        yield f"adversaries/{plan.member(index)}/[!.]*"
        yield f"referee/{plan.member(index)}.*"
