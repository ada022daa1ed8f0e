"""Extension for colcon to check packages with ros-lint."""

__version__ = "0.1.0"
