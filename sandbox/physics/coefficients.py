"""Drag and lift coefficients, named by their paper.

Each is a function of the Reynolds number ``Re = rho |u| 2 r / mu`` and the spin ratio ``S = r |w| / |u|``, where u is
the velocity relative to the air. Floats, or arrays of shape (n,). Where a formula would become negative or grow without
bound, its argument is clamped.

What is registered by :meth:`Laws.law` can be named in scene files, and is listed in docs/physics.md, with the first
paragraph of its docstring. A test computes its points again.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import inf
from typing import Any, Literal, NamedTuple, TypeVar

from sandbox.physics.elementwise import clip, exp, sin

#: coefficient(reynolds, spin_ratio) -> dimensionless
Coefficient = Callable[[Any, Any], Any]
Law = TypeVar("Law", bound=Coefficient)

#: Lowest and highest value that a coefficient was found for.
Range = tuple[float, float]
ANY: Range = (0.0, inf)


class Origin(NamedTuple):
    """Source and range of a coefficient, and values to check it by."""

    source: str
    points: Mapping[tuple[float, float], float]  # by (Re, S)
    within: float  # of these points
    mark: Literal["", "second-hand", "ours", "assumed"]
    reynolds: Range
    spin_ratio: Range


class Laws(dict[str, Coefficient]):
    """The drag or the lift coefficients of one ball, by the names that scene files use; ``origins`` has their sources.

    They are given to a ball's class: ``class GolfBall(Sphere, drag=GOLF_DRAG)``.
    """

    def __init__(self, ball: str, kind: Literal["drag", "lift"]) -> None:
        self.ball, self.kind = ball, kind
        self.origins: dict[str, Origin] = {}

    def law(
        self,
        name: str,
        source: str,
        points: Mapping[tuple[float, float], float],
        *,
        within: float = 5e-5,
        mark: Literal["", "second-hand", "ours", "assumed"] = "",
        reynolds: Range = ANY,
        spin_ratio: Range = ANY,
    ) -> Callable[[Law], Law]:
        """Register the function below under this name.

        The source is cited as in docs/physics.md, which explains the marks, too; ``points`` are at least two values of
        the coefficient by (Re, S), met ``within`` so much; the ranges are those for which it was found.
        """
        if len(points) < 2 or not source or name in self:
            raise ValueError(f"{self.kind} {name!r} of {self.ball}: needs a new name, a source, and two points or more")
        self.origins[name] = Origin(source, points, within, mark, reynolds, spin_ratio)

        def register(law: Law) -> Law:
            self[name] = law
            return law

        return register


#: Of each ball, and of any.
ANY_LIFT = Laws("any ball", "lift")
GOLF_DRAG, GOLF_LIFT = Laws("a golf ball", "drag"), Laws("a golf ball", "lift")
SOCCER_DRAG, SOCCER_LIFT = Laws("a soccer ball", "drag"), Laws("a soccer ball", "lift")
TENNIS_DRAG, TENNIS_LIFT = Laws("a tennis ball", "drag"), Laws("a tennis ball", "lift")
BASEBALL_DRAG, BASEBALL_LIFT = Laws("a baseball", "drag"), Laws("a baseball", "lift")
VOLLEYBALL_DRAG = Laws("a volleyball", "drag")


@dataclass(frozen=True)
class Constant:
    """The same at any speed and spin."""

    value: float

    def __call__(self, reynolds: Any, spin_ratio: Any) -> Any:
        return self.value


@dataclass(frozen=True)
class Scaled:
    """``share`` times another coefficient."""

    coefficient: Coefficient
    share: float

    def __call__(self, reynolds: Any, spin_ratio: Any) -> Any:
        return self.share * self.coefficient(reynolds, spin_ratio)


@dataclass(frozen=True)
class OfWholeSpin:
    """Another coefficient by the whole spin, of a ball that is simulated with only a ``share`` of it: the part about an
    axis across the plane, if the spin's axis is tilted."""

    coefficient: Coefficient
    share: float

    def __call__(self, reynolds: Any, spin_ratio: Any) -> Any:
        return self.coefficient(reynolds, spin_ratio / self.share)


@ANY_LIFT.law("spin-ratio", "textbooks", {(1e5, 0.1): 0.1, (1e5, 0.3): 0.3}, spin_ratio=(0.0, 0.3))
def spin_ratio_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """``Cl = S``: the simplest lift, linear in spin. A fair guess for S below 0.3, far too large above 1."""
    return spin_ratio


