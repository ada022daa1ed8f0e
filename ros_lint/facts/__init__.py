"""What collectors find out: plain frozen values. No file is read here and nothing is looked up.

They are named tuples because a workspace has a hundred thousand of them: they start, are made, travel between
processes and are cached in half the time that frozen dataclasses take. The cache loads no class but those of these
modules and what a report is made of.
"""
