"""Maps in the formats of other programs.

| module | idea |
|---|---|
| `target` | what a target of `ehdmaps export` is, which ones are registered; axes, signs, range, provenance; folders |
| `map_curves` | curves over load of a map, at any speed and temperature; for pictures and reports, too |
| `csv` | curves over load of a law as a table |
| `mat` | points and law of a map as a struct for MATLAB and Octave |
| `resampled` | the law on a grid that linear interpolation reads |
| `modelica` | the law at one speed and temperature as pure functions in Modelica |
| `c` | the law and the bearing in C99 |
| `simpack` | a user force of Simpack over the kernel in C |
| `fmu` | a bearing as a Functional Mock-up Unit |
"""