# -------------------------------------------------------------------------------------------------------- golf ball

# Drag and lift of one name belong together: their rms errors on the PGA Tour averages of scenes/golf/published/tour.csv
# are (height in yd, landing angle in deg, carry in yd) 1.8/1.7/3.1 for tour-fit, 2.3/3.6/5.1 for monitor-fit,
# 3.2/2.8/3.7 for quadratic, 2.3/4.2/5.9 for power-law, 3.8/6.6/11.9 for smits-smith, 2.5/2.4/16.4 for usga, and
# 12.9/4.8/59.2 for lyu, which has no spin-induced drag.

_CRITICAL, _EARLY_CRITICAL = 1.0 / 0.68e5, 1.0 / 0.55e5


@GOLF_DRAG.law(
    "monitor-fit",
    "fitted to straight drives of a launch monitor and to the 12 averages of the PGA Tour, by "
    "tests/reference/fit_golf_ball.py",
    {(1.5e5, 0.2): 0.2893, (0.55e5, 0.0): 0.3415},
    mark="ours",
    reynolds=(0.5e5, 2.2e5),
    spin_ratio=(0.07, 1.07),
)
def monitor_fit_drag(reynolds: Any, spin_ratio: Any) -> Any:
    """``Cd = 0.183 + 0.317 / (1 + (Re / 0.55e5)^8) + 1.42 Cl^2``, with the Cl of monitor_fit_lift.

    A drag polar as tour_fit_drag, whose crisis is over before a drive comes down, as in wind tunnels (Re 0.4e5 to
    0.6e5). Cd lies between 0.18 and 0.60 and rises with S.

    Fitted here, with monitor_fit_lift, to every second one of 32 means of straight drives, 670 shots whose launch a
    launch monitor measured and whose flight it computed (scenes/golf/published/monitor.csv), and to the 12 PGA Tour
    averages of tour.csv, each set with the same weight. Six numbers are free. The rms errors are

        =========================  ======  ======  =======  ========  ======
                                   carry   apex    landing  at        time
        =========================  ======  ======  =======  ========  ======
        the 16 means fitted to     1.8 yd  1.9 ft  0.5 deg  1.0 mph   0.07 s
        the 16 means left out      1.8     2.2     0.5      1.4       0.06
        the 12 averages fitted to  5.1     6.8     3.6
        LPGA Tour, not fitted      5.8     6.6     3.5
        =========================  ======  ======  =======  ========  ======

    The two sets disagree: at the same speed, launch and spin the tour's long irons come down 4 to 6 deg steeper than
    the monitor's flights, its 3-wood carries 10 yd less, and no function of Re and S has both. With equal regard for
    both, five forms tried are at best 1.25 times 3 yd, 1.0 deg and 1.5 mph off these and 3.2 yd and 2.0 deg off those.
    Tour averages are met by tour_fit_drag, with which the drives are 7.4 yd short, 3.5 deg too steep and 6.0 mph too
    slow.

    The uncertainty of the numbers, by the same fit: critical Re 0.549e5 +- 0.021e5, 0.1835 +- 0.0029, induced drag
    1.43 +- 0.06, Cl 0.380 +- 0.012 at most at Re = 1.2e5, its S 0.173 +- 0.008, its power 0.217 +- 0.037.
    """
    q = reynolds * _EARLY_CRITICAL
    q = q * q
    q = q * q
    lift = monitor_fit_lift(reynolds, spin_ratio)
    return 0.183 + 0.317 / (1.0 + q * q) + 1.42 * lift * lift


@GOLF_LIFT.law(
    "monitor-fit",
    "as of its drag",
    {(1.2e5, 0.173): 0.2402, (0.6e5, 0.173): 0.2062},
    mark="ours",
    reynolds=(0.5e5, 2.2e5),
    spin_ratio=(0.07, 1.07),
)
def monitor_fit_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """``Cl = 0.38 (1 - exp(-S / 0.173)) (Re / 1.2e5)^0.22``: proportional to S at low spin, less of it the slower the
    ball; Re is held inside 0.3e5 to 3e5.

    Fitted here, with monitor_fit_drag; range and errors there.
    """
    fades = (clip(reynolds, 0.3e5, 3e5) * (1.0 / 1.2e5)) ** 0.22
    return 0.38 * (1.0 - exp(spin_ratio * (-1.0 / 0.173))) * fades


