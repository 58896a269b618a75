"""A fit as text and as JSON."""

from __future__ import annotations

from typing import Any

from sandbox.lab.axes import unit_of
from sandbox.lab.fit.squares import Fit

#: Two values whose errors are correlated more strongly than this cannot be told apart.
CORRELATED = 0.95


def text(found: Fit) -> str:
    """The fit for people."""
    x, y = found.residual_sd
    lines = [f"{found.scene.title}: {len(found.track)} points"]
    for key, one in found.values.items():
        unit = unit_of(found.scene, key)
        line = f"  {key} = {one.value:.6g}{' ' * bool(unit)}{unit}  95 %: {one.low:.6g} to {one.high:.6g}"
        lines.append(line + ("; at an end of its range, so the interval does not hold" if one.at_bound else ""))
    lines.append(f"  standard deviation of the residuals: {x:.3g} m in x, {y:.3g} m in y")
    for (first, second), value in found.correlations.items():
        if abs(value) > CORRELATED:
            lines.append(f"  {first} and {second} can hardly be told apart (correlation {value:.3f})")
    if found.outliers:
        lines.append(f"  outliers: row {', '.join(map(str, found.outliers))}")
    if found.late:
        lines.append(
            f"  later than the end of the run, and compared with where the ball was then: points: {found.late}"
        )
    lines.append("  assumed: errors of the points are independent, and alike in x and y")
    return "\n".join(lines)


def as_json(found: Fit) -> dict[str, Any]:
    """The fit in JSON's types."""
    x, y = found.residual_sd
    return {
        "values": {
            key: {
                "value": one.value,
                "low": one.low,
                "high": one.high,
                "unit": unit_of(found.scene, key),
                "at_bound": one.at_bound,
            }
            for key, one in found.values.items()
        },
        "residual_sd": {"x": x, "y": y},
        "correlations": {f"{one}, {other}": value for (one, other), value in found.correlations.items()},
        "outliers": list(found.outliers),
        "points": len(found.track),
        "late": found.late,
    }
