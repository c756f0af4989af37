"""The page of an examination: a verdict, a sentence, a picture and advice for each step.

One file that opens from disk. Words of tasks and files are strangers': all of them are escaped, and
nothing runs, since the page allows no script.
"""

from __future__ import annotations

from importlib import resources
from pathlib import Path

from rigid.compute.doctor.domain import Diagnosis
from rigid.doctor.verdict import Verdict
from rigid.files import write_atomically, writing_to
from rigid.report.doctor_plots import plot_of
from rigid.report.plain_page import plain_page, safe

_TEMPLATE = resources.files("rigid.report") / "doctor.html"
_WORDS = {"pass": "passes", "warn": "with care", "fail": "fails", "skip": "not examined"}


def write_doctor_page(diagnosis: Diagnosis, out: Path) -> Path:
    """Writes `doctor.html` into the directory of the examination and returns its path.

    Raises:
        UserError: It cannot be written.
    """
    path = out / "doctor.html"
    with writing_to(path):
        write_atomically(path, doctor_page(diagnosis).encode())
    return path


def doctor_page(diagnosis: Diagnosis) -> str:
    """The page as text."""
    about = diagnosis.about
    return plain_page(
        _TEMPLATE,
        title=f"{about['task']}: examined for RIGID",
        facts=safe(f"robot {about['robot']}, human {about['human']}, features {about['features']}"),
        outcome=_outcome(diagnosis),
        contents="\n".join(_line(number, v) for number, v in enumerate(diagnosis.verdicts)),
        steps="\n".join(_step(number, v) for number, v in enumerate(diagnosis.verdicts)),
    )


def _outcome(diagnosis: Diagnosis) -> str:
    if diagnosis.failed:
        titles = "; ".join(verdict.title for verdict in diagnosis.failed)
        return f'<p class="outcome fail">Not ready for a frontier: {safe(titles)}.</p>'
    if any(verdict.status != "pass" for verdict in diagnosis.verdicts):
        return '<p class="outcome warn">Ready for a frontier, with care.</p>'
    return '<p class="outcome pass">Ready for a frontier.</p>'


def _line(number: int, verdict: Verdict) -> str:
    return (
        f'<li><a href="#{verdict.step}">{number}. {safe(verdict.title)}</a>{_badge(verdict)}</li>'
    )


def _step(number: int, verdict: Verdict) -> str:
    plot = plot_of(verdict.step, verdict.evidence)
    figure = f"<figure>{plot}</figure>" if plot else ""
    advice = f'<p class="advice">{safe(verdict.advice)}</p>' if verdict.advice else ""
    return (
        f'<section id="{verdict.step}"><h2>{number}. {safe(verdict.title)}{_badge(verdict)}</h2>\n'
        f"<p>{safe(verdict.says)}</p>{advice}{figure}</section>"
    )


def _badge(verdict: Verdict) -> str:
    return f' <span class="badge {verdict.status}">{_WORDS[verdict.status]}</span>'
