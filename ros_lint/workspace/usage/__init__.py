"""The uses of other packages in the files of a package, and how certain each use is."""
