"""What a mesher leaves amiss, mended: cut edges, strayed sheets, flat elements."""
