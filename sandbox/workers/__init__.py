"""Workers: this process, other processes on this machine, or a cluster, all with the same ``submit``."""

from __future__ import annotations

from sandbox.workers.cluster import Cluster
from sandbox.workers.pool import Call, InTurn, WorkerLost, Workers, cores
from sandbox.workers.processes import Processes

__all__ = ["Call", "Cluster", "InTurn", "Processes", "WorkerLost", "Workers", "cores"]
