"""Shared by the sports: facts, controls, and the parameters and forces of a ball. It depends on no single sport."""
