"""Where and how seams end: at walls, in fins, on axes, read off where equations lose rank."""
