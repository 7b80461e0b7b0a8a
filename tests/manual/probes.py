"""Texts that lead the readers of jobs and scenes to every key that they know.

They are read for the keys that are asked for, not for their values: a text may have problems.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress

from ehdmaps.errors import InputError
from ehdmaps.jobs import solvers
from ehdmaps.jobs.make.batch import parse_batch
from ehdmaps.jobs.reader import parse_job
from ehdmaps.jobs.table import Table
from mbs.scene.reader import parse_scene
from tests.manual.recording import Readings, recording

_SPEED = "entrainment_speed = ['1 m/s']"
_SOLVER = '[solver]\nname = "hertz"\n'
_AXIS = '{ from = "1 N/mm", to = "2 N/mm", points = 2, spacing = "log" }'
JOBS = (
    f"""
schema = 1
[material]
[bearing]
inner_raceway_diameter = "52 mm"
[lubricant]
viscosity_law = "roelands"
pressure_viscosity = "20 1/GPa"
[supply]
[surface]
[solids]
[grid]
load = {_AXIS}
entrainment_speed = ["1 m/s"]
temperature = ["40 degC"]
[solver]
name = "hertz"
corrected_by = "formula"
line_steps = {{}}
[correction]
""",
    f"""
[bearing]
name = "NU308"
[lubricant]
viscosity_law = "tait-doolittle"
[grid]
inner_ring_speed = ["100 rpm"]
{_SOLVER}""",
    f"""
[bearing]
estimate = {{ bore = "30 mm" }}
[lubricant]
name = "FVA3"
[grid]
entrainment_speed = ["1 m/s"]
{_SOLVER}""",
    f"[tolerances]\n[contact]\n[lubricant]\nviscosity_law = 'fva3'\n[grid]\nload = ['1 N/mm']\n{_SPEED}\n{_SOLVER}",
    f"[lubricant]\nviscosity_law = 'barus'\n[grid]\n{_SPEED}\n{_SOLVER}",
)
BATCH = f"[batch]\noils = ['FVA3']\nestimates = ['NU206']\n[grid]\nentrainment_speed = ['1 m/s']\n{_SOLVER}"
SCENE = """
[tolerances]
[operation]
gravity = ["0 m/s^2", "0 m/s^2", "-9.81 m/s^2"]
[lubricant]
name = "FVA3"
[supply]
[surface]
[[bodies]]
name = "NAME"
cylinders = [{}]
frames = { PLACE = ["0 mm", "0 mm", "0 mm"] }
position = ["0 mm", "0 mm", "0 mm"]
[[shafts]]
name = "NAME"
freedoms = ["y"]
position = ["0 mm", "0 mm", "0 mm"]
sections = [{}, { length = "1 mm" }]
discs = [{}, { at = "0 mm" }, { at = "0 mm", width = "1 mm" }]
frames = { PLACE = "0 mm" }
[[flexible]]
name = "NAME"
reduced = "file.nc"
position = ["0 mm", "0 mm", "0 mm"]
damping_ratio = 0.01
attached = [{}]
rotation = { about = "z", angle = "90 deg" }
[[flexible]]
name = "NAME"
matrices = { format = "calculix" }
mesh = "file.frd"
units = "SI"
[flexible.interfaces.PLACE]
at = ["0 mm", "0 mm", "0 mm"]
kind = "rigid"
freedoms = ["x"]
cylinder = { tolerance = "1 mm" }
[flexible.interfaces.SECOND]
plane = { diameter = "1 mm", tolerance = "1 mm" }
[flexible.interfaces.THIRD]
nodes = [1]
[flexible.points]
PLACE = ["0 mm", "0 mm", "0 mm"]
[[flexible]]
name = "NAME"
matrices = { format = "nastran" }
[[springs]]
name = "NAME"
on = "NAME"
against = "ground"
speeds = ["0 rpm", "1 rpm"]
[[loads]]
name = "NAME"
on = "NAME"
against = "NAME"
force = ["0 N", "0 N", "0 N"]
moment = ["0 N m", "0 N m", "0 N m"]
times = ["0 s"]
factors = [1]
[[unbalances]]
name = "NAME"
[[excitations]]
name = "NAME"
against = "NAME"
force = ["0 N", "0 N", "0 N"]
moment = ["0 N m", "0 N m", "0 N m"]
of = "NAME"
[[bearings]]
name = "NAME"
geometry = {}
profile = { crown_drop = "10 um" }
thermal = {}
fit = { inner = {}, outer = {} }
supply = {}
[[bearings]]
name = "NAME"
profile = { crown_radius = "10 m" }
[[bearings]]
name = "NAME"
profile = { positions = ["0 mm"], depths = ["0 mm"] }
[[bearings]]
name = "NAME"
bearing = "NU308"
shaft = "NAME"
position = "0 mm"
diametral_clearance = "0 mm"
[[bearings]]
name = "NAME"
bearing = "6208"
waviness = [{ waves = 2 }, { waves = [2, 3] }]
spall = [{}]
[[bearings]]
name = "TABLE"
kind = "table"
speeds = ["0 rpm", "1 rpm"]
[[gears]]
name = "NAME"
harmonic_phases = ["0 deg"]
transmission_error = ["0 um"]
transmission_error_phases = ["0 deg"]
tip_relief = ["0 um", "0 um"]
relief_length = ["1 mm", "1 mm"]
[[inputs]]
name = "NAME"
against = "NAME"
direction = "y"
[[inputs]]
name = "NAME"
direction = "theta_x"
[[inputs]]
name = "NAME"
on = "mesh:NAME"
[[inputs]]
name = "NAME"
on = "mesh:NAME"
quantity = "transmission_error"
[[sensors]]
name = "NAME"
against = "NAME"
[laws.NAME]
[linear]
frequencies = { from = "1 Hz", to = "2 Hz", points = 2, spacing = "log" }
[drive]
motor = { speeds = ["0 rpm", "1 rpm"], torques = ["0 N m", "1 N m"] }
load = { speeds = ["0 rpm", "1 rpm"], torques = ["0 N m", "1 N m"] }
[runup]
[sweep]
[campbell]
"""


def job_readings() -> Readings:
    """Note the keys of job files and batch files."""
    with recording() as found:
        for text in JOBS:
            _read(parse_job, text)
        _read(parse_batch, BATCH)
        for name in solvers.SOLVERS:
            solvers.read_options(name, Table({}, f"[solver] {name}", []))
    return found


def scene_readings() -> Readings:
    """Note the keys of scene files."""
    with recording() as found:
        _read(parse_scene, SCENE)
    return found


def _read(read: Callable[[str, str, str], object], text: str) -> None:
    """Read a text, whose problems do not matter."""
    with suppress(InputError):
        read(text, "probe", "probe")
