"""A complex made finer where its chords are too far off, and unfolded, on its exact elements."""
