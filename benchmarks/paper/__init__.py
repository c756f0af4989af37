"""The paper's experiments with simulated people, on our own robots: `make paper`."""
