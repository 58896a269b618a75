"""The numbers of a fit: quantiles, errors, steps and losses, compared with scipy's and with exact cases."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import least_squares
from scipy.stats import t as student_t

import sandbox
from sandbox.lab.axes import Span
from sandbox.lab.fit.intervals import clustered, errors_of, group_sds, pooled
from sandbox.lab.fit.loss import HUBERS, SQUARES, TUKEYS, Loss
from sandbox.lab.fit.problem import Problem
from sandbox.lab.fit.search import neumann
from sandbox.lab.statistics import student


@pytest.mark.parametrize("freedom", [1, 2, 3, 4, 7, 20, 77, 1000])
def test_quantiles_are_those_of_student(freedom: int):
    assert student(freedom) == pytest.approx(student_t.ppf(0.975, freedom), rel=4e-3 if freedom > 2 else 1e-7)


@pytest.mark.parametrize("loss", [SQUARES, HUBERS, TUKEYS], ids=lambda loss: loss.name)
def test_weight_and_bend_are_derivatives_of_the_cost(loss: Loss):
    u = np.array([-7.0, -3.1, -0.4, 0.2, 1.0, 2.2, 4.4, 6.0])
    slope = (loss.cost(u + 1e-6) - loss.cost(u - 1e-6)) / 2e-6
    psi = (loss.weight(u + 1e-6) * (u + 1e-6) - loss.weight(u - 1e-6) * (u - 1e-6)) / 2e-6
    assert loss.weight(u) * u == pytest.approx(slope, abs=1e-8)
    assert loss.bend(u) == pytest.approx(psi, abs=1e-7)


def line(rng: np.random.Generator, sds: tuple[float, float]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Residuals and slopes of a straight line through points of two groups, and the groups."""
    x, groups = np.tile(np.linspace(-1.0, 1.0, 20), 2), np.repeat([0, 1], 20)
    slopes = np.column_stack([np.ones(40), x])
    return rng.normal(0.0, 1.0, 40) * np.array(sds)[groups], slopes, groups


def test_errors_alike_in_groups_are_those_of_their_means():
    """The mean of eight equal groups: its standard error is the sd of their means over the root of their number."""
    rng = np.random.default_rng(0)
    labels = np.repeat(np.arange(8), 10)
    for common, differs in ((2.0, True), (0.0, False)):
        errors = common * rng.normal(size=8)[labels] + rng.normal(size=80)
        left, slopes = errors - errors.mean(), -np.ones((80, 1))
        found, apart = clustered(left, slopes, np.full(80, 1.7), labels, SQUARES)
        means = errors.reshape(8, 10).mean(axis=1)
        assert found.sds[0] == pytest.approx(means.std(ddof=1) / 8**0.5)
        assert (found.freedom[0], apart.tolist()) == (7.0, [differs])


def test_errors_of_a_straight_line_are_those_of_the_textbook():
    """With one standard deviation s the covariance is s^2 (X'X)^-1 with n - p degrees of freedom."""
    noise, slopes, groups = line(np.random.default_rng(0), (1.0, 1.0))
    left = noise - slopes @ np.linalg.lstsq(slopes, noise, rcond=None)[0]
    together = np.zeros(40, dtype=int)
    (sd,) = group_sds(left, slopes, np.ones(40), together)
    found = errors_of(left, slopes, np.full(40, sd), together, SQUARES)
    assert sd**2 == pytest.approx((left**2).sum() / 38.0)
    assert found.covariance == pytest.approx(sd**2 * np.linalg.inv(slopes.T @ slopes))
    assert found.freedom == pytest.approx(38.0)


@pytest.mark.parametrize(("loss", "outliers"), [(SQUARES, 0), (TUKEYS, 0), (TUKEYS, 3)])
def test_errors_are_as_large_as_the_scatter_of_many_fits(loss: Loss, outliers: int):
    rng, found, said = np.random.default_rng(1), [], []
    for _ in range(300):
        noise, slopes, groups = line(rng, (1.0, 4.0))
        noise[rng.choice(40, outliers, replace=False)] += 60.0
        sds = np.array([1.0, 4.0])[groups]
        values = np.zeros(2)
        for _ in range(20):
            left = (noise - slopes @ values) / sds
            root = np.sqrt(loss.weight(left)) / sds
            values = np.linalg.lstsq(slopes * root[:, None], noise * root, rcond=None)[0]
        found.append(values)
        said.append(errors_of(noise - slopes @ values, slopes, sds, groups, loss).sds)
    assert np.mean(said, axis=0) == pytest.approx(np.std(found, axis=0), rel=0.12)


def test_groups_that_scatter_alike_are_pooled():
    counts, metres = np.array([40, 40]), ("m", "m")
    assert pooled(np.array([1.0, 1.2]), counts, metres) == pytest.approx(np.sqrt(1.22))
    assert pooled(np.array([1.0, 2.0]), counts, metres).tolist() == [1.0, 2.0]
    assert pooled(np.array([1.0, 1.2]), counts, ("m", "s")).tolist() == [1.0, 1.2]


def test_the_minimum_is_that_of_scipy():
    run = sandbox.simulate(sandbox.load("basketball", {"launch.speed": 7.1, "floor.restitution": 0.71}))
    t = np.linspace(0.0, 3.0, 20)
    x, y = (run.states("ball", t)[:, :2] + np.random.default_rng(2).normal(0.0, 0.02, (20, 2))).T
    found = sandbox.fit("basketball", {"t": t, "x": x, "y": y}, {"launch.speed": (6, 9), "floor.restitution": None})
    spans = [Span("launch.speed", 6.0, 9.0), Span("floor.restitution", 0.0, 1.0)]
    problem = Problem(sandbox.load("basketball"), found.measured, spans)
    start = (np.array([7.1, 0.71]) - problem.low) / problem.width
    theirs = least_squares(lambda share: problem.residuals(share[None])[0], start, x_scale="jac", diff_step=1e-6)
    ours = [one.value for one in found.values.values()]
    assert ours == pytest.approx(problem.values(theirs.x).tolist(), rel=1e-5)
    assert neumann(found.measured.groups, found.residuals) > 1.2
    covariance = np.linalg.inv(theirs.jac.T @ theirs.jac) * 2.0 * theirs.cost / 38.0
    halves = np.sqrt(np.diag(covariance)) * problem.width * student_t.ppf(0.975, 38)
    assert [0.5 * (one.high - one.low) for one in found.values.values()] == pytest.approx(halves.tolist(), rel=0.05)
