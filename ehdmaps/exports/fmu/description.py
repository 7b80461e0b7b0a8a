"""The model description of a unit, by FMI 2.0 and by FMI 3.0."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from xml.etree import ElementTree

from ehdmaps.exports.fmu.variables import LAG, NOMINAL_STATE, UNITS, Variable

KIND = {"2": "2.0", "3": "3.0"}
"""Versions of the standard."""

_VARIABILITY = {
    "independent": "continuous",
    "input": "continuous",
    "output": "continuous",
    "parameter": "tunable",
    "local": "continuous",
}

_PARTS_2 = {"Output": "Outputs", "ContinuousStateDerivative": "Derivatives", "InitialUnknown": "InitialUnknowns"}
"""Parts of the structure in FMI 2.0, which has them in elements of their own."""


@dataclass(frozen=True)
class Identity:
    """Attributes that identify a unit.

    Attributes
    ----------
    name : str
        Name of the model, and of its binary.
    token : str
        What binary and description have in common.
    words : str
        Description in a line.
    tool : str
        Program that made it.
    version : str
        Version of the map: its checksum.
    """

    name: str
    token: str
    words: str
    tool: str
    version: str


def model_description(
    fmi: str,
    identity: Identity,
    variables: Sequence[Variable],
    sources: tuple[str, ...],
    start: Mapping[str, float],
    films: Sequence[str] = (),
    *,
    exchanges: bool = True,
) -> str:
    """Text of modelDescription.xml.

    Parameters
    ----------
    fmi : {"2", "3"}
        Version of the standard.
    identity : Identity
        The unit.
    variables : sequence of Variable
        Variables of the unit, in the order of their value references.
    sources : tuple of str
        Files to be compiled; only FMI 2.0 names them here.
    start : mapping of str to float
        Values at the start of variables that do not start at zero.
    films : sequence of str
        Names of the states of films with memory.
    exchanges : bool
        Whether there is Model Exchange, beside Co-Simulation.
    """
    second = fmi == "2"
    root = ElementTree.Element(
        "fmiModelDescription",
        {
            "fmiVersion": KIND[fmi],
            "modelName": identity.name,
            "guid" if second else "instantiationToken": identity.token,
            "description": f"{identity.words}. {LAG}",
            "version": identity.version,
            "generationTool": identity.tool,
            "variableNamingConvention": "structured",
            **({"numberOfEventIndicators": "0"} if second else {}),
        },
    )
    for name in ("ModelExchange", "CoSimulation") if exchanges else ("CoSimulation",):
        state = "FMUstate" if second else "FMUState"
        interface = ElementTree.SubElement(
            root,
            name,
            {
                "modelIdentifier": identity.name,
                f"canGetAndSet{state}": "true",
                f"canSerialize{state}": "true",
                "providesDirectionalDerivative" if second else "providesDirectionalDerivatives": "true",
                **({} if second else {"providesAdjointDerivatives": "true"}),
                **({"canHandleVariableCommunicationStepSize": "true"} if name == "CoSimulation" else {}),
            },
        )
        if second:
            files = ElementTree.SubElement(interface, "SourceFiles")
            for source in sources:
                ElementTree.SubElement(files, "File", name=source)
    _units(root, {variable.unit for variable in variables})
    log = ElementTree.SubElement(root, "LogCategories")
    for category, words in (
        ("logStatusWarning", "outside of what the law was made for, held"),
        ("logStatusDiscard", "outside of what the law was made for, refused"),
        ("logStatusError", "wrong calls"),
    ):
        ElementTree.SubElement(log, "Category", name=category, description=words)
    ElementTree.SubElement(root, "DefaultExperiment", startTime="0", stopTime="1")
    entries = _entries(variables, films)
    _variables(root, fmi, start, entries)
    _structure(root, fmi, entries)
    ElementTree.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"


def build_description(identity: Identity, sources: tuple[str, ...]) -> str:
    """Text of sources/buildDescription.xml of FMI 3.0.

    Parameters
    ----------
    identity : Identity
        The unit.
    sources : tuple of str
        Files to be compiled.
    """
    root = ElementTree.Element("fmiBuildDescription", fmiVersion="3.0")
    configuration = ElementTree.SubElement(root, "BuildConfiguration", modelIdentifier=identity.name)
    files = ElementTree.SubElement(configuration, "SourceFileSet", language="C99")
    for source in sources:
        ElementTree.SubElement(files, "SourceFile", name=source)
    ElementTree.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"


def _units(root: ElementTree.Element, used: Collection[str]) -> None:
    """Add the units that variables have."""
    definitions = ElementTree.SubElement(root, "UnitDefinitions")
    for name, exponents in UNITS.items():
        if name not in used:
            continue
        unit = ElementTree.SubElement(definitions, "Unit", name=name)
        ElementTree.SubElement(unit, "BaseUnit", {base: str(power) for base, power in exponents.items()})


@dataclass(frozen=True)
class _Entry:
    """A variable with its value reference, and that of the state whose rate it is."""

    reference: int
    variable: Variable
    state: int | None = None


def _entries(variables: Sequence[Variable], films: Sequence[str]) -> list[_Entry]:
    """All variables, in the order of their references: those of the bearing, states of films, their rates."""
    words = "Approach at which the film of a slice would be in equilibrium"
    first = len(variables)
    return [
        *(_Entry(reference, variable) for reference, variable in enumerate(variables)),
        *(_Entry(first + n, Variable(name, "local", "m", words)) for n, name in enumerate(films)),
        *(
            _Entry(first + len(films) + n, Variable(f"der({name})", "local", "m/s", f"Rate of {name}"), first + n)
            for n, name in enumerate(films)
        ),
    ]


def _variables(root: ElementTree.Element, fmi: str, start: Mapping[str, float], entries: Sequence[_Entry]) -> None:
    """Add the variables. FMI 2.0 has their numbers and units in an element of its own."""
    listed = ElementTree.SubElement(root, "ModelVariables")
    for entry in entries:
        variable = entry.variable
        common = {
            "name": variable.name,
            "valueReference": str(entry.reference),
            "causality": variable.causality,
            "variability": _VARIABILITY[variable.causality],
            "description": variable.words,
            **({"initial": "calculated"} if variable.causality == "local" else {}),
        }
        if fmi == "2":
            real = ElementTree.SubElement(ElementTree.SubElement(listed, "ScalarVariable", common), "Real")
        else:
            real = ElementTree.SubElement(listed, "Float64", common)
        real.set("unit", variable.unit)
        if variable.causality in ("input", "parameter"):
            real.set("start", repr(float(start.get(variable.name, 0.0))))
        elif entry.state is not None:
            real.set("derivative", _number(fmi, entry.state))
        elif variable.causality == "local":
            real.set("nominal", repr(NOMINAL_STATE))


def _structure(root: ElementTree.Element, fmi: str, entries: Sequence[_Entry]) -> None:
    """Add what depends on what: outputs on inputs and states, a rate on inputs and on its own state."""
    inputs = [entry.reference for entry in entries if entry.variable.causality == "input"]
    outputs = [entry for entry in entries if entry.variable.causality == "output"]
    states = [entry.state for entry in entries if entry.state is not None]
    rates = [entry for entry in entries if entry.state is not None]
    settled = [entry for entry in entries if entry.reference in set(states)]
    needs = {entry.reference: [*inputs, *states] for entry in outputs}
    needs |= {entry.reference: [*inputs, entry.state] for entry in rates if entry.state is not None}
    # at the start a film is in equilibrium, and what is a parameter later is known
    begin = {entry.reference: inputs for entry in (*outputs, *settled, *rates)}
    structure = ElementTree.SubElement(root, "ModelStructure")
    for kind, known, needed in (
        ("Output", outputs, needs),
        ("ContinuousStateDerivative", rates, needs),
        ("InitialUnknown", sorted([*outputs, *settled, *rates], key=lambda entry: entry.reference), begin),
    ):
        parent = structure
        if fmi == "2" and known:
            parent = ElementTree.SubElement(structure, _PARTS_2[kind])
        for entry in known:
            ElementTree.SubElement(
                parent,
                "Unknown" if fmi == "2" else kind,
                {
                    "index" if fmi == "2" else "valueReference": _number(fmi, entry.reference),
                    "dependencies": " ".join(_number(fmi, reference) for reference in needed[entry.reference]),
                    "dependenciesKind": " ".join(["dependent"] * len(needed[entry.reference])),
                },
            )


def _number(fmi: str, reference: int) -> str:
    """Name of a variable: its place from 1 on in FMI 2.0, its reference in FMI 3.0."""
    return str(reference + 1 if fmi == "2" else reference)
