"""What colcon reads where a package has no manifest: CMakeLists.txt, setup.py, colcon.pkg and colcon.meta."""
