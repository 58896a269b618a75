"""A target that is true, false or a word, by two parameters: the regions in which it is met."""

from __future__ import annotations

from itertools import product

import numpy as np

from sandbox.lab.aim.intervals import FIRST, narrowed
from sandbox.lab.aim.question import Region, Solution
from sandbox.lab.aim.shots import Shots

#: Points of the scan along each parameter, and the spacings of these points across which a region is sure to be seen.
SCAN_EACH, _NARROWEST = 61, 3

#: Directions in which the border is searched for around the most forgiving point, and how accurately, as a fraction of
#: the range.
_DIRECTIONS, _FINE = 48, 1e-3


def regions(shots: Shots) -> list[Solution]:
    """The most forgiving point of each connected region in which the target is met, the one with the most room first.

    Room is the distance to the border, or to the end of the range, in fractions of the ranges. Regions that hold no
    point of the scan with all its neighbours are left out if there are others.
    """
    from scipy.ndimage import distance_transform_edt, label

    shots.planned = SCAN_EACH**2
    shots.resolved(_NARROWEST / (SCAN_EACH - 1))
    axes = [np.linspace(span.low, span.high, SCAN_EACH).tolist() for span in shots.spans]
    met = np.array(shots.meets(list(product(*axes)), "scan")).reshape(SCAN_EACH, SCAN_EACH)
    room = distance_transform_edt(np.pad(met, 1))[1:-1, 1:-1]
    kinds, count = label(met)
    found = []
    for kind in range(1, count + 1):
        here = np.where(kinds == kind, room, 0.0)
        place = np.unravel_index(int(here.argmax()), here.shape)
        point = tuple(axis[index] for axis, index in zip(axes, place, strict=True))
        found.append((float(here.max()), point, float((kinds == kind).mean())))
    found.sort(reverse=True)
    wide = [each for each in found if each[0] > 1.0] or found[:1]
    return [_solution(shots, point, share) for _, point, share in wide]


def _solution(shots: Shots, point: tuple[float, ...], share: float) -> Solution:
    spans = shots.spans
    result, errors, _ = shots.checked([point])[0]
    whole = np.array([span.high - span.low for span in spans])
    ends = np.array([(span.low, span.high) for span in spans])
    angles = (np.arange(_DIRECTIONS) + 0.5) * (2.0 * np.pi / _DIRECTIONS)  # none along an axis
    ways = np.array([np.cos(angles), np.sin(angles)]).T * whole
    limits = np.maximum((ends[:, 0] - point) / ways, (ends[:, 1] - point) / ways).min(axis=1)

    def along(number: int, way: float) -> tuple[float, ...]:
        return tuple(np.clip(point + way * ways[number], *ends.T).tolist())

    beyond = [(0.0, (1.0 + 1.0 / FIRST) * limit, True) for limit in limits.tolist()]  # the limit itself is tried, too
    border = np.minimum([low for low, _, _ in narrowed(shots, beyond, along, _FINE)], limits)
    values = dict(zip([span.key for span in spans], point, strict=True))
    room = dict(zip(values, (float(border.min()) * whole).tolist(), strict=True))
    spacing = dict(zip(values, (0.5 * whole / (SCAN_EACH - 1)).tolist(), strict=True))
    return Solution(values, spacing, result, errors, region=Region(share, room))
