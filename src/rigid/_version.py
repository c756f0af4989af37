"""The version: this line is its only source, for the package and for its metadata."""

__version__ = "0.1.0.dev0"
