"""What the documentation's build needs beside Sphinx's own extensions: see `docs/conf.py`."""
