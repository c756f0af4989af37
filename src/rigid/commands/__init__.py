"""The commands of `rigid`: options as dataclasses, and what each one does.

Modules here import nothing heavy at the top: `rigid --help` must be quick.
"""
