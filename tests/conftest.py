"""Fixtures for all tests."""

pytest_plugins = ["sandbox.golden"]
