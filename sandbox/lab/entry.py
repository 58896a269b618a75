"""Commands that measuring adds."""

PARTS = {"charts": "sandbox.lab.chart"}
