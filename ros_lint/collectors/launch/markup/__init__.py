"""Static analysis of launch files in XML and YAML."""
