"""`rigid export`: films, figures and policies for other programs."""
