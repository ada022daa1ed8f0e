"""Resource files: plugin descriptions, parameter files, models and displays."""
