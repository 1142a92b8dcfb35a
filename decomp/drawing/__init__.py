"""Scenes: what is drawn of meshes and skeletons, in which colours, and pictures (.png) of them."""
