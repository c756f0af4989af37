"""How fast RIGID is and what grows with what: `rigid bench`."""
