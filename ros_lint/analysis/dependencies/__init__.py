"""Questions about dependencies: what a package needs, declares and provides transitively."""
