"""Installation of colcon-ros-lint; setup.cfg has the metadata."""

from setuptools import setup

setup()
