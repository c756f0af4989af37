"""From the text of a study file to a plan, or to a message for each mistake in it."""

from __future__ import annotations

import difflib
import json
import re
import string
from collections.abc import Iterator, Mapping, Sequence
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

import yaml
from pydantic import ValidationError

from rigid.errors import UserError
from rigid.files import read_bytes
from rigid.study.plan import FORMAT_VERSION, JudgeStage, Role, StudyPlan
from rigid.study.plan_mistakes import CURE, Place, dotted, mistakes

BUILTIN = "builtin:"
PROTOCOLS: Traversable = resources.files("rigid.study") / "protocols"
_LIMIT = 10_000
"""Entries of a file, with what its anchors repeat: more is no study."""


def protocol_names() -> tuple[str, ...]:
    """What `builtin:` takes, sorted."""
    return tuple(
        sorted(
            entry.name.removesuffix(".yaml")
            for entry in PROTOCOLS.iterdir()
            if entry.name.endswith(".yaml")
        )
    )


def protocol_text(name: str) -> str:
    """The file of a study that comes with RIGID.

    Raises:
        UserError: There is none of this name.
    """
    names = protocol_names()
    if name not in names:
        close = difflib.get_close_matches(name, names, n=1)
        hint = f", did you mean {BUILTIN + close[0]!r}?" if close else ";"
        listed = ", ".join(BUILTIN + known for known in names)
        raise UserError(f"study {BUILTIN + name!r} is unknown{hint} there are {listed}")
    return (PROTOCOLS / f"{name}.yaml").read_text(encoding="utf-8")


def copy_of(text: str, *, task: str | None, robots: Sequence[str]) -> str:
    """A protocol's text with another task and other robots; comments stay.

    Args:
        text: As `protocol_text` gives it, task and robots on a line each.
        task: None: the protocol's.
        robots: Named a, b and so on; none: the protocol's.
    """
    if task is not None:
        text = re.sub(
            r"^task: .*$", lambda _: f"task: {json.dumps(task)}", text, flags=re.MULTILINE
        )
    if robots:
        named = zip(string.ascii_lowercase, robots, strict=False)
        listed = ", ".join(f"{key}: {json.dumps(spec)}" for key, spec in named)
        text = re.sub(r"^robots: .*$", lambda _: f"robots: {{{listed}}}", text, flags=re.MULTILINE)
    return text


def read_plan(path: Path | str) -> StudyPlan:
    """As `rigid.study.plan.load_plan`."""
    if str(path).startswith(BUILTIN):
        text = protocol_text(str(path).removeprefix(BUILTIN))
        return parse_plan(text, where=str(path), folder=Path.cwd())
    file = Path(path)
    data = read_bytes(file, cure="copy a study to start from with `rigid study new`")
    return parse_plan(_text_of(data, file), where=str(file), folder=file.resolve().parent)


def parse_plan(text: str, *, where: str, folder: Path) -> StudyPlan:
    """The plan that a text describes.

    Args:
        text: YAML.
        where: Whose text it is; begins every message.
        folder: Where its paths begin.

    Raises:
        UserError: As `rigid.study.plan.load_plan`.
    """
    document, lines = _parsed(text, where)
    found = document.get("format", FORMAT_VERSION)
    if isinstance(found, int) and found > FORMAT_VERSION:
        raise UserError(
            f"{where} has format {found}, but this RIGID reads up to {FORMAT_VERSION}: "
            "install a newer rigid-frontier"
        )
    if "paths" in document:  # A field of the plan alone.
        raise UserError(f"{where}: line {lines['paths',]}: paths is unknown: remove it")
    try:
        plan = StudyPlan.model_validate_json(json.dumps(document, default=str))
    except ValidationError as error:
        raise UserError(mistakes(error.errors(), lines, where)) from None
    return _resolved(plan, lines, where=where, folder=folder)


