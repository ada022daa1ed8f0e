"""Load a workspace: discover packages, collect data from their files, evaluate build scripts, and join the results."""
