"""Find the packages of a workspace as colcon does."""
