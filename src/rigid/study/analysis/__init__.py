"""What a study says: people on the frontier's axes, and what those who judged motions found.

Paper, section 5.2 and the appendices on user studies. Pure functions of arrays; `reading` and
`writing` are the edge. `docs/study.md` says how to read the results.
"""
