"""A fit as text and as JSON."""

from __future__ import annotations

from typing import Any

from sandbox.lab.fit.squares import Fit
from sandbox.text import counted

#: Two values whose errors are correlated more strongly than this cannot be told apart.
CORRELATED = 0.95


def text(found: Fit) -> str:
    """The fit for people."""
    measured = found.measured
    lines = [f"{found.scene.title}: {counted(measured.count, measured.what)}, {found.loss}"]
    for key, one in found.values.items():
        line = f"  {key} = {one.value:.6g}{' ' * bool(one.unit)}{one.unit}  95 %: {one.low:.6g} to {one.high:.6g}"
        lines.append(line + ("; at an end of its range, so the interval does not hold" if one.at_bound else ""))
    sds = zip(found.residual_sd.items(), measured.units, strict=True)
    said = ", ".join(f"{sd:.3g} {unit} in {name}" for (name, sd), unit in sds)
    lines.append(f"  standard deviation of the residuals: {said}")
    for (first, second), value in found.correlations.items():
        if abs(value) > CORRELATED:
            lines.append(f"  {first} and {second} can hardly be told apart (correlation {value:.3f})")
    if found.outliers:
        lines.append(f"  outliers: row {', '.join(map(str, found.outliers))}")
    lines += [f"  {remark}" for remark in found.remarks]
    return "\n".join(lines)


def as_json(found: Fit) -> dict[str, Any]:
    """The fit in JSON's types."""
    return {
        "values": {
            key: {
                "value": one.value,
                "low": one.low,
                "high": one.high,
                "unit": one.unit,
                "at_bound": one.at_bound,
                "unknown": one.unknown,
            }
            for key, one in found.values.items()
        },
        "residual_sd": dict(found.residual_sd),
        "correlations": {f"{one}, {other}": value for (one, other), value in found.correlations.items()},
        "outliers": list(found.outliers),
        "points": found.measured.count,
    }
