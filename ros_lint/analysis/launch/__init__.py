"""Questions about launch files: includes, configurations, and what they start."""
