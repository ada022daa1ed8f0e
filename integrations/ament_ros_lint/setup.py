"""Installation of ament_ros_lint."""

from setuptools import setup

package_name = "ament_ros_lint"

setup(
    name=package_name,
    version="0.1.0",
    packages=[package_name],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/" + package_name]),
        ("share/" + package_name, ["package.xml"]),
    ],
    install_requires=["setuptools"],
    zip_safe=False,
    maintainer="ros-lint developers",
    maintainer_email="ros-lint@example.org",
    description="Check a ROS 2 package with ros-lint and write the result as an xunit file.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": ["ament_ros_lint = ament_ros_lint.main:run"],
        "pytest11": ["ament_ros_lint = ament_ros_lint.pytest_marker"],
    },
)
