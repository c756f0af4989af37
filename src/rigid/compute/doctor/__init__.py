"""What the verdicts on a new domain are made of: `rigid doctor`."""
