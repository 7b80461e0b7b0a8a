"""A stand-in for OpenFOAM and ehlFoam: reads the parameter file, writes what ehlFoam would, or misbehaves as told.

The folder of the fake build holds a file `mode` with the way to misbehave; `log` gets a line for every start.
"""

import os
import stat
import sys
from pathlib import Path

from ehdmaps.openfoam.installation import processor

PROGRAM = """
import sys
if "-help" in sys.argv:
    print("Usage: ehlFoam\\nUsing: OpenFOAM- (1912) - visit www.openfoam.com")
    sys.exit(0)
import json, math, os, re, signal, sys, time
from pathlib import Path

folder = Path(__file__).parents[1]
case = Path(sys.argv[sys.argv.index("-case") + 1])
mode = (folder / "mode").read_text().split()
text = (case / "constant" / "ehlProperties").read_text()
with open(folder / "log", "a") as log:
    log.write(f"{os.getpid()} {os.getppid()} {case}\\n")


def number(key):
    return float(re.search(rf"\\b{key} +([-+0-9.e]+);", text)[1])


print("fake ehlFoam\\nCreate mesh for time = 0", flush=True)
coarse = number("columns") < 300
if mode[0] == "fatal":
    print("--> FOAM FATAL IO ERROR:\\nviscosity is negative\\n\\nfile: constant/ehlProperties at line 7.", flush=True)
    sys.exit(1)
if mode[0] == "segv":
    print("Newton step 3\\n#0  Foam::error::printStack\\n#1  ? in libc.so.6", flush=True)
    os.kill(os.getpid(), signal.SIGSEGV)
if mode[0] == "killed" or (mode[0] == "killed_once" and not (folder / "marker").exists()):
    (folder / "marker").touch()
    os.kill(os.getpid(), signal.SIGKILL)
if mode[0] in ("hang", "hang_fine") and (mode[0] == "hang" or not coarse):
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    time.sleep(1e6)
if mode[0] == "silent":
    os.close(1)
    os.close(2)
    time.sleep(1e6)
if mode[0] == "flood":
    while True:
        sys.stdout.write("x" * 1_000_000)
if mode[0] == "patient":
    time.sleep(float(mode[1]))
if mode[0] == "nothing":
    sys.exit(0)
if mode[0] == "garbage":
    sys.stdout.buffer.write(bytes(range(256)) * 10)
    (case / "results").write_bytes(bytes(range(256)) * 10)
    sys.exit(0)

if "transverseRadius" in text:
    # a point: a paraboloid of pressure over a flat film, each number of the coarse mesh 1 % above that of the fine one
    nx, ny, rows = (int(number(key)) for key in ("columns", "lines", "rows"))
    R, E, load = number("reducedRadius"), number("reducedModulus"), number("load")
    a = (3 * load * R / (2 * E)) ** (1 / 3)
    peak = 2e-2 * E * a / R if mode[0] == "faint" else 0.3 * E * a / R
    status = mode[0] if mode[0] in ("stagnated", "diverged") else "converged"
    pair = lambda v: f"({1.01 * v!r} {v!r})"
    thick = {"thick": 0.02 * R, "thicker": R}.get(mode[0], 1e-7)
    entries = {
        "centralFilm": pair(1e-7), "minimumFilm": pair(8e-8), "maximumPressure": pair(peak), "filmOffset": pair(thick),
        "compliance": pair(1e-8 if mode[0] != "soft" else -1e-8), "lossCompliance": pair(1e-13),
        "massDefect": 1e-11, "loadDefect": 1e-12,
    }
    if mode[0] == "unresolved":
        entries["centralFilm"] = "(2e-7 1e-7)"
    if mode[0] == "nan":
        entries["filmOffset"] = "(1e-7 nan)"
    if status != "converged":
        entries = {}
    reason = '""' if status == "converged" else '"steps are cut to nothing"'
    entries |= {"status": status, "reason": reason, "iterations": 9, "seconds": 0.1}
    head = "FoamFile { version 2.0; format ascii; class %s; object %s; }\\n"
    body = "".join(f"{k} {v};\\n" for k, v in entries.items())
    (case / "results").write_text(head % ("dictionary", "results") + body)
    x = [a * (-2 + 3 * (i + 0.5) / nx) for i in range(nx)]
    y = [2 * a * (j + 0.5) / ny for j in range(ny)]
    line = lambda u, v: "%r %r %r 1e-07 1.0\\n" % (u, v, peak * max(0.0, 1 - (u * u + v * v) / a / a))
    table = [line(u, v) for v in y for u in x]
    (case / "film.dat").write_text("# x y pressure film liquid_fraction\\n" + "".join(table))
    if re.search("writeFields +true", text):
        (case / "constant" / "polyMesh").mkdir()
        (case / "1").mkdir()
        levels = [1e-7 * (k / rows - 0.5) for k in range(rows + 1)]
        at = [(a * (-2 + 3 * i / nx), 2 * a * j / ny, z) for j in range(ny + 1) for i in range(nx + 1) for z in levels]
        points = "\\n".join("(%r %r %r)" % each for each in at)
        body = head % ("vectorField", "points") + f"{len(at)}\\n(\\n{points}\\n)\\n"
        (case / "constant" / "polyMesh" / "points").write_text(body)
        numbered = "\\n".join(map(str, range(nx * ny * rows)))
        for name, value in {
            "p": f"nonuniform List<scalar>\\n{nx * ny * rows}\\n(\\n{numbered}\\n)\\n", "U": "uniform (1 0 0)",
            "mu": "uniform 0.1", "rho": "uniform 880", "liquidFraction": "uniform 1",
        }.items():
            kind = "volVectorField" if name == "U" else "volScalarField"
            (case / "1" / name).write_text(head % (kind, name) + f"internalField {value};\\n")
    print("End")
    sys.exit(0)

columns, rows = int(re.search(r"\\bcolumns +(\\d+);", text)[1]), int(re.search(r"\\brows +(\\d+);", text)[1])
R, E, load = number("reducedRadius"), number("reducedModulus"), number("load")
speed = 0.5 * (number("lowerSpeed") + number("upperSpeed"))
h = 3.0 * R * (0.1 * speed / (E * R)) ** 0.7 * (load / (E * R)) ** -0.1 * 1000
grid = 1.0 + 4.0 / columns**2 + 1.0 / rows**2
frequencies = [float(word) for word in re.search(r"\\bfrequencies[^(]*\\(([^)]*)\\)", text)[1].split()]


def listed(values):
    return "(" + " ".join(map(repr, values)) + ")"


status = mode[0] if mode[0] in ("stagnated", "diverged") else "converged"
begun = re.search(r"\\bx +//[^(]*\\(([^)]*)\\)", text)
grid_name = f"{columns}x{rows}" + (f"<{len(begun[1].split())}" if begun else "")
with open(folder / "grids", "a") as grids:
    grids.write(grid_name + "\\n")
if mode[0] == "stagnates_on" and grid_name in mode[1:]:
    status = "stagnated"
entries = {
    "status": status, "reason": '""' if status == "converged" else '"residual 1e-3 after 200 iterations"',
    "iterations": 7, "centralFilm": h * grid, "minimumFilm": 0.8 * h, "maximumPressure": 1e8 * math.sqrt(load / 1e4),
    "filmOffset": h * grid, "frequencies": listed(frequencies),
    "filmCompliance": listed([h * 0.1 / load * grid for _ in frequencies]),
    "lossCompliance": listed([1e-18 * grid / (1 + frequency) for frequency in frequencies]),
    "responseResidual": listed([0.0 if frequency < 1e6 else 0.1 for frequency in frequencies]),
    "wallStress": 2e7, "traction": 0.0, "rollingForce": 1.0,
    "loadDefect": 1e-10, "fluxDefect": 1e-10, "outletDefect": 1e-4, "cellContinuity": 1e-8, "seconds": 0.1,
}
if status != "converged":
    entries = {key: entries[key] for key in ("status", "reason", "iterations")}
if mode[0] == "nan":
    entries["filmOffset"] = "nan"
if mode[0] == "no_response":
    entries.update(frequencies="()", filmCompliance="()", lossCompliance="()", responseResidual="()")
if mode[0] == "thick":
    entries["filmOffset"] = 0.02 * R
if mode[0] == "negative":
    entries["lossCompliance"] = "(-1e-18)"
header = "FoamFile { version 2.0; format ascii; class %s; object %s; }\\n"
(case / "results").write_text(header % ("dictionary", "results") + "".join(f"{k} {v};\\n" for k, v in entries.items()))
b = math.sqrt(8 * load * R / (math.pi * E))
x = [b * (-4 + 6 * (i + 0.5) / columns) for i in range(columns)]
row = "%r %r %r %r %r %r\\n"
gap = h if "steep" in mode else 1e-2 * h  # thin where a Hertz pressure's edges are not to be too steep for the walls
table = [row % (v, 1e8 * math.sqrt(max(0, 1 - (v / b) ** 2)), gap, 1e-3, 880.0, 1.0) for v in x]
head = "# x pressure film flux density liquid_fraction\\n"
(case / "film.dat").write_text(head + "".join(table[: 3 if mode[0] == "cut" else None]))
if "fullStress;" in text:
    (case / "thinFilm.dat").write_text(head + "".join(table))
if "isotherms" in text:
    heads = " ".join(["# lower", *map(str, range(rows)), "upper"])
    (case / "temperature.dat").write_text("\\n".join([heads, *[" ".join(["313.15"] * (rows + 2))] * columns, ""]))
if mode[0] == "table":
    (case / "film.dat").write_text("# x pressure\\nwhat is this\\n")
if re.search("writeFields +true", text):
    mesh, last = case / "constant" / "polyMesh", case / "1"
    mesh.mkdir(exist_ok=True)
    last.mkdir(exist_ok=True)
    # across the film first, as a mesh whose direction of columns is not that of its cells
    corners = [(b * (-4 + 6 * i / columns), h * j / rows) for i in range(columns + 1) for j in range(rows + 1)]
    points = [(*corner, z) for z in (0.0, 1e-3) for corner in corners]
    side = (columns + 1) * (rows + 1)
    quads = [[i * (rows + 1) + j + k for k in (0, 1, rows + 2, rows + 1)] for i in range(columns) for j in range(rows)]
    faces = quads + [[k + side for k in quad] for quad in quads]
    cells = columns * rows

    def write(path, kind, lines, before=""):
        body = "\\n".join(["(", *lines, ")", ";" if before else ""])
        path.write_text(header % (kind, path.name) + f"{before}{len(lines)}\\n{body}")

    triple = lambda v: "(%r %r %r)" % tuple(v)
    write(mesh / "points", "vectorField", [triple(p) for p in points])
    write(mesh / "faces", "faceList", ["4(%d %d %d %d)" % tuple(face) for face in faces])
    write(mesh / "owner", "labelList", [str(i % cells) for i in range(2 * cells)])
    patches = "1\\n(\\nsides { type empty; nFaces %d; startFace 0; }\\n)\\n" % (2 * cells)
    (mesh / "boundary").write_text(header % ("polyBoundaryMesh", "boundary") + patches)
    centre = [((i + 0.5) / columns, (j + 0.5) / rows) for i in range(columns) for j in range(rows)]
    inside = "internalField nonuniform List<%s>\\n"
    velocity = [triple((speed * (0.5 + eta), 0.0, 0.0)) for _, eta in centre]
    write(last / "U", "volVectorField", velocity, inside % "vector")
    write(last / "p", "volScalarField", [repr(1e8 * xi) for xi, _ in centre], inside % "scalar")
    write(last / "mu", "volScalarField", [repr(0.1 + xi) for xi, _ in centre], inside % "scalar")
    (last / "rho").write_text(header % ("volScalarField", "rho") + "internalField uniform 880;\\n")
    (last / "liquidFraction").write_text(header % ("volScalarField", "liquidFraction") + "internalField uniform 1;\\n")
print("End")
"""


