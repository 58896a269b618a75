"""The workers of a Dask scheduler."""

from __future__ import annotations

import asyncio
import logging
import socket
from collections.abc import Callable
from contextlib import suppress
from time import monotonic
from typing import Any

from sandbox.errors import RequestError, RunError, SandboxError
from sandbox.workers.pool import WorkerLost

#: Time in s that a scheduler has to answer, and that there may be no worker.
ANSWER, ARRIVAL = 10.0, 30.0

#: How often the cluster is looked at while a result is waited for, in s.
_LOOK = 0.5


class Cluster:
    """The workers of the scheduler at ``address``, which somebody else runs. They need this package, and a scene of
    one's own at the same place. Nothing listens here. Raises RunError, in a line, where nobody answers, where no
    worker comes, and later where all of them go away."""

    def __init__(self, address: str) -> None:
        try:
            import distributed
        except ImportError:
            raise RequestError("--scheduler needs Dask, which is not installed: pip install distributed") from None
        self._address = address
        _hush()
        try:
            place = distributed.comm.parse_host_port(distributed.comm.parse_address(address, strict=True)[1])
        except ValueError:
            raise RequestError(f"--scheduler {address}: write it as tcp://HOST:PORT") from None
        try:
            socket.create_connection(place, timeout=ANSWER).close()  # Dask tries again where nobody listens
            kind = asyncio.run(_greeted(address))
            if kind == "Scheduler":
                self._client = distributed.Client(address, timeout=ANSWER, set_as_default=False)
        except Exception as error:  # also of the kinds that other services there make Dask raise
            why = " ".join(str(error).split()).partition(";")[0] or f"no answer in {ANSWER:g} s"
            raise self.failed(f"no Dask scheduler there: {why}") from None
        if kind != "Scheduler":
            raise self.failed(f"no Dask scheduler there, but a {kind}")
        try:
            self._client.wait_for_workers(1, timeout=ARRIVAL)
        except TimeoutError:
            self.close(abandon=True)
            raise self.failed(f"it has no workers, and none came in {ARRIVAL:g} s") from None
        self._without_workers_since: float | None = None
        self._check_package()
        self.width = max(1, sum(self._cores().values()))

    def submit(self, work: Callable[..., Any], *args: Any) -> _Remote:
        try:
            return _Remote(self, self._client.submit(work, *args, pure=False))
        except Exception:
            raise self.failed("the scheduler went away") from None

    def close(self, abandon: bool) -> None:
        with suppress(Exception):  # of a scheduler that is gone
            self._client.close(timeout=2.0)

    def failed(self, why: str) -> RunError:
        """What went wrong, in a line."""
        return RunError(f"--scheduler {self._address}: {why}")

    def look(self) -> None:
        """Raise RunError where the scheduler is gone, or there has been no worker for a while."""
        if self._cores():
            self._without_workers_since = None
            return
        now = monotonic()
        self._without_workers_since = self._without_workers_since or now
        if now - self._without_workers_since > ARRIVAL:
            raise self.failed(f"its workers went away, and none came back in {ARRIVAL:g} s")

    def _cores(self) -> dict[str, int]:
        """The cores of each worker, by its address."""
        scheduler: Any = self._client.scheduler
        try:
            cores: dict[str, int] = self._client.sync(scheduler.ncores, callback_timeout=ANSWER)
            return cores
        except Exception:
            raise self.failed("the scheduler went away") from None

    def _check_package(self) -> None:
        """Raise RunError for a worker that could not even read what it is sent."""

        def missing() -> str:  # sent as code, as it goes where this module may not be
            try:
                import sandbox.workers  # noqa: F401
            except Exception as error:
                return f"{type(error).__name__}: {error}"
            return ""

        for worker, why in self._client.run(missing, on_error="return").items():
            if why:
                raise self.failed(f"the worker {worker} has no sandbox: {why}")


async def _greeted(address: str) -> str:
    """What is there, as it calls itself: a Client would wait for ever for a service of another kind."""
    from distributed.core import rpc

    async with rpc(address, timeout=ANSWER) as other:
        identity: dict[str, Any] = await asyncio.wait_for(other.identity(), ANSWER)
        return str(identity["type"])


def _hush() -> None:
    """What goes wrong is said by us, in a line: Dask's own log stays out of the terminal."""
    for name in list(logging.root.manager.loggerDict):
        if name.partition(".")[0] in ("distributed", "tornado"):
            logging.getLogger(name).setLevel(logging.CRITICAL + 1)


class _Remote:
    """A call that the cluster computes."""

    def __init__(self, cluster: Cluster, future: Any) -> None:
        self._cluster = cluster
        self._future = future

    def done(self) -> bool:
        return bool(self._future.done())

    def result(self) -> Any:
        from distributed import KilledWorker
        from distributed.client import CancelledError

        while True:
            try:
                return self._future.result(timeout=_LOOK)
            except TimeoutError:
                if self._future.status == "error":  # the call's own
                    raise self._cluster.failed("a worker ran into a timeout") from None
                self._cluster.look()
            except KilledWorker as error:  # Dask gives a task to others by itself; this one took several with it
                raise WorkerLost(str(error)) from None
            except CancelledError:
                raise self._cluster.failed("the scheduler went away") from None
            except SandboxError:
                raise
            except Exception as error:  # no run's: those are rows
                why = " ".join(f"{type(error).__name__}: {error}".split())
                raise self._cluster.failed(f"a worker cannot compute: {why}") from None
