"""Find, select and run rules; apply suppression comments, the baseline and fixes."""
