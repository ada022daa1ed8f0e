"""The type of a rule, and the questions that several rules ask of a package and its workspace."""
