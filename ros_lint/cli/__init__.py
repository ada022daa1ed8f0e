"""The command line of ros-lint: arguments, settings and commands."""
