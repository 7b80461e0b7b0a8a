"""EHL contacts of lines and points by OpenFOAM, in the order of the data.

| module | one idea |
|---|---|
| `installation` | where OpenFOAM and `ehlFoam` are, what is missing, and the command that builds it |
| `dictionary` | entries of OpenFOAM's dictionaries: checked numbers, known words |
| `parameters` | the one file that Python writes into a case of a line, the oil over temperature |
| `case` | a working folder: copied from the template, removed when its run succeeded; those of runs that were killed |
| `pyfoam` | the only door to PyFoam: runs a program without a shell, parses small dictionaries |
| `run` | one program in one case: time limit, crash, kill, last lines of its log |
| `results` | what a run wrote: the dictionary `results`, the table `film.dat` |
| `point_case` | file, results and table of a point contact |
| `fields` | mesh and fields of the film by numpy; VTU or XDMF through meshio |
| `grid_solver` | one grid of a point, in as many tries as it takes |
| `point` | `OpenFoamPointSolver`: a point contact on two meshes, errors, status |
| `solver` | `OpenFoamSolver`: coarse and fine grid of each point, error estimates, statuses |

The solver itself is C++, in `openfoam_cases`. Nothing is imported here, so that ehdmaps works without OpenFOAM.
"""
