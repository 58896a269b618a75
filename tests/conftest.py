"""The same verdict each time: hypothesis tries the same examples in every run, however slow the machine."""

import signal

from hypothesis import HealthCheck, settings

for ignored, handler in ((signal.SIGINT, signal.default_int_handler), (signal.SIGHUP, signal.SIG_DFL)):
    if signal.getsignal(ignored) is signal.SIG_IGN:  # as a shell's & and nohup do; children would inherit it
        signal.signal(ignored, handler)

settings.register_profile("steady", derandomize=True, deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("steady")
