"""An interpreter of Python that follows programs symbolically and executes nothing."""
