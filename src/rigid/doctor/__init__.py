"""Verdicts on a new domain: is everything there that a frontier needs? Numbers in, a verdict out.

The steps are those of the paper's appendix 'How to Compute Natural-Adversarial Curve on a New
Domain?'. Nothing here plays, trains or reads a file; `rigid.compute.doctor.domain` does.
"""
