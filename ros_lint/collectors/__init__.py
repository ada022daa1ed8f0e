"""Collectors: one package for each language or format, from texts to facts."""
