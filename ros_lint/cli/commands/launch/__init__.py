"""``ros-lint launch``: find a launch file, evaluate it with the files that it includes, and print what it starts."""