@GOLF_DRAG.law(
    "tour-fit",
    "fitted to the 12 averages of the PGA Tour, by tests/reference/fit_golf_ball.py",
    {(1.5e5, 0.2): 0.2736, (0.68e5, 0.0): 0.35},
    mark="ours",
    reynolds=(0.5e5, 2.2e5),
    spin_ratio=(0.07, 1.07),
)
def tour_fit_drag(reynolds: Any, spin_ratio: Any) -> Any:
    """``Cd = 0.20 + 0.30 / (1 + (Re / 0.68e5)^8) + 1.10 Cl^2``, with the Cl of tour_fit_lift.

    A drag polar: 0.20 for the dimpled ball past its drag crisis, 0.50 for a sphere before it (both as measured in wind
    tunnels), a smooth crisis between, and drag induced by lift. Cd lies between 0.20 and 0.62, falls with Re, rises
    with S.

    Fitted here, with tour_fit_lift, to the 12 PGA Tour averages of scenes/golf/published/tour.csv (height, landing
    angle and carry together, each in the unit of 2.9 yd, 3.0 deg, 3.5 yd): the crisis, the induced drag and the two
    numbers of the lift are free, the rest is fixed. Its rms errors are

        ========================================  ======  =======  =====
                                                  height  landing  carry
        ========================================  ======  =======  =====
        the 12 averages fitted to                 1.8 yd  1.7 deg  3.1 yd
        each of them, left out of the fit         2.1     1.9      4.1
        the 11 averages of the LPGA, not fitted   2.3     1.8      3.9
        ========================================  ======  =======  =====

    When left out, the driver is the worst (carry 8.8 yd short): no other club has so little spin at such a speed. The
    uncertainty of the four numbers, by the same fit: critical Re 0.69e5 +- 0.05e5, induced drag 1.08 +- 0.09, Cl
    0.323 +- 0.012 at most, its S 0.126 +- 0.008.

    Its crisis is late for a dimpled ball: it makes flights that a launch monitor computes too steep and too slow at
    their end (monitor_fit_drag).

    tests/reference/fit_golf_ball.py repeats the fit and prints these numbers.

    Covered by these flights: S from 0.07 to 1.07, Re from 0.5e5 to 2.2e5. Beyond, down to a chip at Re = 0.2e5 and up
    to Re = 5e5, the form is a fair guess, not a measurement.
    """
    q = reynolds * _CRITICAL
    q = q * q
    q = q * q
    lift = tour_fit_lift(reynolds, spin_ratio)
    return 0.20 + 0.30 / (1.0 + q * q) + 1.10 * lift * lift


@GOLF_LIFT.law(
    "tour-fit",
    "as of its drag",
    {(1.5e5, 0.2): 0.2577, (1.5e5, 0.126): 0.2048},
    mark="ours",
    reynolds=(0.5e5, 2.2e5),
    spin_ratio=(0.07, 1.07),
)
def tour_fit_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """``Cl = 0.324 (1 - exp(-S / 0.126))``: proportional to S at low spin, at most 0.324.

    Fitted here, with tour_fit_drag; range and errors there. Real lift also fades, and may turn over, below the drag
    crisis (Re under 0.7e5, reverse Magnus effect); that is left out.
    """
    return 0.324 * (1.0 - exp(spin_ratio * (-1.0 / 0.126)))


@GOLF_DRAG.law(
    "smits-smith",
    "Smits & Smith 1994, *Science and Golf II*, 340, by US patent 11230375",
    {(1.5e5, 0.1): 0.3065, (0.9e5, 0.2): 0.276},
    mark="second-hand",
    reynolds=(0.7e5, 2.1e5),
    spin_ratio=(0.08, 0.2),
)
def smits_smith_drag(reynolds: Any, spin_ratio: Any) -> Any:
    """``Cd = 0.24 + 0.18 S + 0.06 sin(pi (Re - 9e4) / 2e5)``; Re is held inside 0 to 2.9e5, S at most 1."""
    wave = sin(3.141592653589793 * (clip(reynolds, 0.0, 2.9e5) - 9e4) / 2e5)
    return 0.24 + 0.18 * clip(spin_ratio, 0.0, 1.0) + 0.06 * wave


