"""The model description of a unit, by FMI 2.0 and by FMI 3.0."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from xml.etree import ElementTree

from ehdmaps.exports.fmu.variables import LAG, UNITS, VARIABLES

KIND = {"2": "2.0", "3": "3.0"}
"""Versions of the standard."""

_VARIABILITY = {"independent": "continuous", "input": "continuous", "output": "continuous", "parameter": "tunable"}


@dataclass(frozen=True)
class Identity:
    """What makes a unit the one that it is.

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


def model_description(fmi: str, identity: Identity, sources: tuple[str, ...], start: Mapping[str, float]) -> str:
    """Text of modelDescription.xml.

    Parameters
    ----------
    fmi : {"2", "3"}
        Version of the standard.
    identity : Identity
        The unit.
    sources : tuple of str
        Files to be compiled; only FMI 2.0 names them here.
    start : mapping of str to float
        Values at the start of variables that do not start at zero.
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
    for name in ("ModelExchange", "CoSimulation"):
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
    _units(root)
    log = ElementTree.SubElement(root, "LogCategories")
    for category, words in (
        ("logStatusWarning", "held at the edge of the map"),
        ("logStatusDiscard", "outside the map, refused"),
        ("logStatusError", "wrong calls"),
    ):
        ElementTree.SubElement(log, "Category", name=category, description=words)
    ElementTree.SubElement(root, "DefaultExperiment", startTime="0", stopTime="1")
    (_variables_2 if second else _variables_3)(root, start)
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


def _units(root: ElementTree.Element) -> None:
    """Add the units."""
    definitions = ElementTree.SubElement(root, "UnitDefinitions")
    for name, exponents in UNITS.items():
        unit = ElementTree.SubElement(definitions, "Unit", name=name)
        ElementTree.SubElement(unit, "BaseUnit", {base: str(power) for base, power in exponents.items()})


def _variables_2(root: ElementTree.Element, start: Mapping[str, float]) -> None:
    """Add variables and structure as FMI 2.0 has them."""
    listed = ElementTree.SubElement(root, "ModelVariables")
    known = [n + 1 for n, variable in enumerate(VARIABLES) if variable.causality == "input"]
    for reference, variable in enumerate(VARIABLES):
        entry = ElementTree.SubElement(
            listed,
            "ScalarVariable",
            name=variable.name,
            valueReference=str(reference),
            causality=variable.causality,
            variability=_VARIABILITY[variable.causality],
            description=variable.words,
        )
        real = ElementTree.SubElement(entry, "Real", unit=variable.unit)
        if variable.causality in ("input", "parameter"):
            real.set("start", repr(float(start.get(variable.name, 0.0))))
    structure = ElementTree.SubElement(root, "ModelStructure")
    outputs, initial = (ElementTree.SubElement(structure, name) for name in ("Outputs", "InitialUnknowns"))
    for place, variable in enumerate(VARIABLES):
        if variable.causality != "output":
            continue
        for parent in (outputs, initial):
            ElementTree.SubElement(
                parent,
                "Unknown",
                index=str(place + 1),
                dependencies=" ".join(map(str, known)),
                dependenciesKind=" ".join(["dependent"] * len(known)),
            )


def _variables_3(root: ElementTree.Element, start: Mapping[str, float]) -> None:
    """Add variables and structure as FMI 3.0 has them."""
    listed = ElementTree.SubElement(root, "ModelVariables")
    known = [str(n) for n, variable in enumerate(VARIABLES) if variable.causality == "input"]
    for reference, variable in enumerate(VARIABLES):
        entry = ElementTree.SubElement(
            listed,
            "Float64",
            name=variable.name,
            valueReference=str(reference),
            causality=variable.causality,
            variability=_VARIABILITY[variable.causality],
            description=variable.words,
            unit=variable.unit,
        )
        if variable.causality in ("input", "parameter"):
            entry.set("start", repr(float(start.get(variable.name, 0.0))))
    structure = ElementTree.SubElement(root, "ModelStructure")
    for kind in ("Output", "InitialUnknown"):
        for reference, variable in enumerate(VARIABLES):
            if variable.causality == "output":
                ElementTree.SubElement(
                    structure,
                    kind,
                    valueReference=str(reference),
                    dependencies=" ".join(known),
                    dependenciesKind=" ".join(["dependent"] * len(known)),
                )
