"""People in the loop: they play the human, judge motions, and are placed on the frontier's axes."""
