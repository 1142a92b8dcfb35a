"""Models in wide air: its far end is brought near for the mesher and swept back."""
