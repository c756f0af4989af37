"""What `rigid bench` prints: every figure with its spread, and how it stands to the last run's."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

_SHOWN = (
    ("physics_env_steps_per_s", "MuJoCo alone", "env steps/s"),
    ("training_env_steps_per_s", "adversary training", "env steps/s"),
    ("training_over_physics", "training over physics", ""),
    ("discriminator_updates_per_s", "discriminator", "updates/s"),
    ("referee_s", "referees of one group", "s"),
    ("report_s", "report of a small run", "s"),
    ("startup_s", "rigid --help", "s"),
    ("paper_core_hours", "preset paper", "core-hours (the paper says 648)"),
    ("standard_wall_s", "preset standard", "s"),
)
_MAKERS = ("processor", "cores", "system", "python", "mujoco", "jax")
"""What of `machine` moves figures for good; its load moves them for a while."""


def speed_table(found: Mapping[str, Any], before: Mapping[str, Any]) -> str:
    """The figures of a run.

    Args:
        found: What `rigid bench --json` writes.
        before: The same of the last run; empty where there is none.
    """
    lines = [_where(found), ""]
    for key, label, unit in _SHOWN:
        lines.append(f"{label:24}{_figure(found, key, unit)}{_beside(found[key], before.get(key))}")
    lines += ["", _budget(found)]
    if found["assistive_gym"] is not None:
        lines += ["", _assistive_gym(found["assistive_gym"], _physics(found))]
    different = other_makers(before, found)
    if different:
        why = "; ".join(different)
        lines += [
            "",
            f"the last run was made with other things, and ratios to it mix them in: {why}",
        ]
    return "\n".join(lines)


def other_makers(before: Mapping[str, Any], found: Mapping[str, Any]) -> list[str]:
    """In what machine and versions of two runs differ; only what both say counts.

    Example:
        >>> other_makers({"rigid": "1.0", "machine": {"jax": "1"}}, {"machine": {"jax": "2"}})
        ['jax 1 then, 2 now']
    """
    old, new = _makers(before), _makers(found)
    return [
        f"{name} {old[name]} then, {new[name]} now"
        for name in new
        if name in old and old[name] != new[name]
    ]


def _makers(run: Mapping[str, Any]) -> dict[str, Any]:
    own = {key: run[key] for key in ("rigid", "threads", "physics_step", "substeps") if key in run}
    machine = run.get("machine")
    if isinstance(machine, Mapping):
        own |= {key: machine[key] for key in _MAKERS if key in machine}
    return own


def _where(found: Mapping[str, Any]) -> str:
    machine = found["machine"]
    return (
        f"itch scratching, {_physics(found)}; {machine['processor']}, threads: {found['threads']}, "
        f"load {machine['load']}; medians of {found['repeats']} turns [quartiles]"
    )


def _physics(found: Mapping[str, Any]) -> str:
    return f"physics {found['physics_step']:g} s × {found['substeps']}"


def _figure(found: Mapping[str, Any], key: str, unit: str) -> str:
    value = found[key]
    if value is None:
        return "not measured"
    if unit == "env steps/s":
        unit += f" at {_physics(found)}"
    spread = found["spread"].get(key)
    between = "" if spread is None else f" [{spread[0]:,}, {spread[1]:,}]"
    return f"{value:,}{between} {unit}".rstrip()


def _beside(value: float | None, old: object) -> str:
    """How a figure stands to the last run's."""
    if not isinstance(old, int | float) or value is None:
        return ""
    ratio = "" if old == 0 else f", now × {value / old:.2f}"
    return f"   (last run: {old:,}{ratio})"


def _budget(found: Mapping[str, Any]) -> str:
    """Where the time of one environment step of training goes."""
    parts, spread = found["budget_per_env_step_us"], found["spread"]["budget_per_env_step_us"]
    rows = [
        f"  {name.replace('_', ' '):24}{value:8.2f}  [{spread[name][0]:.2f}, {spread[name][1]:.2f}]"
        for name, value in parts.items()
    ]
    return "\n".join([f"µs per env step of training, {_physics(found)}", *rows])


def _assistive_gym(rows: Mapping[str, Any], physics: str) -> str:
    title = f"env steps per second of one core at {rows['control_hz']:g} Hz, {physics}"
    lines = [f"{title}; Assistive Gym's were measured elsewhere, not in this run"]
    for name, label in (("stepping", "stepping alone"), ("with_resets", "with resets")):
        row = rows[name]
        low, high = row["spread"]
        lines.append(
            f"  {label:22}{row['ours']:,} [{low:,}, {high:,}], Assistive Gym {row['theirs']:g}: "
            f"× {row['ratio']:g}"
        )
    return "\n".join(lines)


def growth_table(growth: Mapping[str, Any]) -> str:
    """What grows with what, and what twice the λ cost."""
    base = ", ".join(f"{name} {size}" for name, size in growth["base"].items())
    lines = ["", f"growth of a small measurement; what does not double stays at {base}", ""]
    lines.append(f"{'':12}{'size':>6}{'peak MB':>10}{'compiling':>11}{'s':>9}")
    for row in growth["rows"]:
        for number, size in enumerate(row["sizes"]):
            name = row["axis"] if number == 0 else ""
            memory, compiling = row["peak_mb"][number], row["compiling_mb"][number]
            seconds = row["seconds"][number]
            lines.append(f"{name:12}{size:6}{memory:10.1f}{compiling:11.1f}{seconds:9.2f}")
        lines.append(f"{'':12}{_slopes(row)}")
    for name, row in growth["twice_the_lambdas"].items():
        lines.append(_twice(name, row))
    return "\n".join(lines)


def _slopes(row: Mapping[str, Any]) -> str:
    text = (
        f"per unit {row['mb_per_unit']:g} MB, {row['seconds_per_unit']:g} s; "
        f"exponents {row['memory_exponent']:g}, {row['time_exponent']:g}"
    )
    if not row["must_be_flat"]:
        return text
    return text + ("; memory is flat" if row["is_flat"] else "; MEMORY GROWS, BUT MUST NOT")


def _twice(name: str, row: Mapping[str, Any]) -> str:
    few, many = row["lambdas"]
    limit = row["must_be_at_most"]
    wanted = "" if limit is None else f", at most {limit:g} wanted"
    return (
        f"time of {many} λ over {few}, preset {name}: {row['ratio']:g}{wanted} "
        f"(training alone {row['training_ratio']:g})"
    )
