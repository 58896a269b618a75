"""The workers of a Dask scheduler."""

from __future__ import annotations

import logging
import socket
from collections.abc import Callable
from contextlib import suppress
from time import monotonic
from typing import Any

from sandbox.errors import RequestError, RunError, SandboxError
from sandbox.workers.pool import WorkerLost

#: Longest wait in s for the scheduler to answer, and for a worker to connect.
ANSWER, ARRIVAL = 10.0, 30.0

#: Interval in s at which the cluster is checked while waiting for a result.
_CHECK_EVERY = 0.5


class Cluster:
    """The workers of a running Dask scheduler at ``address``. They need this package, and a user's scene under the same
    path. This process opens no port. Raises a one-line RunError if there is no answer, if no worker connects, and later
    if all workers are lost."""

    def __init__(self, address: str) -> None:
        import asyncio

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
            socket.create_connection(place, timeout=ANSWER).close()  # Dask would retry if nothing listens
            kind = asyncio.run(_greeted(address))
            if kind == "Scheduler":
                self._client = distributed.Client(address, timeout=ANSWER, set_as_default=False)
        except Exception as error:  # includes what Dask raises when another service listens there
            why = " ".join(str(error).split()).partition(";")[0] or f"no answer in {ANSWER:g} s"
            raise self.failed(f"no Dask scheduler there: {why}") from None
        if kind != "Scheduler":
            raise self.failed(f"no Dask scheduler there, but a {kind}")
        try:
            self._client.wait_for_workers(1, timeout=ARRIVAL)
        except TimeoutError:
            self.close(abandon=True)
            raise self.failed(f"it has no workers, and none connected within {ARRIVAL:g} s") from None
        self._without_workers_since: float | None = None
        self._check_package()
        self.width = max(1, sum(self._cores().values()))

    def submit(self, work: Callable[..., Any], *args: Any) -> _Remote:
        try:
            return _Remote(self, self._client.submit(work, *args, pure=False))
        except Exception:
            raise self.failed("the connection to the scheduler was lost") from None

    def close(self, abandon: bool) -> None:
        with suppress(Exception):  # the scheduler may be gone
            self._client.close(timeout=2.0)

    def failed(self, why: str) -> RunError:
        """A one-line error about this scheduler."""
        return RunError(f"--scheduler {self._address}: {why}")

    def look(self) -> None:
        """Raise RunError if the scheduler is gone, or there has been no worker for a while."""
        if self._cores():
            self._without_workers_since = None
            return
        now = monotonic()
        self._without_workers_since = self._without_workers_since or now
        if now - self._without_workers_since > ARRIVAL:
            raise self.failed(f"its workers were lost, and none came back within {ARRIVAL:g} s")

    def _cores(self) -> dict[str, int]:
        """The cores of each worker, by its address."""
        scheduler: Any = self._client.scheduler
        try:
            cores: dict[str, int] = self._client.sync(scheduler.ncores, callback_timeout=ANSWER)
            return cores
        except Exception:
            raise self.failed("the connection to the scheduler was lost") from None

    def _check_package(self) -> None:
        """Raise RunError if a worker does not have this package."""

        def missing() -> str:  # sent as code, since the worker may not have this module
            from importlib import import_module

            try:
                import_module("sandbox.workers")
            except Exception as error:
                return f"{type(error).__name__}: {error}"
            return ""

        for worker, why in self._client.run(missing, on_error="return").items():
            if why:
                raise self.failed(f"the worker {worker} has no sandbox: {why}")


async def _greeted(address: str) -> str:
    """The kind of the service at the address, as it reports: a Client would wait forever for another kind."""
    import asyncio

    from distributed.core import rpc

    async with rpc(address, timeout=ANSWER) as other:
        identity: dict[str, Any] = await asyncio.wait_for(other.identity(), ANSWER)
        return str(identity["type"])


def _hush() -> None:
    """Keep Dask's log out of the terminal: errors are reported here in one line."""
    for name in list(logging.root.manager.loggerDict):
        if name.partition(".")[0] in ("distributed", "tornado"):
            logging.getLogger(name).setLevel(logging.CRITICAL + 1)


class _Remote:
    """A call computed by the cluster."""

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
                return self._future.result(timeout=_CHECK_EVERY)
            except TimeoutError:
                if self._future.status == "error":  # raised by the call
                    raise self._cluster.failed("a timeout in a worker") from None
                self._cluster.look()
            except KilledWorker as error:  # Dask retries a task elsewhere by itself; this one killed several workers
                raise WorkerLost(str(error)) from None
            except CancelledError:
                raise self._cluster.failed("the connection to the scheduler was lost") from None
            except SandboxError:
                raise
            except Exception as error:  # not from a run: those become rows
                why = " ".join(f"{type(error).__name__}: {error}".split())
                raise self._cluster.failed(f"a worker cannot compute: {why}") from None
