"""Commands that need no model, as functions: one bearing, measured responses, a finite-element body, a report.

The functions of analyses that take a model are in `mbs.analyses`. Values with a unit are texts, as in a scene file.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ehdmaps.errors import InputError
from mbs.output.files import described
from mbs.output.one_bearing.files import point_dataset
from mbs.output.one_bearing.kind import Description, Kind
from mbs.output.one_bearing.table import point_text
from mbs.scene.assembly import Model
from mbs.scene.choices import OPTIONS

if TYPE_CHECKING:
    import xarray as xr

    from mbs.analyses.hammer import HammerResult
    from mbs.flexible.reduced_body import ReducedBody
    from mbs.modal.result import ModalFit
    from mbs.output.files import Figure


@dataclass(frozen=True, eq=False)
class BearingResult:
    """One bearing under loads and speeds.

    Attributes
    ----------
    kind : Kind
        Kind of the bearing: names and units of what its points have.
    description : Description
        What was asked, and what was assumed, in words.
    points : list of list of BearingPoint or LocatingPoint
        Points by load, then by speed.
    """

    kind: Kind
    description: Description
    points: list[list[Any]]

    @property
    def text(self) -> str:
        """Lines that `mbs bearing` prints."""
        return "\n".join(point_text(self.kind, self.description, self.points))

    @cached_property
    def dataset(self) -> xr.Dataset:
        """Data set that `mbs bearing -o` writes; made when it is asked for."""
        return point_dataset(self.kind, self.description, self.points)

    def plot(self) -> Figure:
        """Figure that `mbs bearing --plot` writes."""
        from mbs.output.bearing_plot import bearing_figure

        return bearing_figure(self.kind, self.description, self.points)


def bearing(
    name: str,
    load: str | Sequence[str],
    speed: str | Sequence[str],
    *,
    axial: str | None = None,
    outer_speed: str | None = None,
    tilts: bool = False,
    direction: str = "0 deg",
    oil: str | None = None,
    profile: str = "iso",
    slices: int = 41,
    coupled: bool = False,
    permittivity: str | None = None,
    choices: dict[str, str] | None = None,
) -> BearingResult:
    """Stiffness, damping, loads, pressures and films of one bearing of any kind, as `mbs bearing` finds them.

    Parameters
    ----------
    name : str
        A designation such as NU308, 6208 or 32208, or a file with [bearing] of cylindrical rollers.
    load, speed : str or sequence of str
        Radial loads on the inner ring, such as "5 kN", and its speeds, such as "1500 rpm".
    axial, outer_speed : str, optional
        Axial load on the inner ring, and speed of the outer one, of balls, tapered rollers, NJ, NUP, NCF and NNCF.
    tilts : bool
        Whether the inner ring of such a bearing tilts freely.
    direction : str
        Direction of the load from y, where a roller is, towards z.
    oil : str, optional
        Oil without a map; that of the file, else FVA3, if left out.
    profile : str
        Profile of the rollers, as in a scene.
    slices : int
        Slices of a roller.
    coupled : bool
        Whether slices are coupled elastically.
    permittivity : str, optional
        Relative permittivity of the oil, "2.2", or a table in braces: the dataset then has electric numbers.
    choices : dict of str to str, optional
        Choices by the names of the options: {"law": "hertz", "clearance": "20 um"}.

    Raises
    ------
    InputError
        With every problem.
    AnalysisError
        Where no equilibrium is found.

    Examples
    --------
    >>> found = bearing("NU308", "5 kN", "0 rpm", choices={"law": "hertz"})
    >>> found.dataset.sizes["load"]
    1
    >>> point = bearing("7208B", "1 kN", "0 rpm", axial="1 kN", choices={"law": "hertz"}).points[0][0]
    >>> point.stiffness.shape
    (6, 6)
    """
    from mbs.commands.bearing import family_of
    from mbs.one_bearing.request import points_of, read_request

    given = dict(choices or {})
    arguments = argparse.Namespace(
        bearing=name,
        load=[[text] for text in _texts(load)],
        speed=[[text] for text in _texts(speed)],
        axial=axial,
        outer_speed=outer_speed,
        tilts=tilts,
        direction=[direction],
        ring_temperatures=None,
        oil=oil,
        profile=profile,
        slices=str(slices),
        coupled=coupled,
        permittivity=permittivity,
        output=None,
        plot=None,
        **{choice.key: [given.pop(choice.name)] if choice.name in given else None for choice in OPTIONS},
    )
    if given:
        allowed = ", ".join(choice.name for choice in OPTIONS)
        raise InputError(f"bearing, choices: got {', '.join(map(repr, given))}; allowed: {allowed}")
    family = family_of(name, axial)
    request = read_request(arguments, family)
    return BearingResult(family.kind, request.description, points_of(request))


@dataclass(frozen=True, eq=False)
class ModalFitResult:
    """Modes identified from hits or responses.

    Attributes
    ----------
    title : str
        Title of the measurement.
    fit : ModalFit
        Poles, shapes, uncertainties and what is left of the responses.
    """

    title: str
    fit: ModalFit

    @cached_property
    def dataset(self) -> xr.Dataset:
        """Data set of the modes and responses; made when it is asked for."""
        from mbs.modal.result import fit_dataset

        return described(fit_dataset(self.fit), title=self.title)

    def plot(self) -> Figure:
        """Figure that `mbs modal-fit --plot` writes."""
        from mbs.output.modes_plot import fit_figure

        return fit_figure(self.title, self.fit)


def modal_fit(
    source: str | Path | HammerResult,
    band: tuple[float, float] | None = None,
    modes: int | None = None,
) -> ModalFitResult:
    """Frequencies and damping ratios from hammer hits or frequency responses.

    Parameters
    ----------
    source : str, Path or HammerResult
        A universal file, or the hits of `mbs.hammer`.
    band : (float, float), optional
        Limits of the band [Hz]; all lines if left out.
    modes : int, optional
        How many to keep at most.

    Raises
    ------
    InputError
        If the file cannot be read, or has neither hits nor responses.
    AnalysisError
        If no modes are found.
    """
    from mbs.modal.estimation import estimate, needed_decay
    from mbs.modal.fit import identify
    from mbs.modal.uff import read_uff

    if isinstance(source, (str, Path)):
        measured = read_uff(Path(source))
        title, hits, responses = measured.title or Path(source).name, measured.hits, measured.responses
    else:
        title, hits, responses = source.model.scene.title, source.hits, None
    if hits:
        decay = max(needed_decay(entry.response, entry.step) for entry in hits)
        responses = estimate(hits, "h1", decay).responses
    if responses is None:
        raise InputError(f"{source}: has coherences only; allowed: frequency responses, or hits")
    return ModalFitResult(title, identify(responses, band, modes=modes))


def reduce(body: str | Path) -> ReducedBody:
    """A finite-element body, reduced to its interfaces and modes, as `mbs reduce` does.

    Parameters
    ----------
    body : str or Path
        File that names matrices, mesh and interfaces.

    Raises
    ------
    InputError
        For files that do not read or do not fit together.
    AnalysisError
        If modes or static shapes are not found.
    """
    from mbs.flexible.carry_out import carry_out
    from mbs.scene.flexible import read_body_file

    return carry_out(read_body_file(Path(body)))


def write_report(model: Model, path: str | Path) -> None:
    """Examine a model and write a page that can be sent, as `mbs report` does.

    Parameters
    ----------
    model : Model
        Scene with its law; sections on maps are those of the command alone.
    path : str or Path
        The file, .html; nothing is replaced that is no such report.

    Raises
    ------
    InputError
        If it may not be replaced, or cannot be written.
    AnalysisError
        If there is no equilibrium.
    """
    from ehdmaps.report.page import write_report as write_page
    from mbs.report.examination import examined
    from mbs.report.scene_report import scene_report

    found = examined(model, None, None, banded=True)
    write_page(path, scene_report(found, f"mbs.write_report(model, {Path(path).name!r})", []))


def _texts(given: str | Sequence[str]) -> list[str]:
    """One text, or several, as a list."""
    return [given] if isinstance(given, str) else list(given)
