"""What a rule is, and the questions that several rules ask of a package and its workspace."""
