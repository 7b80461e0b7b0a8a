"""Cylindrical roller bearings with the law of a map, or of the film table, as C sources and units."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from ehdmaps.errors import InputError
from ehdmaps.exports.c.kernel import BEYOND, KernelOptions, kernel_files
from ehdmaps.exports.fmu.target import write_map_unit
from ehdmaps.exports.target import origin
from ehdmaps.outputs import write_text
from ehdmaps.units import short
from mbs.bearings.deviating.tables import DeviationData
from mbs.exports.one_bearing.source import HEADER, SOURCE, header_of, prefix_of
from mbs.exports.one_bearing.unit import VERSIONS

if TYPE_CHECKING:
    from ehdmaps.maps.emap import EHDMap
    from mbs.bearings.bearing import Bearing


def write_of_map(path: str, emap: EHDMap, bearing: Bearing, *, memory: bool, deviations: DeviationData | None) -> str:
    """Write source and header, or a unit, by the ending of the file; return what was written in words.

    Parameters
    ----------
    path : str
        File, .c or .fmu.
    emap : EHDMap
        The map, or that of the film table.
    bearing : Bearing
        Bearing with its clearance, profile and slices.
    memory : bool
        Whether the films of a unit have states.
    deviations : DeviationData or None
        Deviations of the bearing from its form.

    Raises
    ------
    InputError
        For slices that are coupled and profiles with numbers; if it cannot be written.
    """
    profile: Any = bearing.profile
    if bearing.coupled or profile not in ("iso", "straight"):
        raise InputError(
            f"-o {path}: got slices that are coupled, or the profile {short(profile)}; allowed: without --coupled, and "
            "--profile iso or straight"
        )
    place, source = Path(path), Path(path).suffix.lower() == ".c"
    prefix = prefix_of(path, "roller") if source else "ehd"
    clearance = bearing.geometry.diametral_clearance
    options = KernelOptions(clearance=clearance, slices=bearing.slices, profile=profile, prefix=prefix)
    name = str(emap.dataset.attrs.get("title", "EHD map"))
    if not source:
        version = VERSIONS.get(Path(place.stem).suffix.lower(), "2")
        return write_map_unit(emap, name, place, options, version, memory, deviations=deviations)
    beside = header_of(path)
    texts = kernel_files(emap, options, origin(emap, name, BEYOND[options.outside]), deviations)
    write_text(beside, texts[f"{prefix}.h"], HEADER)
    write_text(path, texts[f"{prefix}.c"].replace(f'#include "{prefix}.h"', f'#include "{beside.name}"'), SOURCE)
    return f"{path}, {beside}: written (C99, names begin with {prefix}_)"
