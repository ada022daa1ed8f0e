"""Readers of the files that colcon reads besides manifests: CMakeLists.txt, setup.py, colcon.pkg, colcon.meta."""
