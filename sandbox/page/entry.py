"""Commands and parts that pages for a browser add."""

PARTS = {
    "notebooks": "sandbox.page.notebook",
    "pages of golden failures": "sandbox.page.golden_report",
    "pages of reports": "sandbox.page.report",
    "pages of runs": "sandbox.page.replay",
    "pages of sweeps": "sandbox.page.sweep",
    "pages of tasks": "sandbox.page.task",
}
