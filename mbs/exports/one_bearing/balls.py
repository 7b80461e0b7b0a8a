"""Ball bearings as C sources and units: what differs of them."""

from __future__ import annotations

from ehdmaps.exports.c.text import define, number
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.exports.one_bearing.kind import ExportKind


def _public(force: BallForce) -> str:
    """Constants that callers may read."""
    geometry = force.geometry
    return "".join(
        (
            define("EHD_BALLS", geometry.rolling_elements, "number of balls"),
            define("EHD_ROW_BALLS", geometry.balls, "number of balls of a row"),
            define("EHD_BALL_DIAMETER", geometry.ball_diameter, "[m]"),
            define("EHD_PITCH_DIAMETER", geometry.pitch_diameter, "[m]"),
            define("EHD_CONTACT_ANGLE", geometry.contact_angle, "nominal [rad]"),
            define("EHD_CLEARANCE", geometry.clearance, "clearance of the export, see ehd_bearing_make [m]"),
            define("EHD_CAGE_INNER", 0.5 * (1.0 - geometry.gamma), "turns of the cage for each of the inner ring"),
            define("EHD_CAGE_OUTER", 0.5 * (1.0 + geometry.gamma), "turns of the cage for each of the outer ring"),
            define("EHD_ENTRAINMENT", geometry.entrainment_speed(1.0, 0.0), "entrainment speed [m/rad], see below"),
        )
    )


def _private(force: BallForce) -> str:
    """Constants that only the functions read."""
    geometry, shape, drive = force.geometry, force.shape, force.drive
    rows = [(*row, other * geometry.balls) for row, other in zip(geometry.rows, geometry.others, strict=True)]
    return (
        define("GROOVE_DISTANCE", geometry.groove_distance, "of the grooves' centres where balls just touch [m]")
        + define("INNER_ARM", shape.inner_arm, "of the inner groove's centre and the centre of a ball that touches [m]")
        + define("OUTER_ARM", shape.outer_arm, "the same of the outer one [m]")
        + define("CENTRIFUGAL", drive.centrifugal, "centrifugal load of a ball over the square of its speed [kg m]")
        + define("GYROSCOPIC", drive.gyroscopic, "the same of the traction of its gyroscopic moment [kg m]")
        + define("BALL_AXIS", int(drive.axis), f"axis of a ball: {geometry.hypothesis}")
        + define("SPHERE", int(geometry.spherical), "1: the outer raceway is a sphere about the middle, tilts are free")
        + define("THRUST", int(geometry.thrust), "1: the grooves face each other along the axis, without a clearance")
        + define("MOST_TRAVEL", geometry.most_travel, "largest accepted displacement [m]")
        + define("AXIAL_PLAY", int(geometry.axial_play), "1: the clearance is axial, and shifts the rows")
        + "/* rows: way along x, place [m], shift of the inner groove [m], other contacts */\n"
        + "static const double row_of[EHD_BALLS / EHD_ROW_BALLS][4] = {"
        + ", ".join("{" + ", ".join(number(float(part)) for part in row) + "}" for row in rows)
        + "};\n"
    )


BALLS = ExportKind(
    words="ball bearing",
    title=lambda geometry: f"Ball bearing {geometry.title}",
    element="ball",
    files="ball",
    kernel=("ball/ball.h", "ball/ball_balance.c", "ball/ball_bearing.c"),
    mirrored=lambda geometry: geometry.contact_angle < 0.0,
    public=_public,
    private=_private,
    play=lambda geometry: geometry.clearance,
    motion=(
        "x is the axis of the bearing; the frame is that of the outer ring and does not spin. There is no moment about "
        "x. In the pose zero angular contact bearings without clearance just touch; they carry an axial force on the "
        "inner ring in +x, mirrored ones in -x. Inputs start at rest under the load of the export.",
        "pose, velocity and force are those of the inner ring, right-handed. The derivatives of the outputs by the "
        "pose are -K, by the velocity -C, at speeds of the rings that are held; those by the others are quotients of "
        "differences.",
        "The balls stand where the spins bring them, with a cage in pure rolling at the nominal contact angle; the "
        "first one stands on the y axis at spins of zero. Their centrifugal load and gyroscopic moment are those of "
        "balls that roll at both raceways, by the contact angles of the pose; BALL_AXIS says about which axis.",
    ),
    slow="Each ball is in balance at once and films follow at once: there are no states.",
    memory=(
        "Each ball is in balance at once. Films need time to follow: each contact has three springs in series with "
        "dampers, which begin at rest"
    ),
    own_words={"mirrored": "1: an angular contact bearing stands the other way round; else 0"},
)
"""Ball bearings."""
