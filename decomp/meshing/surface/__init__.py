"""The surfaces that a mesh conforms to, with the cells between them."""
