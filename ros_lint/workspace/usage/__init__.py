"""Find the places in a package that use other packages, and determine how certain each use is."""
