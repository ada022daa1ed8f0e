"""Keep the facts and results of a run for later runs, in one file for each workspace in the user's cache folder."""
