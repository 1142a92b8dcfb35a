"""Steps along a seam: predictor, corrector, and what they have passed."""
