"""The result of an identification: a data set, and the scene with what was found.

A scene file keeps its comments and its order; found values stand in place of its own, with their bands as tolerances
where a scene takes some: of clearances, the temperature, loads and the pressure-viscosity.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.extras import needs
from ehdmaps.physics.viscosity import ZERO_CELSIUS
from mbs.identification.certainty import Certainty
from mbs.identification.explained import OtherLaw
from mbs.identification.free import Free
from mbs.identification.search import Fit
from mbs.output.files import described
from mbs.scene.assembly import law_attributes
from mbs.scene.scene import Scene

if TYPE_CHECKING:
    from mbs.output.files import Figure


@dataclass(frozen=True, eq=False)
class Identified:
    """Unknowns of a machine that were found.

    Attributes
    ----------
    fit : Fit
        The best fit.
    certainty : Certainty
        How well it is known.
    other : OtherLaw or None
        The same data by a constant damper; None of machines without films.
    """

    fit: Fit
    certainty: Certainty
    other: OtherLaw | None = None

    @property
    def stopped(self) -> bool:
        """True where Ctrl-C ended the search or the trials."""
        return self.fit.stopped or self.certainty.stopped

    @property
    def free(self) -> tuple[Free, ...]:
        """Unknowns that were found."""
        return self.fit.question.free

    @cached_property
    def bands(self) -> FloatArray:
        """Lower and upper ends of the bands [SI], shape (2, unknowns)."""
        at = self.fit.question.coordinates(self.fit.parts)
        ends = at - self.certainty.fall, at + self.certainty.rise
        return np.array([[one.value(x) for one, x in zip(self.free, end, strict=True)] for end in ends])

    @property
    def at_bounds(self) -> tuple[str, ...]:
        """Unknowns that lie at the end of their range: these are no result."""
        return tuple(
            one.name for one, part in zip(self.free, self.fit.parts, strict=True) if part < 1e-3 or part > 1.0 - 1e-3
        )

    @cached_property
    def dataset(self) -> xr.Dataset:
        """Data set that `mbs identify -o` writes."""
        values = np.array(self.fit.values)
        scale = np.array([value if one.log else 1.0 for one, value in zip(self.free, values, strict=True)])
        names = [one.name for one in self.free]
        trials = self.certainty.trials
        shift = np.array([one.rise + one.fall for one in trials]) if trials else np.zeros((0, len(names)))

        def own(data: Any, words: str) -> tuple[str, Any, dict[str, str]]:
            return "unknown", data, {"long_name": words, "units": "see unit"}

        found = xr.Dataset(
            {
                "found": own(values, "value found"),
                "band_low": own(self.bands[0], "lower end of the band"),
                "band_high": own(self.bands[1], "upper end of the band"),
                "noise_sd": own(scale * self.certainty.deviation, "standard deviation by noise"),
                "before": own([one.start for one in self.free], "value of the scene"),
                "unit": ("unknown", [one.unit for one in self.free], {"long_name": "unit of the unknown"}),
                "correlation": (
                    ("unknown", "of_unknown"),
                    self.certainty.correlation,
                    {"long_name": "correlation by noise", "units": "1"},
                ),
                "assumption_range": (
                    ("assumption", "unknown"),
                    shift * scale,
                    {"long_name": "range of the unknown by an assumption", "units": "see unit"},
                ),
            },
            {"unknown": names, "of_unknown": names, "assumption": [one.name for one in trials]},
        )
        about = {
            "title": self.fit.question.scene.title,
            "chi2": f"{self.fit.chi2:.6g}",
            "explained_by": self.other.explained_by if self.other else "not asked",
            **law_attributes(self.fit.question.machine.model),
        }
        return described(found, **about)

    def scene_text(self, scene: Scene) -> str:
        """The file of a scene with what was found.

        Parameters
        ----------
        scene : Scene
            The scene as it was read from its file.

        Raises
        ------
        InputError
            If it has no file, or the file does not state what was found.
        DependencyError
            If tomlkit is not installed.
        """
        if not scene.text:
            raise InputError("--scene: the scene has no file; allowed: of scenes from files")
        with needs("modal", "tomlkit", "scenes with what was found"):
            import tomlkit
        file: Any = tomlkit.parse(scene.text)
        for one, value, low, high in zip(self.free, self.fit.values, *self.bands, strict=True):
            _put(file, one, value, max(value - low, high - value))
        return f"# What `mbs identify` found stands here, with its bands as tolerances.\n{tomlkit.dumps(file)}"

    def plot(self) -> Figure:
        """Figure of `mbs identify --plot`: what was measured beside the machine before and after."""
        from mbs.output.identified.plot import identify_figure

        return identify_figure(self.fit)


def _put(file: Any, one: Free, value: float, half: float) -> None:
    """Put a value that was found into the tables of a file."""
    name, _, rest = one.name.partition(".")
    kind, _, freedom = rest.partition(".")

    def named(array: str) -> Any:
        for entry in file.get(array, ()):
            if entry.get("name") == name:
                return entry
        raise InputError(f"--scene: the file has no [[{array}]] {name!r}")

    if one.group == "clearance":
        entry = named("bearings")
        geometry = entry.get("geometry")
        place = geometry if hasattr(geometry, "get") and "diametral_clearance" in geometry else entry
        place["diametral_clearance"] = f"{1e6 * value:.4g} um +- {1e6 * half:.2g} um"
    elif one.name == "temperature":
        file["operation"]["temperature"] = f"{value - ZERO_CELSIUS:.5g} degC +- {half:.2g} K"
    elif rest == "force":
        entry = named("loads")
        key = "force" if "force" in entry else "moment"
        factor = value / one.start
        entry[key] = [_scaled(text, factor) for text in entry[key]]
        _tolerance(file, one.group, f"{100.0 * half / value:.2g} %")
    elif one.name == "alpha":
        _tolerance(file, "pressure_viscosity", f"{100.0 * half:.2g} %")
    elif kind in ("stiffness", "damping"):
        entry = named("springs")
        entry[kind][freedom] = f"{value:.5g} {one.unit}"
    elif rest == "damping_ratio":
        for array in ("shafts", "flexible"):
            for entry in file.get(array, ()):
                if entry.get("name") == name:
                    entry["damping_ratio"] = float(f"{value:.4g}")


def _scaled(text: Any, factor: float) -> str:
    """A quantity of a file times a factor."""
    number, _, unit = str(text).strip().partition(" ")
    return f"{float(number) * factor:.6g} {unit}"


def _tolerance(file: Any, group: str, text: str) -> None:
    """State a tolerance."""
    import tomlkit

    if "tolerances" not in file:
        file["tolerances"] = tomlkit.table()
    file["tolerances"][group] = text
