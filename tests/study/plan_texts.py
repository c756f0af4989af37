"""Two short study files."""

TEXT = """\
title: Scratching
robots: {a: "builtin:vanilla"}
roles:
  novice:
    participants: 8
    stages:
      - {kind: watch, episodes: 3}
      - {kind: practise}
      - {kind: play, episodes: 5, manner: own-way}
"""
JUDGING = """\
title: Judging
robots: {a: "builtin:vanilla"}
roles:
  rater:
    participants: 15
    stages:
      - {kind: judge, question: danger, pairs: pairs/danger.json}
"""
