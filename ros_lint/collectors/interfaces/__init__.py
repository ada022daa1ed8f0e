"""Interface definitions: msg, srv and action files."""
