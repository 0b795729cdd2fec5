"""Arrays, small dense systems, and the solvers of linear and quadratic programs."""