def build(folder: Path, mode: str = "good") -> dict[str, str]:
    """Make a fake build and a fake OpenFOAM in a folder; the environment that finds them."""
    programs = folder / "bin"
    programs.mkdir(parents=True, exist_ok=True)
    path = programs / "ehlFoam"
    path.write_text(f"#!{sys.executable} -ES\n{PROGRAM}")
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    record(folder)
    case = folder / "lineContact"
    for part in ("system", "0", "constant"):
        (case / part).mkdir(parents=True, exist_ok=True)
    (case / "system" / "controlDict").write_text("FoamFile { object controlDict; }\n")
    (case / "constant" / "ehlProperties").write_text("FoamFile { object ehlProperties; }\n")
    set_mode(folder, mode)
    return {
        "EHDMAPS_OPENFOAM": str(folder),
        "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}",
        "WM_PROJECT_DIR": str(folder),
        "WM_PROJECT_VERSION": "v1912",
        "TMPDIR": str(folder.parent),
    }


def record(folder: Path, version: str = "v1912", machine: str = "", sources: str = "0123abcd") -> str:
    """Write the record of a build, of this machine's processor unless told otherwise; what a map says of it."""
    lines = [f"openfoam {version}", "compiler g++ 12.2.0", f"processor {machine or processor()}", f"sources {sources}"]
    (folder / "bin" / "ehlFoam.build").write_text("".join(f"{line}\n" for line in lines))
    return " ".join(lines)


def set_mode(folder: Path, mode: str) -> None:
    """Say how ehlFoam behaves from now on."""
    (folder / "mode").write_text(mode)


def grids(folder: Path) -> list[str]:
    """Grid of every run so far that came to it, and behind < the columns of what it started from."""
    return (folder / "grids").read_text().split()


def starts(folder: Path) -> list[list[str]]:
    """Process, parent and case of every start of ehlFoam so far."""
    log = folder / "log"
    return [line.split() for line in log.read_text().splitlines()] if log.exists() else []
