"""What compiled kernels are made of: how they are compiled, records, and the carriers."""
