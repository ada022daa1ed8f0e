"""C++ sources: includes, types, lookups and registrations."""
