"""The lab: sweeps and searches, the cost of accuracy, stress tests, and comparison with published numbers."""
