# Public names, a line each: type checkers read them here, and `__init__.py` loads them from here when they are used.

from ehdmaps.jobs.calls import compare as compare
from ehdmaps.jobs.calls import frequency_response as frequency_response
from ehdmaps.jobs.calls import generate as generate
from ehdmaps.jobs.calls import generate_batch as generate_batch
from ehdmaps.jobs.calls import solve as solve
from ehdmaps.jobs.calls import solve_points as solve_points
from ehdmaps.jobs.job import Job as Job
from ehdmaps.jobs.make.table_law import law as law
from ehdmaps.jobs.reader import read_job as read_job
from ehdmaps.jobs.show.compare import Comparison as Comparison
from ehdmaps.maps.emap import EHDMap as EHDMap
from ehdmaps.maps.emap import open_map as open_map
from ehdmaps.maps.law import ContactLaw as ContactLaw
from ehdmaps.maps.law_films import LawAtPoint as LawAtPoint
from ehdmaps.physics.bearing import BearingGeometry as BearingGeometry
from ehdmaps.physics.contact import LineContact as LineContact
from ehdmaps.physics.contact import OperatingPoint as OperatingPoint
from ehdmaps.physics.lubricant import Lubricant as Lubricant
from ehdmaps.physics.solids import STEEL as STEEL
from ehdmaps.physics.solids import Material as Material
from ehdmaps.physics.solution import ContactSolution as ContactSolution
from ehdmaps.physics.solution import Status as Status

__version__: str
