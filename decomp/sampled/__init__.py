"""The skeleton as the walls between labels: a second way to it, which has no special cases."""
