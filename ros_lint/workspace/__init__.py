"""Load a workspace, from files to the objects that rules read: discover packages, collect facts, evaluate build scripts, join."""
