"""`rigid` as in the documentation, so small that a page of it runs in a minute.

Presets keep their names and train for two iterations; numbers of iterations and episodes that a
command line names are cut. All else is what a reader gets.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import replace

from rigid import presets
from rigid.cli import main

CUT = {"--iterations": "1", "--population-iterations": "1", "--episodes": "12"}
"""Options whose values are replaced; 12 episodes are the fewest that a human is cloned from."""
ADDED = {
    "train co-optimize": ("--iterations", "1"),
    "train vanilla": ("--iterations", "1", "--episodes", "5"),
    "train gleave": ("--iterations", "1", "--population-iterations", "1", "--episodes", "5"),
    "train palm": ("--iterations", "1", "--episodes", "5"),
    "study pilot": ("--participants", "1", "--speed", "20"),
    "study power": ("--simulations", "20"),
    "train robust-gt": ("--iterations", "1", "--episodes", "5"),
}
"""What is added to commands that do not name it."""
SIZES = {
    "iterations": 2, "episodes": 4, "scoring_episodes": 6, "referee_episodes": 5,
    "validation_episodes": 3, "search_canonical": 4, "referee_canonical": 4,
}  # fmt: skip


def shrink_presets() -> None:
    """Makes every preset of this process small; seeds are the first two."""
    for name, preset in presets.PRESETS.items():
        presets.PRESETS[name] = replace(
            preset, seeds=preset.seeds[:2], per_round=(3,), sharing=None, **SIZES
        )


def cut(arguments: Sequence[str]) -> list[str]:
    """A command line with less to do.

    Example:
        >>> cut(["train", "vanilla", "--pair", "p", "--out", "r", "--iterations", "30"])
        ['train', 'vanilla', '--pair', 'p', '--out', 'r', '--iterations', '1', '--episodes', '5']
    """
    found = list(arguments)
    for place, word in enumerate(found[:-1]):
        found[place + 1] = CUT.get(word, found[place + 1])
    more = ADDED.get(" ".join(found[:2]), ())
    for option, value in zip(more[::2], more[1::2], strict=True):
        found += [] if option in found else [option, value]
    return found


if __name__ == "__main__":
    shrink_presets()
    sys.argv[1:] = cut(sys.argv[1:])
    main()
