"""Motion of a ball or body until the next event: forces, step control, flight, rolling and sliding."""
