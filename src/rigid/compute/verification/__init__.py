"""Learning against numbers that were computed without it: `rigid verify`."""
