"""Which stabilisers of the discriminator matter, and how much canonical data it needs.

The paper's appendices 'Improving GAN training' and 'How to Compute Natural-Adversarial Curve on a
New Domain?'. `python -m benchmarks.ablations --help` says how to run it; `results/ablations/` holds
what it found.
"""
