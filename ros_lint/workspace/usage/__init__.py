"""What the files of a package use, and how certain that is."""
