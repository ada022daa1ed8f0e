"""C++ sources: includes, types, look-ups and registrations."""