def _parsed(text: str, where: str) -> tuple[dict[str, Any], dict[Place, int]]:
    loader = yaml.SafeLoader(text)
    try:
        node = loader.get_single_node()
        if not isinstance(node, yaml.MappingNode):
            raise UserError(f"{where} is no study, which begins with `title: …`: {CURE}")
        lines: dict[Place, int] = {}
        for place, line in _places(node, ()):
            if place in lines:
                raise UserError(
                    f"{where}: line {line}: {dotted(place)} stands there twice, first in line "
                    f"{lines[place]}: remove one"
                )
            lines[place] = line
            if len(lines) > _LIMIT:
                raise UserError(f"{where} has more than {_LIMIT} entries: {CURE}")
        document: dict[str, Any] = loader.construct_document(node)
    except yaml.YAMLError as error:
        raise UserError(f"{where}: {_yaml_told(error)}") from None
    except ValueError as error:  # A number or date that is none, such as 2024-13-01.
        raise UserError(f"{where}: {error}: write such a value in quotes") from None
    finally:
        loader.dispose()
    return document, lines


def _yaml_told(error: yaml.YAMLError) -> str:
    mark = getattr(error, "problem_mark", None)
    line = f"line {mark.line + 1}: " if mark is not None else ""
    problem = getattr(error, "problem", None) or str(error).splitlines()[0]
    return f"{line}this is no YAML ({problem}): mind indentation, colons and quotes"


def _places(node: yaml.Node, place: Place) -> Iterator[tuple[Place, int]]:
    """Every entry with its line, from 1."""
    if len(place) > 20:
        raise yaml.YAMLError("fields are nested too deeply, or an anchor holds itself")
    if isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            inner = (*place, str(key.value))
            if key.tag != "tag:yaml.org,2002:merge":
                yield inner, key.start_mark.line + 1
            yield from _places(value, inner)
    elif isinstance(node, yaml.SequenceNode):
        for number, value in enumerate(node.value):
            inner = (*place, number)
            yield inner, value.start_mark.line + 1
            yield from _places(value, inner)


def _resolved(
    plan: StudyPlan, lines: Mapping[Place, int], *, where: str, folder: Path
) -> StudyPlan:
    """The plan with absolute paths and the consent's text."""
    text = plan.consent.text
    if text is not None and _names_file(text):
        line = lines.get(("consent", "text"), 0)
        cure = f"{where}, line {line}, names it as consent.text: mend the name, or write the text"
        text = _text_of(read_bytes(folder / text, cure=cure), folder / text)
    robots = {key: robot_below(folder, spec) for key, spec in plan.robots.items()}
    pairs = {
        str(folder / stage.pairs): stage.pairs.as_posix()
        for role in plan.roles.values()
        for stage in role.stages
        if isinstance(stage, JudgeStage)
    }
    return plan.model_copy(
        update={
            "consent": plan.consent.model_copy(update={"text": text}),
            "robots": robots,
            "roles": {name: _role_below(folder, role) for name, role in plan.roles.items()},
            "paths": {**pairs, **{robots[key]: spec for key, spec in plan.robots.items()}},
        }
    )


def _names_file(text: str) -> bool:
    return "\n" not in text.strip() and text.endswith((".md", ".txt"))


def _text_of(data: bytes, file: Path) -> str:
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise UserError(f"{file} is no text in UTF-8 ({error.reason}): save it as UTF-8") from None


def _role_below(folder: Path, role: Role) -> Role:
    stages = tuple(
        stage.model_copy(update={"pairs": folder / stage.pairs})
        if isinstance(stage, JudgeStage)
        else stage
        for stage in role.stages
    )
    return role.model_copy(update={"stages": stages})


_PLACES = ("onnx", "sb3", "torchscript")
_NO_PLACES = ("builtin", "python", "exec")


def robot_below(folder: Path, spec: str) -> str:
    """A robot of a study file, as `--robot` takes it from any working directory.

    Example:
        >>> robot_below(Path("/studies"), "sb3:robot.zip"), robot_below(Path("/s"), "builtin:palm")
        ('sb3:/studies/robot.zip', 'builtin:palm')
    """
    kind, colon, place = spec.partition(":")
    if colon and kind in _NO_PLACES:
        return spec
    if colon and kind in _PLACES:
        return f"{kind}:{folder / place}"
    return str(folder / spec)
