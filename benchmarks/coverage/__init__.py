"""Do the 95 % intervals cover? Tried on whole searches and on laws of known mean."""
