"""Many similar shots at once, as arrays, with the results of single ones."""
