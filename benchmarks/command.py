"""How a study is started: its exit codes are those of `rigid`."""

from __future__ import annotations

import sys
from collections.abc import Callable

from rigid.commands.parsing import printable
from rigid.errors import UserError

INTERRUPTED = 130


def exit_code(name: str, work: Callable[[], None]) -> int:
    """Runs a study: 0 done, 2 bad input, 130 interrupted; says why in one line.

    Example:
        >>> exit_code("study", lambda: None)
        0
    """
    try:
        work()
    except UserError as error:
        print(f"{name}: {printable(str(error))}", file=sys.stderr)
        return error.exit_code
    except KeyboardInterrupt:
        print(f"\n{name}: interrupted; the same command goes on", file=sys.stderr)
        return INTERRUPTED
    return 0