@GOLF_LIFT.law(
    "smits-smith",
    "as of its drag",
    {(1.5e5, 0.1): 0.215, (1.5e5, 0.2): 0.2837},
    mark="second-hand",
    reynolds=(0.7e5, 2.1e5),
    spin_ratio=(0.08, 0.2),
)
def smits_smith_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """``Cl = 0.54 S^0.4``; S is held at most 1."""
    return 0.54 * clip(spin_ratio, 0.0, 1.0) ** 0.4


@GOLF_DRAG.law(
    "lyu",
    "Lyu et al. 2018, *MDPI Proceedings* 2(6):238, flights",
    {(1.5e5, 0.1): 0.1798, (1e5, 0.1): 0.211},
    mark="second-hand",
    spin_ratio=(0.0, 0.32),
)
def lyu_drag(reynolds: Any, spin_ratio: Any) -> Any:
    """``Cd = 1.91e-11 Re^2 - 5.40e-6 Re + 0.56``, independent of spin; Re is held at most 2.1e5."""
    re = clip(reynolds, 0.0, 2.1e5)
    return (1.91e-11 * re - 5.40e-6) * re + 0.56


@GOLF_LIFT.law(
    "lyu",
    "as of its drag",
    {(1.5e5, 0.1): 0.1665, (1.5e5, 0.2): 0.268},
    mark="second-hand",
    spin_ratio=(0.0, 0.32),
)
def lyu_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """``Cl = -3.25 S^2 + 1.99 S``; S is held at most 0.306, the parabola's maximum."""
    s = clip(spin_ratio, 0.0, 0.306)
    return (1.99 - 3.25 * s) * s


@GOLF_DRAG.law(
    "usga",
    "the USGA's indoor test range, a ball of the 1990s, by US patent 6186002",
    {(1.5e5, 0.1): 0.2344, (1e5, 0.2): 0.29},
    mark="second-hand",
    reynolds=(0.5e5, 2.5e5),
    spin_ratio=(0.0, 0.35),
)
def usga_drag(reynolds: Any, spin_ratio: Any) -> Any:
    """``Cd = 0.2028 + 2.8466 S^2 + 0.0165 Re - 0.2159 S`` with Re in 1e5; Re is held inside 0.5e5 to 2.5e5, S at most
    0.35."""
    s = clip(spin_ratio, 0.0, 0.35)
    return 0.2028 + (2.8466 * s - 0.2159) * s + 0.0165e-5 * clip(reynolds, 0.5e5, 2.5e5)


@GOLF_LIFT.law(
    "usga",
    "as of its drag",
    {(1.5e5, 0.1): 0.16, (1e5, 0.2): 0.2622},
    mark="second-hand",
    reynolds=(0.5e5, 2.5e5),
    spin_ratio=(0.0, 0.35),
)
def usga_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """``Cl = 0.0860 + 0.6463 S - 0.0122 / Re^2 + 1.4789 S^2`` with Re in 1e5, held as for usga_drag. Below S = 0.02 it
    falls linearly to zero, as a ball without spin has no lift."""
    s = clip(spin_ratio, 0.0, 0.35)
    re = 1e-5 * clip(reynolds, 0.5e5, 2.5e5)
    return (0.0860 + (0.6463 + 1.4789 * s) * s - 0.0122 / (re * re)) * clip(50.0 * s, 0.0, 1.0)


@GOLF_DRAG.law(
    "quadratic",
    "tour averages fitted by others, with a spin decay of 6e-5: numbers from a public repository, "
    "form by McNally, Lambeth & Brekke 2023",
    {(1.5e5, 0.1): 0.2467, (1e5, 0.2): 0.3315},
    mark="second-hand",
    reynolds=(0.5e5, 2.3e5),
    spin_ratio=(0.05, 0.45),
)
def quadratic_drag(reynolds: Any, spin_ratio: Any) -> Any:
    """``Cd = 0.19710 + 0.54852 S - 0.52694 S^2 - 0.09160 (Re/1e5 - 1.5)``; S is held at most 0.52, the parabola's
    maximum, and Re inside 0.3e5 to 2.2e5."""
    s = clip(spin_ratio, 0.0, 0.52)
    return 0.19710 + (0.54852 - 0.52694 * s) * s - 0.09160 * (clip(reynolds, 0.3e5, 2.2e5) * 1e-5 - 1.5)


