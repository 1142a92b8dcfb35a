"""Files of other projects, checked by means that share nothing with the package."""
