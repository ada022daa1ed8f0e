"""Static analysis of launch files in Python, XML and YAML."""
