"""The lab: what accuracy costs, what the extremes do, how the numbers compare with published ones."""
