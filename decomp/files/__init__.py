"""Files to write: what may be written where, whole or not at all."""
