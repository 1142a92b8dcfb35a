"""Pictures of models, meshes and skeletons: a page, an image, a window."""
