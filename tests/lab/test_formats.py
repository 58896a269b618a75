"""Tables of devices: what is read of a file of each kind, rows in the form in which it writes them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import sandbox
from sandbox.errors import RequestError
from sandbox.lab.expression import parse
from sandbox.lab.formats import forms
from sandbox.lab.mapped import EVERYTHING, Choices, Mapped, read_shots
from sandbox.lab.selection import LeftOut
from sandbox.lab.table_file import read_table


def read(folder: Path, text: str, scene: str = "golf", choices: Choices = EVERYTHING) -> Mapped:
    (folder / "shots.csv").write_text(text, "utf-8")
    return read_shots(sandbox.load(scene), read_table("", folder / "shots.csv"), choices)


AVERAGE = LeftOut(2, "averages of other rows")

#: Two rows of each device: a shot of 120 mph, 17.2 deg and 1.2 deg to the right, and an average or a shot without a
#: result; then what is read of the first, in SI.
FILES = {
    "flightscope": (
        "Shot,club,Ball (mph),Smash,Carry (yds),Total (yds),Height (ft),Time (s),Lateral (yds),Spin (rpm),"
        "Spin Axis (°),AOA (°),Launch V (°),Launch H (°),Descent V (°),Shot Type\n"
        "1,7i,120,1.37,165,171,92,6.1,6 L,6400,3.0 L,-3,17.2,1.2 R,45,Draw\n"
        "Avg,7i,119,1.37,163,168,95,6.1,0,6450,0,-3,17.7,0,45,\n",
        {
            "launch.spin": 6400.0,
            "launch.axis": -3.0,
            "side": -5.4864,
            "apex": 28.0416,
            "flight_time": 6.1,
            "landing_angle": 45.0,
        },
        [AVERAGE],
    ),
    "rapsodo": (
        '"Rapsodo MLM2PRO: Me - 05/12/2025"\n\n"Club Type","Carry Distance","Total Distance","Ball Speed",'
        '"Launch Angle","Launch Direction","Apex","Side Carry","Descent Angle","Spin Rate","Spin Axis"\n'
        '"7i","165","171","120","17.2","1.2 R","92","6 L","45","6400","-3"\n'
        '"Average","163","168","119","17","0","93","0","45","6450","0"\n',
        {"launch.spin": 6400.0, "launch.axis": -3.0, "side": -5.4864, "apex": 28.0416, "landing_angle": 45.0},
        [AVERAGE],
    ),
    "square": (
        "Index,Club,Ball Speed(mph),Launch Direction,Launch Angle,Back Spin,Side Spin,Spin Rate,Spin Axis,Carry(yd),"
        "Total(yd),Offline(yd),Apex(yd),Landing Angle, Dynamic Loft\n"
        "1,7 Iron,120,R1.2,17.2,6400,-320,6408,L3,165,171,L6,30.7,45,24\n"
        "Average,7 Iron,119,R1.2,17.2,6400,-320,6408,L3,165,171,L6,30.7,45,24\n",
        {"launch.spin": 6408.0, "launch.axis": -3.0, "carry": 150.876, "apex": 28.07208, "landing_angle": 45.0},
        [AVERAGE],
    ),
    "skytrak": (
        "Shot,Date,Club,Ball Speed (mph),Launch Angle,Side Angle (deg),Back Spin (rpm),Side Spin (rpm),Carry (yds),"
        "Roll (yds),Total (yds),Offline (yds),Max Height (ft),Descent Angle (deg),Flight Time (sec)\n"
        "1,6/2/2025,7i,120,17.2,1.2 R,6400,320 L,165,11,176,6.4 L,92,45,6.1\n"
        "2,6/2/2025,7i,120,17.2,,6400,300,,,,,,,\n",
        {
            "launch.spin": 6407.995,
            "launch.axis": -2.86241,
            "side": -5.4864,
            "apex": 28.0416,
            "flight_time": 6.1,
            "landing_angle": 45.0,
        },
        [LeftOut(2, "Carry is missing")],
    ),
    "foresight-csv": (
        "Shot ID, Club, Ball Speed (m/s), Launch Angle (deg), Azimuth (deg), Side Spin (rpm), Back Spin (rpm), "
        "Total Spin (rpm), Descent Angle (deg), Carry (m), Total Distance (m), Offline (m), Peak Height (m), \n"
        "283, Irn, 53.6448, 17.2, 1.2, -320, 6400, 6408, 45, 150.876, 160.9344, -5.85216, 28.0416, \n"
        "284, Irn, 53, 17.2, 1.2, -320, 6400, 6408, 45, , , , , \n",
        {"launch.spin": 6407.995, "launch.axis": -2.86241, "side": -5.4864, "apex": 28.0416, "landing_angle": 45.0},
        [LeftOut(2, "Carry is missing")],
    ),
    "foresight": (
        '{"Shots": [{"ID": 1, "ClubName": "7i", "BallData": {"BallSpeed_MS": 53.6448, "Azimuth_DEG": 1.2, '
        '"LaunchAngle_DEG": 17.2, "BackSpin_RPM": 6390, "TotalSpin_RPM": 6400, "SpinAxis_DEG": -3}, "FlightData": '
        '{"CarryDistance_M": 150.876, "TotalDistance_M": 160.9344, "OfflineDistance_M": -5.85216, '
        '"MaxHeight_M": 28.0416}}]}',
        {"launch.spin": 6400.0, "launch.axis": -3.0, "side": -5.4864, "apex": 28.0416},
        [],
    ),
    "garmin": (  # in Dutch, without the distance to the side
        "Datum,Speler,Type club,Balsnelheid,Slaghoek,Slagrichting,Backspin,Sidespin,Spinsnelheid,Spinas,Apexhoogte,"
        "Carry-afstand,Carry-afwijkingshoek,Totale afstand,Luchtdichtheid\n"
        ",,,[km/u],[deg],[deg],[rpm],[rpm],[rpm],[deg],[m],[m],[deg],[m],[g/L]\n"
        "11/05/2025,F,IJzer 7,193.12128,17.2,1.2,6391,-335,6400,-3,28.0416,150.876,-2.08395,158,1.19\n",
        {"launch.spin": 6400.0, "launch.axis": -3.0, "side": -5.4864, "apex": 28.0416, "air.density": 1.19},
        [],
    ),
    "monitor": (
        "Shot,BallSpeed (mph),Vertical Launch Angle,Horizontal_Launch_Angle,Backspin,Sidespin,Carry (yd),Apex (ft)\n"
        "1,120,17.2,1.2,6400,-320,165,92\n",
        {"launch.spin": 6407.995, "launch.axis": -2.86241, "apex": 28.0416},
        [],
    ),
}


@pytest.mark.parametrize("device", FILES)
def test_a_shot_is_read_as_each_device_writes_it(tmp_path: Path, device: str):
    text, some, left_out = FILES[device]
    found = read(tmp_path, text)
    values = {key: float(one.values[0]) for key, one in (found.given | found.measured).items()}
    shot = {"launch.speed": 53.6448, "launch.angle": 17.2, "launch.direction": 1.2, "carry": 150.876}
    assert values == {key: pytest.approx(value, rel=1e-5) for key, value in (shot | some).items()}
    assert found.rows == (1,)
    assert list(found.left_out) == left_out
    assert f"read as {forms()[device].title}" in found.notes[0]


def test_a_statcast_pitch_is_that_of_its_constant_accelerations(tmp_path: Path):
    """y = 50 ft at t = 0; the pitch leaves the hand at 60.5 ft - 6.4 ft and passes the plate at 17 in."""
    text = (
        "pitch_type,release_speed,release_pos_z,plate_x,plate_z,vx0,vy0,vz0,ax,ay,az,release_spin_rate,"
        "release_extension,spin_axis\nFF,95.1,5.9,0.3,2.6,5.1,-138.2,-5.2,-8.1,29.3,-14.9,2350,6.4,205\n"
        "CU,79.1,5.9,0.3,1.9,2.1,-115.0,0.4,5.1,22.0,-40.1,2700,6.2,40\nSL,86.1,5.9,,,2.1,-125.0,-2.4,5.1,25,-33,2500,6.2,9\n"
    )
    found = read(tmp_path, text, "baseball-pitch")
    t = np.linspace(-0.1, 0.6, 700_001)  # s
    y, vy, vz = 50.0 - 138.2 * t + 0.5 * 29.3 * t**2, -138.2 + 29.3 * t, -5.2 - 14.9 * t
    hand, plate = (int(np.abs(y - at).argmin()) for at in (54.1, 17.0 / 12.0))
    values = {key: float(one.values[0]) for key, one in (found.given | found.measured).items()}
    assert values == {
        "launch.speed": pytest.approx(42.5135, abs=1e-4),
        "launch.angle": pytest.approx(np.degrees(np.arctan2(vz[hand], -vy[hand])), abs=1e-3),
        "launch.spin": pytest.approx(2350.0),
        "launch.tilt": pytest.approx(-25.0),
        "release.height": pytest.approx(5.9 * 0.3048),
        "plate.distance": pytest.approx((60.5 - 6.4 - 17.0 / 12.0) * 0.3048),
        "plate_height": pytest.approx(2.6 * 0.3048),
        "plate_angle": pytest.approx(np.degrees(np.arctan2(-vz[plate], -vy[plate])), abs=1e-3),
        "flight_time": pytest.approx(t[plate] - t[hand], abs=1e-5),
    }
    assert found.given["launch.spin"].values[1] == pytest.approx(-2700.0)  # topspin
    assert found.left_out == (LeftOut(3, "plate_z is missing"),)


def test_trackman_has_pitches_and_batted_balls_in_one_file(tmp_path: Path):
    text = (
        "PitchNo,TaggedPitchType,RelSpeed,VertRelAngle,SpinRate,SpinAxis,RelHeight,Extension,PlateLocHeight,ZoneSpeed,"
        "VertApprAngle,ZoneTime,ExitSpeed,Angle,HitSpinRate,Distance,HangTime,TaggedHitType\n"
        "1,Fastball,93.4,-2.1,2396,180,6.1,6.3,2.5,85.5,-5.4,0.405,,,,,,\n"
        "2,Curveball,78.4,1.1,2700,0,6.1,6,2,72.5,-9.4,0.485,101.2,27.1,2200,402,5.1,FlyBall\n"
        "3,Fastball,93.9,-1.9,2420,205,6.1,6.3,2.9,86.1,-5.1,0.403,95.2,-7.1,900,12,1,GroundBall\n"
    )
    pitches = read(tmp_path, text, "baseball-pitch")
    assert pitches.given["launch.spin"].values[:2].tolist() == [2396.0, -2700.0]
    assert pitches.measured["plate_angle"].values.tolist() == [5.4, 9.4, 5.1]
    hits = read(tmp_path, text, "baseball")
    assert hits.measured["distance"].values == pytest.approx([402 * 0.3048])
    assert [(each.row, each.why[:21]) for each in hits.left_out] == [
        (1, "ExitSpeed is missing"),
        (3, "is a ground ball: its"),
    ]


@pytest.mark.parametrize(
    ("without", "spin", "axis", "note"),
    [
        ((), 6400.0, 3.0, ""),
        (("Drehrate",), 6250.0, 16.2602, "launch.spin is hypot(Backspin, Sidespin) in place of Drehrate"),
        (("Drehrate", "Sidespin"), 6000.0, None, "launch.spin is Backspin in place of Drehrate"),
        (("launch.spin",), None, 3.0, "launch.spin is not read from Drehrate: it is the scene's, 2545 rpm, or what is"),
    ],
)
def test_a_column_that_is_left_unused_is_replaced_and_said(tmp_path, without, spin, axis, note):
    head = "Ballgeschwindigkeit [m/s];Abflugwinkel;Backspin;Sidespin;Drehrate;Drehachse;Carry-Distanz [m]\n"
    found = read(tmp_path, head + "60;12;6000;1750;6400;3;170\n", choices=Choices(without=without))
    values = {key: float(one.values[0]) for key, one in found.given.items()}
    assert values.get("launch.spin") == (spin and pytest.approx(spin))
    assert values.get("launch.axis") == (axis and pytest.approx(axis, abs=1e-4))
    assert any(note in each for each in found.notes)


def test_what_seems_known_of_a_table_is_a_map_to_complete(tmp_path: Path):
    with pytest.raises(RequestError) as refused:
        read(tmp_path, "Shot;Tempo;Launch Angle (deg);Carry\n1;60;12;190\n")
    maps = '--map "launch.angle=Launch Angle" --map "carry=Carry [UNIT]" --map "launch.speed=COLUMN [UNIT]"'
    assert f"Launch Angle, Carry seem known; complete and give {maps}" in str(refused.value)
    with pytest.raises(
        RequestError, match=r"looks like Statcast pitches, .* are known for baseball-pitch; for golf name"
    ):
        read(tmp_path, "release_speed,plate_z,vy0,vz0,ay,az,release_extension\n95,2.6,-138,-5,29,-14,6\n")


# Arithmetic ----------------------------------------------------------------------------------------------------------

NAMES = {name.lower(): name for name in ("Spin Rate", "Spin", "Axis", "Carry Flat - Length", "v", "min", "1", "x/2")}


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("Spin Rate", 2.0),
        ("Spin Rate*cos(radians(Axis))", 2.0 * np.cos(np.radians(2.0))),
        ("spin rate - Carry Flat - Length/`Spin`", 1.0),
        ("-v**2 + 2*pi*'1'", -4.0 + 4.0 * np.pi),
        ("min(v, 1.5) + min", 3.5),
        ('"x/2"*2e-1', 0.4),
        ("degrees(atan2(v, v))", 45.0),
        ("1/(v - v)", np.inf),
        ("9**9**9**v", np.inf),
    ],
)
def test_arithmetic_with_columns(text: str, value: float):
    found = parse(text, NAMES)
    assert found.values([np.array([2.0, 2.0])] * len(found.columns)) == pytest.approx([value, value])


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("Spin Rat*2", "at 'Rat*2' (character 6): has no column 'Rat'"),
        ("v v", "at 'v' (character 3): does not parse"),
        ("2*(v", "does not parse"),
        ("cos(v, v)", "cos takes 1 number, not 2"),
        ("exec(v)", "exec is no function; there are sin, cos,"),
        ("v if v else v", "has no column 'if'"),
        ("v; v", "at '; v' (character 2): ';' does not belong there"),
        ("2*3", "names no column"),
        ("__import__('v')", "__import__ is no function"),
        ("v" * 301, "is longer than 300 characters"),
    ],
)
def test_what_is_no_arithmetic_says_where_and_why(text: str, why: str):
    with pytest.raises(ValueError, match=r".") as refused:
        parse(text, NAMES)
    assert why in str(refused.value)
