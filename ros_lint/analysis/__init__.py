"""The type of a rule, and analyses of a package and its workspace that several rules share."""
