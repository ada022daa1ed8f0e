"""``ros-lint lsp``: findings, fixes and navigation in editors, by the Language Server Protocol."""
