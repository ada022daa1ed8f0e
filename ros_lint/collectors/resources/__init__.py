"""Other resources: plugin descriptions, parameter files, models and displays."""
