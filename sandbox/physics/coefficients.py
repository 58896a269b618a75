"""Drag and lift coefficients, named by their paper.

Each is a function of the Reynolds number ``Re = rho |u| 2 r / mu`` and the spin ratio ``S = r |w| / |u|``, where u is
the velocity relative to the air. Floats, or arrays of shape (n,).

Each docstring gives the formula, its measured range, its behaviour outside, and its source. Where a formula would
become negative or grow without bound, its argument is clamped. "Second-hand" means that the formula was taken from a
quotation, not from the paper.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from sandbox.physics.elementwise import clip, exp, sin

#: coefficient(reynolds, spin_ratio) -> dimensionless
Coefficient = Callable[[Any, Any], Any]


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


def spin_ratio_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """``Cl = S``: the textbook's simplest lift, linear in spin. A fair guess for S below 0.3, far too large above 1."""
    return spin_ratio


# -------------------------------------------------------------------------------------------------------- golf ball

_CRITICAL = 1.0 / 0.68e5


def tour_fit_drag(reynolds: Any, spin_ratio: Any) -> Any:
    """Golf ball: ``Cd = 0.20 + 0.30 / (1 + (Re / 0.68e5)^8) + 1.10 Cl^2``, with the Cl of tour_fit_lift.

    A drag polar: 0.20 for the dimpled ball past its drag crisis, 0.50 for a sphere before it (both as measured in wind
    tunnels), a smooth crisis between, and drag induced by lift. Cd lies between 0.20 and 0.62, falls with Re, rises
    with S.

    Fitted here, with tour_fit_lift, to the 12 PGA Tour averages of lab/published/golf_tour.csv (height, landing
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

    tests/reference/fit_golf_ball.py repeats the fit and prints these numbers.

    Covered by these flights: S from 0.07 to 1.07, Re from 0.5e5 to 2.2e5. Beyond, down to a chip at Re = 0.2e5 and up
    to Re = 5e5, the form is a fair guess, not a measurement.
    """
    q = reynolds * _CRITICAL
    q = q * q
    q = q * q
    lift = tour_fit_lift(reynolds, spin_ratio)
    return 0.20 + 0.30 / (1.0 + q * q) + 1.10 * lift * lift


def tour_fit_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """Golf ball: ``Cl = 0.324 (1 - exp(-S / 0.126))``: proportional to S at low spin, at most 0.324.

    Fitted here, with tour_fit_drag; range and errors there. Real lift also fades, and may turn over, below the drag
    crisis (Re under 0.7e5, reverse Magnus effect); that is left out.
    """
    return 0.324 * (1.0 - exp(spin_ratio * (-1.0 / 0.126)))


def smits_smith_drag(reynolds: Any, spin_ratio: Any) -> Any:
    """Golf ball: ``Cd = 0.24 + 0.18 S + 0.06 sin(pi (Re - 9e4) / 2e5)``.

    Measured for Re 0.7e5 to 2.1e5 and S 0.08 to 0.2; Re is held inside 0 to 2.9e5, S at most 1.
    Source: Smits & Smith 1994, Science and Golf II, 340; second-hand, US patent 11230375.
    """
    wave = sin(3.141592653589793 * (clip(reynolds, 0.0, 2.9e5) - 9e4) / 2e5)
    return 0.24 + 0.18 * clip(spin_ratio, 0.0, 1.0) + 0.06 * wave


def smits_smith_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """Golf ball: ``Cl = 0.54 S^0.4``; measured for S 0.08 to 0.2, S held at most 1. Source: as for smits_smith_drag."""
    return 0.54 * clip(spin_ratio, 0.0, 1.0) ** 0.4


def lyu_drag(reynolds: Any, spin_ratio: Any) -> Any:
    """Golf ball: ``Cd = 1.91e-11 Re^2 - 5.40e-6 Re + 0.56``, independent of spin; Re clamped to at most 2.1e5.

    Measured in flight for S up to 0.32. Source: Lyu et al. 2018, MDPI Proceedings 2(6):238; second-hand.
    """
    re = clip(reynolds, 0.0, 2.1e5)
    return (1.91e-11 * re - 5.40e-6) * re + 0.56


def lyu_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """Golf ball: ``Cl = -3.25 S^2 + 1.99 S``, S held at most 0.306, the parabola's maximum. Source: as for lyu_drag."""
    s = clip(spin_ratio, 0.0, 0.306)
    return (1.99 - 3.25 * s) * s


