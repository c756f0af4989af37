"""What does each search measure find, and what does it find alone?

The paper's appendix 'Discriminator-free Method: Maximum Mean Discrepancy', and more measures.
`python -m benchmarks.measures --help` says how to run it; `results/measures/` holds what it found.
"""
