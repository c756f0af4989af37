"""What people did, as it was recorded: judged, completed, learned from."""
