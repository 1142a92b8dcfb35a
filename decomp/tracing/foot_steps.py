"""Limits of the steps with which feet on curves are found."""

LEAST_BEND, LONGEST_STEP = 1e-5, 0.25
"""Close to a centre of curvature Newton's steps along an edge, which grow without bound there, are
divided by no less than this, and are no longer than this part of the distance."""
FOOT_STEPS = 60
