"""What measuring adds."""

PARTS = {"charts": "sandbox.lab.chart"}
