"""Collectors: they read the texts of files and return facts. There is one package for each language or file format."""
