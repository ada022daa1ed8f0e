"""The command line: arguments, settings, sessions and commands."""
