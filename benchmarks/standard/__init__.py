"""Is preset `standard` as good as preset `paper`, at a fraction of its cost?"""
