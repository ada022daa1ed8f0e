"""An interpreter of Python that evaluates programs symbolically and executes nothing."""
