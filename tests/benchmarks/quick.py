"""A study from its command line, small."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]


def quick_run(study: str, out: Path, *more: str) -> subprocess.CompletedProcess[str]:
    """`python -m benchmarks.STUDY --quick` into `out`, with `more` options."""
    command = [sys.executable, "-m", f"benchmarks.{study}", "--quick", "--out", str(out), *more]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
