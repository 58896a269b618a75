"""The workers of a Dask scheduler."""

from __future__ import annotations

import socket
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any

from sandbox.errors import RequestError

#: Time in s that a scheduler has to answer, and then for a worker to be there.
_ANSWER, _ARRIVAL = 10.0, 30.0


class Cluster:
    """The workers of a Dask scheduler at ``address``, which somebody else runs. They need this package, and a scene of
    one's own at the same place. Nothing listens here. Raises RequestError where nobody answers."""

    def __init__(self, address: str) -> None:
        try:
            import distributed
        except ImportError:
            raise RequestError("--scheduler needs Dask, which is not installed: pip install distributed") from None
        try:
            # first by hand: a Client that finds nobody takes half a minute to give up
            host, port = distributed.comm.parse_host_port(distributed.comm.parse_address(address)[1])
            socket.create_connection((host, port), timeout=_ANSWER).close()
            self._client = distributed.Client(address, timeout=_ANSWER, set_as_default=False)
        except (OSError, ValueError) as error:
            why = " ".join(str(error).split()) or "no answer"
            raise RequestError(f"--scheduler {address}: no Dask scheduler there: {why}") from None
        try:
            self._client.wait_for_workers(1, timeout=_ARRIVAL)
        except TimeoutError:
            self._client.close()
            raise RequestError(f"--scheduler {address}: it has no workers") from None
        self._killed = distributed.KilledWorker
        self._executor = self._client.get_executor(pure=False)
        self.width = max(1, sum(self._client.ncores().values()))

    def submit(self, work: Callable[..., Any], *args: Any) -> Future[Any]:
        future: Future[Any] = self._executor.submit(work, *args)
        return future

    def lost(self, error: BaseException) -> bool:
        # Dask gives a task to other workers by itself; this is one that took several with it
        return isinstance(error, self._killed)

    def close(self, abandon: bool) -> None:
        self._executor.shutdown(wait=not abandon)
        self._client.close()