@GOLF_LIFT.law(
    "quadratic",
    "as of its drag",
    {(1.5e5, 0.1): 0.1897, (1.5e5, 0.2): 0.2847},
    mark="second-hand",
    reynolds=(0.5e5, 2.3e5),
    spin_ratio=(0.05, 0.45),
)
def quadratic_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """``Cl = 0.06628 + 1.37548 S - 1.41620 S^2``; S is held at most 0.4856, the parabola's maximum. Below S = 0.02 it
    falls linearly to zero, as a ball without spin has no lift."""
    s = clip(spin_ratio, 0.0, 0.4856)
    return (0.06628 + (1.37548 - 1.41620 * s) * s) * clip(50.0 * s, 0.0, 1.0)


@GOLF_DRAG.law(
    "power-law",
    "fitted to the 12 averages of the PGA Tour",
    {(1.5e5, 0.1): 0.2659, (1.5e5, 0.2): 0.2985},
    mark="ours",
    spin_ratio=(0.07, 0.9),
)
def power_law_golf_drag(reynolds: Any, spin_ratio: Any) -> Any:
    """``Cd = 0.2333 + 0.3260 S``, independent of speed; S is held at most 1. Simpler than the tour fit and worse."""
    return 0.2333 + 0.3260 * clip(spin_ratio, 0.0, 1.0)


@GOLF_LIFT.law(
    "power-law",
    "as of its drag",
    {(1.5e5, 0.1): 0.2042, (1.5e5, 0.2): 0.2717},
    mark="ours",
    spin_ratio=(0.07, 0.9),
)
def power_law_golf_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """``Cl = 0.5277 S^0.4124``; S is held at most 1."""
    return 0.5277 * clip(spin_ratio, 0.0, 1.0) ** 0.4124


# ------------------------------------------------------------------------------------------------------ soccer ball

#: Reynolds number per m/s of Goff and Carre's ball (0.0375 m^2: 0.2185 m across), air of 1.2 kg/m^3 and 1.8e-5 Pa s.
_GOFF_CARRE = 1.2 * 0.2185 / 1.8e-5

#: Spin ratio at which their drag of a spinning ball is that of a ball without spin, beyond the crisis: 0.041.
_EVEN_SPIN = (0.155 / 0.4127) ** (1.0 / 0.3056)


@SOCCER_DRAG.law(
    "goff-carre",
    "Goff & Carré 2010, *Eur. J. Phys.* 31:775; the part with spin is not verified",
    {(3.6e5, 0.0): 0.155, (3.6e5, 0.2): 0.2524, (0.9e5, 0.0): 0.4975},
    mark="second-hand",
)
def goff_carre_drag(reynolds: Any, spin_ratio: Any) -> Any:
    """``Cd = a + (0.501 - a) / (1 + exp((v - 12.19) / 1.309))`` with ``a = 0.155`` without spin and ``a = 0.4127
    S^0.3056`` with it, once that exceeds 0.155 (S = 0.041); v in m/s is ``Re / 1.457e4``, of the source's ball and air.

    The drag crisis is at v = 12.19 m/s. The source switches abruptly at S = 0.05 and 12.19 m/s; here the transition is
    smooth. S is held at most 1; at low speed Cd stays at 0.501, at any spin.
    """
    beyond = 0.4127 * clip(spin_ratio, _EVEN_SPIN, 1.0) ** 0.3056
    crisis = clip((reynolds / _GOFF_CARRE - 12.19) / 1.309, -50.0, 50.0)
    return beyond + (0.501 - beyond) / (1.0 + exp(crisis))


@SOCCER_DRAG.law(
    "textbook",
    "textbooks, simplified: a smooth sphere on one side, a ball past its drag crisis on the other",
    {(1.2e5, 0.2): 0.3271, (1.35e5, 0.0): 0.22},
    mark="second-hand",
)
def textbook_soccer_drag(reynolds: Any, spin_ratio: Any) -> Any:
    """``Cd`` is 0.47 below Re = 1e5, 0.22 above 1.35e5, a straight line between; independent of spin."""
    return 0.47 - 0.25 * clip((reynolds - 1e5) / 0.35e5, 0.0, 1.0)


