"""Runs, sweeps and golden failures as pages for a browser: each one file that needs no network.

Python only turns what was computed into data; what is shown and played is in the HTML, CSS and JavaScript files here.
"""
