"""Create the data files about released packages from files of rosdistro and rosdep."""
