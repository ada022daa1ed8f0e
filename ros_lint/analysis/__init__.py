"""The class of rules, and analyses of packages and workspaces that several rules share."""
