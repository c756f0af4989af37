"""What acts: the policy protocol, networks, RIGID's own format, and loaders for other formats."""
