"""Results: paths as polynomials in time, events, and the run that holds them."""
