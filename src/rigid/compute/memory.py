"""How much memory a process has taken."""

from __future__ import annotations

from pathlib import Path


def peak_memory() -> float:
    """Largest resident memory of this process since its program began [MB].

    Not `ru_maxrss`: on Linux that of a new program begins at what the process that started it had
    used by then.
    """
    status = Path("/proc/self/status").read_text(encoding="utf-8")
    (line,) = [line for line in status.splitlines() if line.startswith("VmHWM:")]
    return int(line.split()[1]) / 1024
