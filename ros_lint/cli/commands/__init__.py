"""The commands of ros-lint, such as ``check`` and ``graph``. Most have a module or package of their own."""
