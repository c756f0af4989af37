"""The study as a service: pages, messages, live play and the desk of whoever runs it."""
