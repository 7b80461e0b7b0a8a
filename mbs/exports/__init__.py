"""Bearings of a map in the formats of other programs; targets of `ehdmaps export` that need the bearing element.

| module | idea |
|---|---|
| `linear_table` | stiffness and damping of a bearing at a load, over speed and frequency |
| `ross` | ROSS, as the file that `BearingElement.load` reads |
| `calculix` | CalculiX and Abaqus, as springs and dashpots along lines |
| `nastran` | Nastran, as CBUSH with tables over frequency |
| `ansys` | Ansys Mechanical APDL, as a bearing file over speed |
| `exudyn` | Exudyn, as a connector that calls the force element |
| `matrices` | columns of K and C over speed and frequency, with errors, for other rotor programs |
"""
