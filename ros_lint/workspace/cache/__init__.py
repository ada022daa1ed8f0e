"""Keep results between runs, in one file for each workspace, in the user's cache folder."""
