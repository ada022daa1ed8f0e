"""Static evaluation: what build scripts do, worked out without running them."""