@SOCCER_LIFT.law(
    "pooled",
    "fitted to Asai 2007, Passmore 2012, Bray & Kerwin 2003 and Goff & Carré 2009, "
    "by tests/reference/fit_soccer_lift.py",
    {(4e5, 0.10): 0.185, (4e5, 0.20): 0.27, (4e5, 0.24): 0.26, (4e5, 0.71): 0.31},
    within=0.02,
    mark="ours",
    reynolds=(3e5, inf),
    spin_ratio=(0.05, 0.7),
)
def pooled_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """``Cl = 0.301 (1 - exp(-S / 0.108))``: proportional to S at low spin, at most 0.301.

    Fitted here to four sources, each with the same weight, beyond the drag crisis (Re above 3e5):

    - Asai et al. 2007, Sports Eng. 10:101, wind tunnel: 0.21 at S 0.18, 0.24 at 0.22, 0.29 at 0.34; and the medians of
      five series, 0.05 at S 0.05, 0.22 at 0.11, 0.24 at 0.16, 0.29 at 0.20, 0.29 at 0.27;
    - Passmore et al. 2012, Proc. IMechE P 226:179, wind tunnel, 30 m/s: 0.185 at S 0.10, 0.27 at 0.20;
    - Bray & Kerwin 2003, J. Sports Sci. 21:75, ten filmed free kicks, 23 to 28 m/s: 0.23 to 0.29 (S taken as 0.24);
    - Goff & Carre 2009, Am. J. Phys. 77:1020, filmed: 0.285 at S 0.49, 0.31 at 0.71.

    All second-hand. The rms distance of these 13 points is 0.025; no source left out changes Cl by more than 0.009
    between S 0.1 and 0.7. Two disagree: at 20 m/s Passmore has less, 0.135 at S 0.20 and 0.205 at 0.29, where the drag
    crisis is not over; Mencke 2020 has more, 0.5 at S 0.25 to 0.33 (mencke_lift).

    tests/reference/fit_soccer_lift.py repeats the fit and prints these numbers.
    """
    return 0.301 * (1.0 - exp(spin_ratio * (-1.0 / 0.108)))


@SOCCER_LIFT.law(
    "mencke",
    "fitted to one filmed kick of Mencke et al. 2020, *Am. J. Phys.* 88:934, digitised",
    {(2.7e5, 0.28): 0.5, (2.7e5, 0.27): 0.4957},
    within=0.01,
    mark="second-hand",
    spin_ratio=(0.25, 0.33),
)
def mencke_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """``Cl = 0.54 (1 - exp(-S / 0.108))``, 1.8 times pooled_lift: the most lift that was measured.

    Fitted here to one filmed kick of (20, 2.5, 4.9) m/s with -46 rad/s about the upright, S 0.25 to 0.33, with drag by
    goff_carre_drag: its sideways track is met to 8 cm, 6 cm rms. The shape over S is that of pooled_lift. With the
    direction of the launch fitted, too, 6.2 deg in place of 7.1, it is 1.65 times pooled_lift.
    """
    return 0.54 * (1.0 - exp(spin_ratio * (-1.0 / 0.108)))


@SOCCER_LIFT.law(
    "asai",
    "Asai et al. 2007, *Sports Eng.* 10:101, wind tunnel; the curve between and beyond the points is *ours*",
    {(3.6e5, 0.18): 0.21, (3.6e5, 0.22): 0.24, (3.6e5, 0.34): 0.29},
    within=0.0031,
    mark="second-hand",
    spin_ratio=(0.18, 0.34),
)
def asai_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """``Cl = 0.498 S / (0.242 + S)``; other sources have more below S = 0.3, and less above.

    The curve starts proportional to S, as lift must, and levels off at 0.498.
    """
    return 0.498 * spin_ratio / (0.242 + spin_ratio)


@SOCCER_LIFT.law(
    "power-law",
    "textbooks",
    {(3.6e5, 0.22): 0.2637, (4e5, 0.2): 0.2575},
    mark="second-hand",
)
def power_law_soccer_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """``Cl = 0.385 S^0.25``, S held at most 1; too large at low spin."""
    return 0.385 * clip(spin_ratio, 0.0, 1.0) ** 0.25


# ------------------------------------------------------------------------------------------------------ tennis ball


