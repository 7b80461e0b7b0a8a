"""Lubricated contacts in an electric circuit: capacitance, time constant and breakdown, by the films of the maps.

===========  ====================================================================================================
dielectric   the oil: permittivity over temperature and pressure, conductivity, field of breakdown, the outlet
gaps         integral of dA/h of points and lines, by their films; gaps of bodies that do not touch
contact      `point_capacitance`, `line_capacitance` by the film tables, and by films that are known
maps         `with_capacitance`: capacitance as a variable of a map
===========  ====================================================================================================
"""

from ehdmaps.electrics.contact import ContactElectrics, line_capacitance, point_capacitance
from ehdmaps.electrics.dielectric import Dielectric
from ehdmaps.electrics.maps import with_capacitance

__all__ = ["ContactElectrics", "Dielectric", "line_capacitance", "point_capacitance", "with_capacitance"]
