"""Test beds with closed forms: two small tasks, their exact policies and their exact optima.

Everything that RIGID learns or measures on them can be held against a number that was computed
without learning: `docs/analytic.md` derives the formulas, `rigid verify` makes the comparison.
"""
