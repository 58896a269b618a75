"""Tolerances of the engine: differences that count as rounding, and gaps and speeds that count as zero.

Coordinates are floats with 16 digits: at 100 m their rounding is 1e-14 m, and a few operations make it 1e-13 m. The
lengths below rise from that in steps of about ten, and their order is what matters: a contact is found at an overlap of
SKIN, which must be more than any rounding, and is still a contact when it is resolved, up to a gap of TOUCHING_GAP.

Lengths, speeds and fractions say what broke when they were made a thousand times larger or smaller, in the results of
all scenes and presets, and in the tests of contacts and bodies; times say what would.
"""

from __future__ import annotations

# Lengths ------------------------------------------------------------------------------------------------------------

#: Change of a gap in m that is rounding: a path closer than this to parallel neither closes nor opens a gap.
#: Larger: spinning bodies touch without being noticed, and endless series of bounces do not end. Smaller: a tumbling
#: box that comes to rest meets the floor by rounding again and again, and the run never ends.
GAP_ROUNDING = 1e-13

#: Overlap in m that is rounding: it is neither corrected at the start, nor does it press balls on one another.
#: Larger: nothing seen. Smaller: only the chaotic bounces of a football change.
NEGLIGIBLE_OVERLAP = 1e-12

#: Distance in m along a straight side within which a ball or body is at the side's end.
#: Larger: nothing seen. Smaller: a ball that rolls across a seam in a batch differs from the same ball alone.
SEAM = 1e-11

#: Overlap in m at which two shapes count as touching. Positive, so that a ball rolling across the seam of two flush
#: surfaces, which rounding offsets by 1e-13 m at 1 km, does not touch the second one. An impact on a round shape
#: multiplies it by ten or more. Larger: most results change by 1e-9 of their size, and a contact deeper than
#: TOUCHING_GAP in a valley of two surfaces is lost. Smaller: rounding decides touches of bodies that graze.
SKIN = 2e-11

#: Largest gap in m at which shapes count as in contact when an impact or a new contact is resolved.
#: Larger: balls apart by 0.1 um are resolved together, and racks and heaps come out differently. Smaller than SKIN: a
#: contact is found, is none when it is resolved, is found again, and the run never ends.
TOUCHING_GAP = 1e-10

#: Difference in m of two distances below which points of an outline are equally near: both touch.
#: Larger: nothing seen. Smaller: the two corners of a side that lies flat take turns, and some runs of bodies take many
#: times as long.
EQUALLY_NEAR = 1e-10

#: Depth in m up to which overlapping outlines only touch: the normal found first is the right one. In deeper ones the
#: shallowest way out is searched for. Larger: no scene changes. Smaller: the chaotic bounces of a football change.
SHALLOW = 1e-9

# Speeds and accelerations -------------------------------------------------------------------------------------------

#: Speed in m/s, away from a surface or along it, or spin in rad/s, that is rounding: slower is at rest.
#: A thousand times larger or smaller: nothing seen.
STILL = 1e-10

#: Slip in m/s, or spin in rad/s, that is rounding where a motion begins with none, and then has some before it ends.
#: Larger: a short slide is lost, and its ball or body starts it again and again. Smaller: the start of a slide, where
#: rounding leaves 1e-16 m/s, is taken for its end, and the run never ends.
STARTING = 1e-14

#: Speed of approach in m/s below which it is rounding and not an impact; and difference of speeds that is none.
#: Larger: balls that lie on one another pass on slow pushes late (1e-6 m/s). Smaller: cradles exchange rounding as
#: impacts, and their times change by 1e-7 s.
CLOSING = 1e-9

#: Acceleration in m/s^2, or rad/s^2 times the radius, that is rounding: nothing pushes.
#: A thousand times larger or smaller: nothing seen.
PUSH = 1e-9

# Shares -------------------------------------------------------------------------------------------------------------

#: Share of a quantity that is rounding: of a force, of the available grip, of a step, of a length, of a unit vector (as
#: the sine of an angle). A thousand times larger or smaller: nothing seen. Near 1e-15 a ball that needs all its grip to
#: roll would slide by rounding.
ROUNDING = 1e-9

#: Share of the speeds of two bodies that is rounding in the speed at which they part: Chipmunk's iterations leave more
#: than arithmetic does. A thousand times larger or smaller: nothing seen.
PARTING = 1e-7

#: Cosine of the angle between two normals above which their surfaces are flush, and count as one: 1.4e-6 rad.
#: An angle 30 times larger or smaller: nothing seen.
FLUSH = 1.0 - 1e-12

# Times --------------------------------------------------------------------------------------------------------------

#: Time in s from a discontinuity of the forces within which a step has reached it. Larger by much: a step begins before
#: a jump of the force and loses its order. Smaller than the rounding of the time: steps of that length are tried.
AT_DISCONTINUITY = 1e-12

#: Shortest step, as a share of the time, of at least 1 s: shorter ones are rounding. Larger: forces that change fast
#: are refused earlier. Smaller: time stands still, and no error says so.
SHORTEST_STEP = 1e-15

# Division by zero ---------------------------------------------------------------------------------------------------

#: Added to a divisor that may be zero, or its least value; negligible compared with any other.
TINY = 1e-300

# Energy -------------------------------------------------------------------------------------------------------------

#: Relative gain of energy in an impact that ends the run. Less: rounding in Chipmunk's iterations is an error; more:
#: energy from nothing is not noticed.
CREATED = 1e-6