TENNIS_DRAG.law(
    "cross-lindsey",
    "Cross & Lindsey 2013, flights of 15 to 30 m/s and up to 2,500 rpm: 0.507 ± 0.024, whatever the spin; wind tunnels "
    "give 0.6 to 0.7 without spin",
    {(1e5, 0.1): 0.507, (1.4e5, 0.3): 0.507},
)(Constant(0.507))


@TENNIS_DRAG.law(
    "stepanek",
    "Štěpánek 1988, *Am. J. Phys.* 56:138, wind tunnel, by Gander & Hřebíček, *Solving Problems in Scientific "
    "Computing*, chapter 1",
    {(1e5, 0.3): 0.6622, (1e5, 0.0): 0.508},
    mark="second-hand",
    spin_ratio=(0.05, 0.6),
)
def stepanek_drag(reynolds: Any, spin_ratio: Any) -> Any:
    """``Cd = 0.508 + (22.053 + 4.196 S^-2.5)^-0.4``: 0.508 without spin, 0.80 at most, independent of speed."""
    s = clip(spin_ratio, 1e-6, 1e6)
    return 0.508 + (22.053 + 4.196 * s**-2.5) ** -0.4


@TENNIS_DRAG.law(
    "gossard-fit",
    "fitted to 71 tracked flights of table tennis balls of Gossard et al. 2023 (arXiv 2303.03879) by "
    "tests/reference/fit_table_tennis.py, and without spin to a throw that Mencke et al. 2020, *Am. J. Phys.* 88:934, "
    "filmed",
    {(2e4, 0.0): 0.456, (2e4, 0.145): 0.5344},
    mark="ours",
    reynolds=(1.3e4, 4e4),
    spin_ratio=(0.0, 2.0),
)
def gossard_fit_drag(reynolds: Any, spin_ratio: Any) -> Any:
    """Table tennis: ``Cd = 0.456 + 0.124 (1 - exp(-S / 0.145))``: 0.456 without spin, 0.58 at most, at 5 to 15 m/s.

    The two numbers were fitted to every second flight: 0.124 +- 0.014, 0.145 +- 0.063. The median of the 64 others is
    0.002 less than this; single flights scatter by 0.032 (median distance), about a constant by 0.039.
    """
    return 0.456 + 0.124 * (1.0 - exp(spin_ratio * (-1.0 / 0.145)))


@TENNIS_LIFT.law(
    "stepanek",
    "as of its drag; a table tennis ball borrows it (assumed)",
    {(1e5, 0.3): 0.189, (1e5, 0.1): 0.0845},
    mark="second-hand",
    spin_ratio=(0.05, 0.6),
)
def stepanek_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """``Cl = S / (0.981 + 2.022 S)``: nearly S at low spin, 0.49 at most."""
    return spin_ratio / (0.981 + 2.022 * spin_ratio)


@TENNIS_LIFT.law(
    "lift-crisis",
    "Miyazaki et al. 2017, *Eur. J. Phys.* 38:024001, of which the abstract was read: one point; the rest is *assumed*",
    {(9e4, 0.5): 0.0, (3e4, 0.5): 0.251},
    mark="assumed",
    reynolds=(3e4, 9e4),
    spin_ratio=(0.0, 1.0),
)
def lift_crisis(reynolds: Any, spin_ratio: Any) -> Any:
    """Table tennis: ``Cl = stepanek_lift (1 - a exp(-((S - 0.5) / 0.15)^2))``, ``a = (Re - 3e4) / 6e4``, held between 0
    and 1.

    Measured in flight: a deep valley of the lift around S = 0.5, with almost none left at Re = 9e4 and S = 0.48 to
    0.50. Only that point is from the source; the width of the valley, its growth with Re and the lift beside it, a
    tennis ball's, are assumed.
    """
    depth = clip((reynolds - 3e4) / 6e4, 0.0, 1.0)
    off = (clip(spin_ratio, 0.0, 10.0) - 0.5) / 0.15
    return stepanek_lift(reynolds, spin_ratio) * (1.0 - depth * exp(-off * off))


# --------------------------------------------------------------------------------------------------------- baseball


@dataclass(frozen=True)
class NathanDrag:
    """``Cd = 0.3008 + 0.0292 (spin / 1000 rpm)``, with ``turns`` rpm for each unit of Re S, by default those of a
    baseball in air of 20 C.

    Re S is ``2 r^2 rho w / mu``: the spin, whatever the speed. Fitted to fly balls tracked in the major leagues, 40 to
    50 m/s and 1,000 to 3,000 rpm.
    """

    turns: float = 0.0521

    def __call__(self, reynolds: Any, spin_ratio: Any) -> Any:
        return nathan_drag(reynolds, spin_ratio, self.turns)


