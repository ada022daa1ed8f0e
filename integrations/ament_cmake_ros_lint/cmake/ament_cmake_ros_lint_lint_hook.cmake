message(STATUS "Added test 'ros_lint' to check the package with ros-lint")
ament_ros_lint()
