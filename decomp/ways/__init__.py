"""What users ask for, made in the way that they choose: skeletons, surfaces, meshes."""