def nathan_drag(reynolds: Any, spin_ratio: Any, turns: Any) -> Any:
    """The coefficient of NathanDrag."""
    return 0.3008 + 0.0292e-3 * turns * reynolds * spin_ratio


BASEBALL_DRAG.law(
    "nathan",
    "Nathan 2016, *Trajectory calculator*, by pybaseball: fly balls of 40 to 50 m/s and 1,000 to 3,000 rpm",
    {(1.8e5, 0.0): 0.3008, (1.8e5, 0.2): 0.3556},
    mark="second-hand",
)(NathanDrag())


@BASEBALL_LIFT.law("nathan", "as of its drag", {(1e5, 0.2): 0.2134, (1e5, 0.3): 0.2619}, mark="second-hand")
def nathan_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """``Cl = 1.120 S / (0.583 + 2.333 S)``, at most 0.48."""
    return 1.120 * spin_ratio / (0.583 + 2.333 * spin_ratio)


@BASEBALL_LIFT.law(
    "sawicki",
    "Sawicki, Hubbard & Stronge 2003, *Am. J. Phys.* 71:1152",
    {(1e5, 0.05): 0.075, (1e5, 0.3): 0.27},
    mark="second-hand",
)
def sawicki_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """``Cl = 1.5 S`` below S = 0.1, ``0.09 + 0.6 S`` above; S is held at most 1."""
    s = clip(spin_ratio, 0.0, 1.0)
    return 0.9 * clip(s, 0.0, 0.1) + 0.6 * s


@BASEBALL_DRAG.law(
    "pitch-fit",
    "fitted to 1,254 pitches of 30 to 45 m/s of 3 September 2020, by tests/reference/fit_pitches.py",
    {(1.8e5, 0.0): 0.299, (1.8e5, 0.2): 0.3336},
    mark="ours",
    spin_ratio=(0.05, 0.35),
)
def pitch_fit_drag(reynolds: Any, spin_ratio: Any) -> Any:
    """A pitch: ``Cd = 0.299 + 0.76 Cl^2``, with the Cl of nathan_lift at the active spin: a drag polar.

    The drag of each pitch follows from how its tracked speed falls (Kagan & Nathan 2014, Phys. Teach. 52:278; method of
    the abstract). Fitted here to 1,254 pitches of 3 September 2020 in eight parks (Statcast), every second one of each
    pitcher, with air of 70 F at sea level for all, as their weather is not known; 30 to 45 m/s, S from 0.05 to 0.35.
    Single pitches scatter by 0.020 about it; speed and gyro spin add nothing. The mean drag of other days differs by
    up to 9 %: 0.023 more in 4,220 other pitches, 0.029 less in those of one pitcher in July 2019, by air and by lots of
    balls.

    tests/reference/fit_pitches.py repeats the fit.
    """
    lift = nathan_lift(reynolds, spin_ratio)
    return 0.299 + 0.76 * lift * lift


# ------------------------------------------------------------------------------------------------------- volleyball


@VOLLEYBALL_DRAG.law(
    "hong",
    "Hong, Ozaki, Watanabe & Asai 2020, *Appl. Sci.* 10:3256; where and how steeply it falls is *assumed*",
    {(2.6e5, 0.0): 0.15, (2.9e5, 0.0): 0.17},
    within=0.015,
)
def hong_drag(reynolds: Any, spin_ratio: Any) -> Any:
    """``Cd = 0.16 + 0.31 / (1 + exp((Re - 2.1e5) / 0.12e5))``: 0.47 for a slow ball, 0.16 for a fast one, past the drag
    crisis at Re = 2.1e5 (15 m/s).

    A Mikasa V200W has least drag with 0.15 at Re = 2.6e5 or 0.17 at 2.9e5, by the side that it turns to the wind.
    Thomas 2012 (thesis, University of Washington) calls other balls supercritical from Re = 2e5 on.
    """
    return 0.16 + 0.31 / (1.0 + exp(clip((reynolds - 2.1e5) / 0.12e5, -50.0, 50.0)))