def quadratic_drag(reynolds: Any, spin_ratio: Any) -> Any:
    """Golf ball: ``Cd = 0.19710 + 0.54852 S - 0.52694 S^2 - 0.09160 (Re/1e5 - 1.5)``.

    A fit, not made here, to the 23 tour averages of lab/published/golf_tour.csv, with a spin decay of 6e-5; S 0.05
    to 0.45, Re 0.5e5 to 2.3e5. S is held at most 0.52, the parabola's maximum, and Re inside 0.3e5 to 2.2e5.
    Source: numbers from a public repository, form from McNally, Lambeth & Brekke 2023; second-hand.
    """
    s = clip(spin_ratio, 0.0, 0.52)
    return 0.19710 + (0.54852 - 0.52694 * s) * s - 0.09160 * (clip(reynolds, 0.3e5, 2.2e5) * 1e-5 - 1.5)


def quadratic_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """Golf ball: ``Cl = 0.06628 + 1.37548 S - 1.41620 S^2``, S held at most 0.4856, the parabola's maximum.

    Below S = 0.02 it falls linearly to zero, as a ball without spin has no lift. Source: as for quadratic_drag.
    """
    s = clip(spin_ratio, 0.0, 0.4856)
    return (0.06628 + (1.37548 - 1.41620 * s) * s) * clip(50.0 * s, 0.0, 1.0)


def power_law_golf_drag(reynolds: Any, spin_ratio: Any) -> Any:
    """Golf ball: ``Cd = 0.2333 + 0.3260 S``, independent of speed; S clamped to at most 1.

    Fitted for this project to the PGA Tour averages of lab/published/golf_tour.csv, S 0.07 to 0.9.
    """
    return 0.2333 + 0.3260 * clip(spin_ratio, 0.0, 1.0)


def power_law_golf_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """Golf ball: ``Cl = 0.5277 S^0.4124``, S held at most 1. Source: as for power_law_golf_drag."""
    return 0.5277 * clip(spin_ratio, 0.0, 1.0) ** 0.4124


def usga_drag(reynolds: Any, spin_ratio: Any) -> Any:
    """Golf ball: ``Cd = 0.2028 + 2.8466 S^2 + 0.0165 Re - 0.2159 S`` with Re in 1e5.

    Re is held inside 0.5e5 to 2.5e5, S at most 0.35. A ball of the 1990s.
    Source: the USGA's indoor test range; second-hand, US patent 6186002.
    """
    s = clip(spin_ratio, 0.0, 0.35)
    return 0.2028 + (2.8466 * s - 0.2159) * s + 0.0165e-5 * clip(reynolds, 0.5e5, 2.5e5)


def usga_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """Golf ball: ``Cl = 0.0860 + 0.6463 S - 0.0122 / Re^2 + 1.4789 S^2`` with Re in 1e5, held as for usga_drag.

    Below S = 0.02 it falls linearly to zero, as a ball without spin has no lift. Source: as for usga_drag.
    """
    s = clip(spin_ratio, 0.0, 0.35)
    re = 1e-5 * clip(reynolds, 0.5e5, 2.5e5)
    return (0.0860 + (0.6463 + 1.4789 * s) * s - 0.0122 / (re * re)) * clip(50.0 * s, 0.0, 1.0)


#: Models of a golf ball, by name. Drag and lift of one name belong together: their rms errors on the PGA Tour averages
#: of lab/published/golf_tour.csv are (height in yd, landing angle in deg, carry in yd) 1.8/1.7/3.1 for tour-fit,
#: 3.2/2.8/3.7 for quadratic, 2.3/4.2/5.9 for power-law, 3.8/6.6/11.9 for smits-smith, 2.5/2.4/16.4 for usga, and
#: 12.9/4.8/59.2 for lyu, which has no spin-induced drag.
GOLF_DRAG: dict[str, Coefficient] = {
    "tour-fit": tour_fit_drag,
    "smits-smith": smits_smith_drag,
    "lyu": lyu_drag,
    "usga": usga_drag,
    "quadratic": quadratic_drag,
    "power-law": power_law_golf_drag,
}
GOLF_LIFT: dict[str, Coefficient] = {
    "tour-fit": tour_fit_lift,
    "smits-smith": smits_smith_lift,
    "lyu": lyu_lift,
    "usga": usga_lift,
    "quadratic": quadratic_lift,
    "power-law": power_law_golf_lift,
}


