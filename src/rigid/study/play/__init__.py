"""A participant's live episode: the hand target in, every physics step of the scene out."""
