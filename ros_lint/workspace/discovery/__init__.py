"""Find packages as colcon does."""
