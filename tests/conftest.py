"""Settings of the whole suite, made before anything imports jax; subprocesses inherit them."""

import os
import secrets
from pathlib import Path

from hypothesis import settings

_CACHE = Path(__file__).parents[1] / ".cache" / "jax"

os.environ.setdefault("JAX_PLATFORMS", "cpu")  # The same numbers with and without a GPU.
os.environ.setdefault("JAX_COMPILATION_CACHE_DIR", str(_CACHE))
os.environ.setdefault("JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS", "0.1")  # [s]
os.environ.setdefault("PJRT_NPROC", "1")  # The same sums on any number of cores, as in commands.
# Small computations, of which the suite compiles thousands: a third less time in all.
os.environ.setdefault("JAX_DISABLE_MOST_OPTIMIZATIONS", "1")
# XLA's newer way to compile fused loops for processors: without it they take half the time.
os.environ.setdefault("XLA_FLAGS", "--xla_cpu_use_fusion_emitters=false")
# (n,) + (n, 1) is a mistake more often than an outer sum. Dtypes are not strict: optax mixes them.
os.environ.setdefault("JAX_NUMPY_RANK_PROMOTION", "raise")

# Ray reads them once. Nobody else in the network may run code in the clusters of the suite.
os.environ.setdefault("RAY_AUTH_MODE", "token")
os.environ.setdefault("RAY_AUTH_TOKEN", secrets.token_hex(32))
os.environ.pop("RAY_ADDRESS", None)  # A cluster of the developer's own.

# A shared machine may pause any example; the same examples every time make failures repeatable.
settings.register_profile("suite", deadline=None, derandomize=True)
settings.load_profile("suite")
