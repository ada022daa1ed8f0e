"""Keep the results of a run and the data extracted from its files for later runs, in one cache file for each workspace."""
