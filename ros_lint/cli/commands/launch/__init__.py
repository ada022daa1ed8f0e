"""The command ``ros-lint launch``: find a launch file, expand it and print what it starts."""