# ------------------------------------------------------------------------------------------------------ soccer ball

#: Reynolds number per m/s of Goff and Carre's ball (0.0375 m^2: 0.2185 m across), air of 1.2 kg/m^3 and 1.8e-5 Pa s.
_GOFF_CARRE = 1.2 * 0.2185 / 1.8e-5

#: Spin ratio at which their drag of a spinning ball is that of a ball without spin, beyond the crisis: 0.041.
_EVEN_SPIN = (0.155 / 0.4127) ** (1.0 / 0.3056)


def goff_carre_drag(reynolds: Any, spin_ratio: Any) -> Any:
    """Soccer ball: ``Cd = a + (0.501 - a) / (1 + exp((v - 12.19) / 1.309))`` with ``a = 0.155`` without spin.

    The drag crisis is at v = 12.19 m/s; v stands for ``Re / 1.457e4``, the source's ball and air. Beyond the crisis
    spin raises drag to ``a = 0.4127 S^0.3056``, here once that exceeds 0.155 (S = 0.041). The source switches
    abruptly at S = 0.05 and 12.19 m/s; here the transition is smooth. S is held at most 1; at low speed Cd stays at
    0.501, at any spin. Source: Goff & Carre 2010, Eur. J. Phys. 31:775, second-hand; the part with spin is not
    verified.
    """
    beyond = 0.4127 * clip(spin_ratio, _EVEN_SPIN, 1.0) ** 0.3056
    crisis = clip((reynolds / _GOFF_CARRE - 12.19) / 1.309, -50.0, 50.0)
    return beyond + (0.501 - beyond) / (1.0 + exp(crisis))


def textbook_soccer_drag(reynolds: Any, spin_ratio: Any) -> Any:
    """Soccer ball: ``Cd`` 0.47 below Re = 1e5, 0.22 above 1.35e5, a straight line between; independent of spin.

    A smooth sphere on one side, a ball past its drag crisis on the other. Source: a textbook simplification,
    second-hand.
    """
    return 0.47 - 0.25 * clip((reynolds - 1e5) / 0.35e5, 0.0, 1.0)


