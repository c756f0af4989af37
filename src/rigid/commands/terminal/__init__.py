"""What people see while a command runs: help, progress, text in whole lines."""
