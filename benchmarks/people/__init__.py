"""Does the service of studies hold? Thirty at once, a killed server, hostile messages."""
