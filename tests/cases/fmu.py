"""A unit by FMPy, as Model Exchange or step by step, whatever its version."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Model, FMU2Slave
from fmpy.fmi3 import FMU3Model, FMU3Slave

from ehdmaps.arrays import FloatArray
from tests.cases.programs import needed

OUTPUTS = ("force.y", "force.z", "moment.y", "moment.z")


class Unit:
    """A unit in a folder, and its instances."""

    def __init__(self, path: Path, folder: Path) -> None:
        needed("gcc", "clang")  # or it has no binary
        self.folder = Path(extract(str(path), unzipdir=str(folder)))
        self.description = read_model_description(str(self.folder))
        self.second = self.description.fmiVersion == "2.0"
        self.references = {variable.name: variable.valueReference for variable in self.description.modelVariables}

    def instance(self, begun: bool = True) -> Any:
        """Make an instance, in the mode for continuous time."""
        model = self._made(FMU2Model if self.second else FMU3Model)
        if begun:
            model.enterInitializationMode()
            model.exitInitializationMode()
        return model

    def stepped(self, names: list[str], values: list[float]) -> Any:
        """Make an instance of Co-Simulation that begins with some inputs."""
        model = self._made(FMU2Slave if self.second else FMU3Slave)
        model.enterInitializationMode()
        self.put(model, names, values)
        model.exitInitializationMode()
        return model

    def _made(self, kind: type) -> Any:
        """Make an instance, which is not initialized."""
        model = kind(
            guid=self.description.guid,
            unzipDirectory=str(self.folder),
            modelIdentifier=self.description.coSimulation.modelIdentifier,  # that of Model Exchange, too
            instanceName="one",
        )
        model.instantiate()
        if self.second:
            model.setupExperiment()
        return model

    def put(self, model: Any, names: list[str], values: list[float]) -> None:
        """Set variables."""
        references = [self.references[name] for name in names]
        (model.setReal if self.second else model.setFloat64)(references, values)

    def get(self, model: Any, names: tuple[str, ...] = OUTPUTS) -> FloatArray:
        """Values of variables."""
        references = [self.references[name] for name in names]
        return np.array((model.getReal if self.second else model.getFloat64)(references))

    def derivatives(self, model: Any, known: str, unknowns: tuple[str, ...] = OUTPUTS) -> FloatArray:
        """Derivatives by a variable."""
        references = [self.references[name] for name in unknowns]
        return np.array(model.getDirectionalDerivative(references, [self.references[known]], [1.0]))


FIVE = ("force.x", "force.y", "force.z", "moment.y", "moment.z")
POSE = [f"pose.{name}" for name in ("x", "y", "z", "theta_y", "theta_z")]


def stepped(unit: Unit, path: FloatArray, speed: float, step: float) -> FloatArray:
    """Forces (n, 5) of a bearing of balls or tapered rollers along a path (n, 5) of even steps, from films at rest in
    its first place."""
    model = unit.stepped([*POSE, "speed.inner"], [*path[0], speed])
    forces = [unit.get(model, FIVE)]
    for n, place in enumerate(path[1:]):
        unit.put(model, POSE, list(place))
        model.doStep(n * step, step)
        forces.append(unit.get(model, FIVE))
    model.freeInstance()
    return np.array(forces)
