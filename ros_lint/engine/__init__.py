"""Find, select and run rules; apply suppressions, the baseline and fixes."""
