"""A unit as Model Exchange by FMPy, whatever its version."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Model
from fmpy.fmi3 import FMU3Model

from ehdmaps.arrays import FloatArray

OUTPUTS = ("force.y", "force.z", "moment.y", "moment.z")


class Unit:
    """A unit in a folder, and its instances."""

    def __init__(self, path: Path, folder: Path) -> None:
        self.folder = Path(extract(str(path), unzipdir=str(folder)))
        self.description = read_model_description(str(self.folder))
        self.second = self.description.fmiVersion == "2.0"
        self.references = {variable.name: variable.valueReference for variable in self.description.modelVariables}

    def instance(self, begun: bool = True) -> Any:
        """Make an instance, in the mode for continuous time."""
        model = (FMU2Model if self.second else FMU3Model)(
            guid=self.description.guid,
            unzipDirectory=str(self.folder),
            modelIdentifier=self.description.modelExchange.modelIdentifier,
            instanceName="one",
        )
        if self.second:
            model.instantiate()
            model.setupExperiment()
        else:
            model.instantiate()
        if begun:
            model.enterInitializationMode()
            model.exitInitializationMode()
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
