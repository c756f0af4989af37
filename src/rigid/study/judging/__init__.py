"""Questionnaires about pairs of episodes: what each participant is shown, and what they answered.

`trials_for` draws a participant's trials, `prepare_clips` makes the motions that they show, and
`read_answer` turns what a page sends back into records.
"""

from rigid.study.judging.answers import read_answer, remaining
from rigid.study.judging.clips import Clips, prepare_clips
from rigid.study.judging.questions import asked
from rigid.study.judging.trials import Trial, preview_trials, trials_for

__all__ = [
    "Clips",
    "Trial",
    "asked",
    "prepare_clips",
    "preview_trials",
    "read_answer",
    "remaining",
    "trials_for",
]