def pooled_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """Soccer ball: ``Cl = 0.301 (1 - exp(-S / 0.108))``: proportional to S at low spin, at most 0.301.

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


def mencke_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """Soccer ball: ``Cl = 0.54 (1 - exp(-S / 0.108))``, 1.8 times pooled_lift: the most lift that was measured.

    Fitted here to one filmed kick of (20, 2.5, 4.9) m/s with -46 rad/s about the upright, S 0.25 to 0.33, with drag by
    goff_carre_drag: its sideways track is met to 8 cm, 6 cm rms. The shape over S is that of pooled_lift. With the
    direction of the launch fitted, too, 6.2 deg in place of 7.1, it is 1.65 times pooled_lift.
    Source: Mencke et al. 2020, Am. J. Phys. 88:934; second-hand, digitised.
    """
    return 0.54 * (1.0 - exp(spin_ratio * (-1.0 / 0.108)))


def asai_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """Soccer ball: ``Cl = 0.498 S / (0.242 + S)``: 0.21 at S 0.18, 0.24 at 0.22 and 0.29 at 0.34, each within 0.003.

    Between and beyond these points the curve is ours: it starts proportional to S, as lift must, and levels off at
    0.498. Others measured more below S = 0.3 and less above (pooled_lift). Source of the points: Asai et al. 2007,
    Sports Eng. 10:101, second-hand.
    """
    return 0.498 * spin_ratio / (0.242 + spin_ratio)


def power_law_soccer_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """Soccer ball: ``Cl = 0.385 S^0.25``, S held at most 1; too large at low spin. Source: textbooks, second-hand."""
    return 0.385 * clip(spin_ratio, 0.0, 1.0) ** 0.25


#: Models of a soccer ball, by name.
SOCCER_DRAG: dict[str, Coefficient] = {"goff-carre": goff_carre_drag, "textbook": textbook_soccer_drag}
SOCCER_LIFT: dict[str, Coefficient] = {
    "pooled": pooled_lift,
    "mencke": mencke_lift,
    "asai": asai_lift,
    "power-law": power_law_soccer_lift,
}


# ------------------------------------------------------------------------------------------------------ tennis ball


def stepanek_drag(reynolds: Any, spin_ratio: Any) -> Any:
    """Tennis ball: ``Cd = 0.508 + (22.053 + 4.196 S^-2.5)^-0.4``: 0.508 without spin, 0.80 at most.

    Measured in a wind tunnel for S 0.05 to 0.6, independent of speed. Source: Stepanek 1988, Am. J. Phys. 56:138;
    second-hand, Gander & Hrebicek, Solving Problems in Scientific Computing, chapter 1.
    """
    s = clip(spin_ratio, 1e-6, 1e6)
    return 0.508 + (22.053 + 4.196 * s**-2.5) ** -0.4


def stepanek_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """Tennis ball: ``Cl = S / (0.981 + 2.022 S)``: nearly S at low spin, 0.49 at most. Source: as for stepanek_drag."""
    return spin_ratio / (0.981 + 2.022 * spin_ratio)


def lift_crisis(reynolds: Any, spin_ratio: Any) -> Any:
    """Table tennis ball: ``stepanek_lift (1 - a exp(-((S - 0.5) / 0.15)^2))``, a = 0 at Re = 3e4, 1 at 9e4, held there.

    Measured in flight for Re 3e4 to 9e4 and S up to 1: a deep valley of the lift around S = 0.5, with almost none left
    at Re = 9e4 and S = 0.48 to 0.50. Only that point is from the source; the width of the valley, its growth with Re
    and the lift beside it, a tennis ball's, are assumed. Source: Miyazaki, Sakai, Komatsu, Takahashi & Himeno 2017,
    Eur. J. Phys. 38:024001, of which the abstract was read.
    """
    depth = clip((reynolds - 3e4) / 6e4, 0.0, 1.0)
    off = (clip(spin_ratio, 0.0, 10.0) - 0.5) / 0.15
    return stepanek_lift(reynolds, spin_ratio) * (1.0 - depth * exp(-off * off))


#: Models of a tennis ball, by name. In free flight, 15 to 30 m/s and up to 2,500 rpm, the drag coefficient is 0.507 +-
#: 0.024, whatever the spin: Cross & Lindsey 2013.
TENNIS_DRAG: dict[str, Coefficient] = {"cross-lindsey": Constant(0.507), "stepanek": stepanek_drag}
TENNIS_LIFT: dict[str, Coefficient] = {"stepanek": stepanek_lift, "lift-crisis": lift_crisis}


# --------------------------------------------------------------------------------------------------------- baseball


@dataclass(frozen=True)
class NathanDrag:
    """Baseball: ``Cd = 0.3008 + 0.0292 (spin / 1000 rpm)``, with ``turns`` rpm for each unit of Re S.

    Re S is ``2 r^2 rho w / mu``: the spin, whatever the speed. Fitted to fly balls tracked in the major leagues, 40 to
    50 m/s and 1,000 to 3,000 rpm. Source: Nathan 2016, trajectory calculator; second-hand (pybaseball).
    """

    turns: float

    def __call__(self, reynolds: Any, spin_ratio: Any) -> Any:
        return 0.3008 + 0.0292e-3 * self.turns * reynolds * spin_ratio


def nathan_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """Baseball: ``Cl = 1.120 S / (0.583 + 2.333 S)``, at most 0.48. Source: as for NathanDrag."""
    return 1.120 * spin_ratio / (0.583 + 2.333 * spin_ratio)


def sawicki_lift(reynolds: Any, spin_ratio: Any) -> Any:
    """Baseball: ``Cl = 1.5 S`` below S = 0.1, ``0.09 + 0.6 S`` above; S held at most 1.

    Source: Sawicki, Hubbard & Stronge 2003, Am. J. Phys. 71:1152; second-hand.
    """
    s = clip(spin_ratio, 0.0, 1.0)
    return 0.9 * clip(s, 0.0, 0.1) + 0.6 * s


def pitch_fit_drag(reynolds: Any, spin_ratio: Any) -> Any:
    """Baseball, pitched: ``Cd = 0.299 + 0.76 Cl^2``, with the Cl of nathan_lift at the active spin: a drag polar.

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


#: Models of a baseball, by name; the drag also depends on the spin itself, so that a scene makes it.
BASEBALL_LIFT: dict[str, Coefficient] = {"nathan": nathan_lift, "sawicki": sawicki_lift}
