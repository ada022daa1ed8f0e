"""Questions about launch files: includes, configurations, and the programs that they start."""
