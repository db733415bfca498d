"""Models and studies: one a file. They ship with plantc, so that `plantc demo` works outside a checkout."""
