"""The XML schemas of package.xml (REP 127, 140 and 149), and the validation of manifests with them."""
