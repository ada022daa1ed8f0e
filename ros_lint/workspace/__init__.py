"""From a tree of files to the model: discover, collect, evaluate and join."""
