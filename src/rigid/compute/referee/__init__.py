"""The referees on disk, and whether they may be believed: `rigid referee --check`."""
