"""Recipes of figures that `mbs` prints: modes, responses and run-ups of machines."""

from __future__ import annotations

import re
from collections.abc import Sequence

from tests.benchmarks.page_block import Figure, Given, given, significant
from tests.benchmarks.printed_tables import NUMBER, Mode, Output, one_case, sweep_cases, variants

# --- the gearbox, linear


def shaft_bearing_modes(outputs: Sequence[Output]) -> list[Figure]:
    """Modes that fall, over clearance, load and cage angle."""
    clearances, loads, *angles = (output.text for output in outputs)
    middle = one_case([clearances], "film table, 30 um")
    found: list[Figure] = given("1.5 30")
    for mode in middle.bearing_modes():
        found += [mode.first, mode.last, mode.change]
    for clearance in ("40", "20"):
        found += given(clearance)
        found += [mode.change for mode in one_case([clearances], f"film table, {clearance} um").bearing_modes()]
    found += [*given("75 30"), one_case([loads], "0.9146 x").steepest()]
    across = max(mode.change for mode in middle.complex.values() if mode.first < 1200.0)
    found += [*given("1.2"), across, *given("30 0 7.5 15 22.5 30")]
    turned = [sweep_cases(text)[0] for text in angles]
    return [*found, *(case.steepest() for case in turned), *(case.highest_rise() for case in turned)]


def without_clearance(outputs: Sequence[Output]) -> list[Figure]:
    """Largest rise without clearance."""
    return [one_case([outputs[0].text], "film table, 0 um").highest_rise()]


def stiffness_of_bearings(outputs: Sequence[Output]) -> list[Figure]:
    """k along the load, by clearance and map."""
    own, other = (one_case([outputs[0].text], f"film table, {c} um").along for c in ("30", "0"))
    cfd = one_case([outputs[1].text], "OpenFOAM").along
    return [*given("30"), own.changes[0], *own.k, *given("0"), other.changes[0], *given("30"), cfd.changes[0]]


def damping_of_bearings(outputs: Sequence[Output]) -> list[Figure]:
    """c along the load, by clearance and map."""
    own, other = (one_case([outputs[0].text], f"film table, {c} um").along for c in ("30", "0"))
    cfd = one_case([outputs[1].text], "OpenFOAM").along
    ends = [significant(value, 3) for value in own.c]
    return [*given("30"), own.changes[1], *ends, *given("0"), other.changes[1], *given("30"), cfd.changes[1]]


def dry_shift(outputs: Sequence[Output]) -> list[Figure]:
    """Largest change of an undamped mode of the dry cases; complex ones, with gyroscopic terms, lie below the limit."""
    dry = [case for case in sweep_cases(outputs[0].text) if "dry Hertz" in case.title]
    shift = max(abs(mode.change) for case in dry for mode in case.undamped.values())
    limit = max(abs(mode.change) for case in dry for mode in case.complex.values())
    return [shift, Given("0.01") if limit < 0.01 else limit]


def loads_of_the_gearbox(outputs: Sequence[Output]) -> list[Figure]:
    """Changes of k, c and of the mode that falls most, at three torques."""
    cases = sweep_cases(outputs[0].text)
    return [
        *given("75 150 305"),
        *(case.along.changes[0] for case in cases),
        *(case.along.changes[1] for case in cases),
        *(case.steepest() for case in cases),
    ]


def energy_theorem(outputs: Sequence[Output]) -> list[Figure]:
    """Check that changes and those by energy, summed, agree as printed (30 um); a wrong pair is a figure too many."""
    case = one_case([outputs[0].text], "film table, 30 um")
    rows = re.findall(rf"(?m)^ +\d+ +\S+ to +\S+ +{NUMBER} % +{NUMBER} %, ", case.text)
    wrong: list[Figure] = [float(first) for first, second in rows if first != second]
    return [*given("1 2 30"), *wrong]


def widths_of_resonances(outputs: Sequence[Output]) -> list[Figure]:
    """Widths 2 zeta f of the modes along the load at the first and last speed [Hz]; falls of damping ratios [%]."""
    modes = one_case([outputs[0].text], "film table, 30 um").bearing_modes()
    widths = [(2.0 * m.damping_ratio * m.first, 2.0 * m.last_ratio * m.last) for m in modes]
    falls = [100.0 * (1.0 - m.last_ratio / m.damping_ratio) for m in modes]
    return [*given("2 500 2500 30"), *(round(width) for pair in widths for width in pair), min(falls), max(falls)]


def slow_and_memory(outputs: Sequence[Output]) -> list[Figure]:
    """Fall and damping of the modes along the load with slow films and with memory, and the errors of both."""
    found: list[Figure] = given("30 0")
    for films, speeds in (("slow films", "500 2500"), ("films with memory", "")):
        modes = one_case([outputs[0].text], f"film table, {films}").bearing_modes()
        found += [-mode.change for mode in modes]
        found += [*given(speeds), *(100.0 * mode.damping_ratio for mode in modes), *given("500")]
    words = rf"estimated error of the dynamic stiffness along the load at {NUMBER} Hz and {NUMBER} rpm: {NUMBER} %"
    told = [re.findall(f"{films}; {words}", outputs[0].text) for films in ("slow films", "films with memory")]
    slow, memory = (max((tuple(map(float, row)) for row in rows), key=lambda row: row[2]) for rows in told)
    return [*found, 1e-3 * slow[0], slow[1], slow[2], memory[2]]


# --- other machines, linear


def highest_peaks(text: str, last: bool) -> list[tuple[float, float]]:
    """Height and frequency of the peaks of S1 that a case of `mbs sweep` prints, at its first or last speed."""
    line = re.search(r"(?m)^  S1 by .*\]: (.*)$", text)
    assert line is not None
    part = line[1].split(";")[-1 if last else 0]
    return [(float(height), float(at)) for height, at in re.findall(rf"{NUMBER} \({NUMBER} Hz\)", part)]


def rigid_over_speed_and_load(outputs: Sequence[Output]) -> list[Figure]:
    """Shaft mode of nu308_rigid along the load, frequency and height of S1, at three loads and two speeds."""
    found: list[Figure] = [*given("20 141 212 283")]
    for clearance in ("20 um", "0 um"):
        titles = [f"{clearance}, {factor} x load" for factor in ("1", "1.5", "2")]
        cases = [case for case in sweep_cases(outputs[0].text) if case.title in titles]
        peaks = [[highest_peaks(case.text, last)[-1] for case in cases] for last in (False, True)]
        for column, speed in ((1, "500"), (1, "2000"), (0, "500"), (0, "2000")):
            row = peaks[speed == "2000"]
            found += [*(peak[column] for peak in row), *given(speed)]
    return found


def rig_over_speed_and_clearance(outputs: Sequence[Output]) -> list[Figure]:
    """Highest peak of S1 of n1014_testrig at the first and last speed, by clearance."""
    found: list[Figure] = []
    for clearance, case in zip(("0", "10", "20"), sweep_cases(outputs[0].text), strict=True):
        both = [max(highest_peaks(case.text, last)) for last in (False, True)]
        found += [*given(clearance), both[0][1], both[1][1], both[0][0], both[1][0]]
    return [*given("300 2000"), *found]


def stiffness_of_the_flexible(outputs: Sequence[Output]) -> list[Figure]:
    """k of a bearing of nu308_flexible dry, and with the map at the first and last speed; fall of c over the speeds."""
    found: list[Figure] = []
    for factor, load in (("1", "141"), ("2", "283")):
        dry, film = (one_case([outputs[0].text], f"{law}, {factor} x").along for law in ("dry Hertz", "film table"))
        changes = [100.0 * (value / dry.k[0] - 1.0) for value in film.k]
        found += [*given(load), *changes, film.changes[1]]
    return [*given("200 2000 20"), *found]


def mode_rows(text: str) -> list[tuple[float, float, str]]:
    """Frequency, damping ratio and energies that `mbs modes` prints."""
    rows = re.findall(rf"(?m)^ +\d+ +{NUMBER} +{NUMBER}   (.*)$", text)
    return [(float(frequency), float(ratio), energy) for frequency, ratio, energy in rows]


def housing_modes(outputs: Sequence[Output]) -> list[Figure]:
    """Dry and with the map, of the five modes of the housing below 3 kHz."""
    dry, film = (
        [row[0] for row in mode_rows(output.text) if float(re.search(r"housing ([\d.]+)", row[2])[1]) >= 98.0]  # type: ignore[index]
        for output in (
            Output(output.command, "\n".join(line for line in output.text.splitlines() if "housing" in line))
            for output in outputs
        )
    )
    pairs = list(zip(dry, film, strict=False))[:5]
    found: list[Figure] = given("98 2000")
    for index, (first, last) in enumerate(pairs):
        found += [first, last]
        if index >= 2:
            found.append(100.0 * (last / first - 1.0))
    return found


def run_of_flexible(outputs: Sequence[Output]) -> list[Figure]:
    """Range of the force of a bearing, and its largest change between samples."""
    found = re.search(rf"begin\w*, {NUMBER} to {NUMBER} N,.* {NUMBER} N below .* and {NUMBER} N above", outputs[0].text)
    assert found is not None
    low, high, *changes = map(float, found.groups())
    return [*given("0"), low, high, *given("0 2000 40"), max(changes)]


def _along_load(text: str, title: str) -> Mode:
    """The undamped mode of nu308_flexible along its load: the fifth."""
    return one_case([text], title).undamped[5]


def loads_of_the_flexible(outputs: Sequence[Output]) -> list[Figure]:
    """Mode along the load at three loads, with the map and dry, at the lowest speed; with the map at the highest."""
    film, dry = (
        [_along_load(outputs[0].text, f"{law}, {factor} x") for factor in ("1", "1.5", "2")]
        for law in ("film table", "dry Hertz")
    )
    slow = [mode.first for mode in (*film, *dry)]
    return [*given("200 20"), *slow, *given("2000"), *(mode.last for mode in film)]


def highest_peak(text: str) -> tuple[float, float]:
    """Frequency and height of the highest peak of sensor S1 that `mbs lsa` prints."""
    found = re.search(r"(?m)^  S1 .*: peaks at (.*)$", text)
    assert found is not None
    peaks = [tuple(map(float, peak)) for peak in re.findall(rf"{NUMBER} Hz \({NUMBER}(?: [^)]*)?\)", found[1])]
    frequency, height = max(peaks, key=lambda peak: peak[1])
    return frequency, height


def amplitudes_of_the_rig(outputs: Sequence[Output]) -> list[Figure]:
    """Highest peaks with the constants of the thesis and with laws of this project."""
    constants = [highest_peak(output.text) for output in outputs[:3]]
    dry, film = (highest_peak(output.text) for output in outputs[3:])
    heights, frequencies = zip(*constants, strict=True)
    return [*frequencies, *heights, *given("16281"), *dry, *film]


def constants_of_the_rigid(outputs: Sequence[Output]) -> list[Figure]:
    """Two modes of n1014_rigid with the constants of the thesis: those next to the frequencies shown."""
    columns = [[row[0] for row in mode_rows(output.text)] for output in outputs]
    found: list[Figure] = []
    for near in (285.0, 2910.0):
        found += [min(column, key=lambda frequency: abs(frequency - near)) for column in columns]
    return found


def shaft_mode_of_the_rigid(outputs: Sequence[Output]) -> list[Figure]:
    """Mode of nu308_rigid nearest to the thesis' 4771 Hz among those along the load: the seventh."""
    return [mode_rows(outputs[0].text)[6][0]]


def own_laws_of_the_rigid(outputs: Sequence[Output]) -> list[Figure]:
    """Radial mode of the ring, and highest mode below 10 kHz, of n1014_rigid: dry, formula, map."""
    found: list[Figure] = []
    for output in outputs:
        held = [float(row[0]) for row in re.findall(rf"(?m)^ +\d+ +{NUMBER} +{NUMBER} .* %", output.text)]
        found += [min(held, key=lambda frequency: abs(frequency - 400.0)), max(held)]
    return [found[0], found[2], found[4], found[1], found[3], found[5]]


def bushings_of_the_rigid(outputs: Sequence[Output]) -> list[Figure]:
    """Stiffness of bilateral rollers [N/um]; how many unilateral ones are loaded; theirs, along and across the load."""
    rows = [
        [float(value) for value in re.findall(NUMBER, line)]
        for line in re.findall(r"(?m)^    [yz]  (.*)$", outputs[0].text.partition("C [")[0])
    ]
    loaded = re.search(r"; (\d+) of (\d+) rollers loaded", outputs[0].text)
    assert loaded is not None
    rollers, constant = float(loaded[2]), re.search(rf"{NUMBER} N/um and", outputs[0].text)
    assert constant is not None
    bilateral = 0.5 * rollers * 0.5 * float(constant[1])
    return [*given("24"), bilateral, float(loaded[1]), *given("24"), rows[0][0], rows[1][1]]


def hammer_test(outputs: Sequence[Output]) -> list[Figure]:
    """Fitted modes beside eigenvalues."""
    eigenvalues = [
        (float(f), 100.0 * float(zeta))
        for f, zeta in re.findall(rf"(?m)^ +\d+ +{NUMBER} Hz   damping ratio {NUMBER}", outputs[0].text)
    ]
    fitted = [
        (float(f), 100.0 * float(zeta))
        for f, zeta in re.findall(rf"(?m)^ +\d+ +{NUMBER} +\S+ +{NUMBER} ", outputs[1].text)
    ]
    pairs = [(fit, min(eigenvalues, key=lambda each: abs(each[0] - fit[0]))) for fit in (fitted[0], fitted[-1])]
    (strong, strong_exact), (weak, weak_exact) = pairs
    return [*given("1"), *strong, *strong_exact, *weak_exact, *weak]


# --- run-ups of the gearbox


def differences_at_speed(text: str, name: str) -> tuple[float, ...]:
    """Median, 5 and 95 % quantile, and difference of the highest levels [dB] that `mbs campbell` prints."""
    found = re.search(
        rf"  {name} beside .*: median {NUMBER} dB, 5 to 95 % of the windows {NUMBER} to {NUMBER} dB; .* {NUMBER} dB",
        text,
    )
    assert found is not None
    return tuple(map(float, found.groups()))


def highest_levels(text: str) -> list[float]:
    """Highest sum levels [dB] that `mbs campbell` prints, law by law."""
    return [float(level) for level in re.findall(rf"highest sum level {NUMBER} dB", text)]


def films_beside_dry(outputs: Sequence[Output]) -> list[Figure]:
    """What `mbs variants` shows of the film beside dry contacts, at the sensors of the housing."""
    rows = [variants(outputs[0].text, sensor) for sensor in ("S1", "S2", "S3")]
    undamped = [row for each in rows for (key, _), row in each.items() if key != "law"]
    damped = [row for each in rows for (key, _), row in each.items() if key == "law"]
    medians, highest = [row.median for row in undamped], [row.highest for row in undamped]
    return [
        *(-max(medians), -min(medians), -max(highest), -min(highest)),
        *given("12.5"),
        *(min(row.median for row in damped), max(row.median for row in damped)),
    ]


def levels_of_laws(outputs: Sequence[Output]) -> list[Figure]:
    """Highest sum levels: dry, Reynolds map, OpenFOAM map."""
    dry, _, reynolds, openfoam = highest_levels(outputs[0].text)
    return [dry, reynolds, openfoam]


def level_of_the_formula(outputs: Sequence[Output]) -> list[Figure]:
    """By how much the film formula lies below dry bearings."""
    return [-differences_at_speed(outputs[0].text, ".*formula")[0], *given("30")]


def formula_beside_films(outputs: Sequence[Output]) -> list[Figure]:
    """Highest sum level of the formula; distance of both maps."""
    _, formula, reynolds, openfoam = highest_levels(outputs[0].text)
    return [formula, abs(reynolds - openfoam)]


def peaks_beside_modes(text: str, law: str) -> list[tuple[float, float]]:
    """Frequencies of the strongest peaks along the orders and of the modes beside them, of a law [Hz]."""
    part = re.split(rf"(?m)^{law}: ", text)[1]
    part = re.split(r"(?m)^\w", part.partition("\n")[2])[0]
    rows = re.findall(rf"(?m)^ +{NUMBER} +{NUMBER} +{NUMBER} .* mode {NUMBER} Hz", part)
    return [(float(row[2]), float(row[3])) for row in rows]


def peaks_with_films(outputs: Sequence[Output]) -> list[Figure]:
    """Peaks beside modes, with the Reynolds map."""
    return [value for pair in peaks_beside_modes(outputs[0].text, "film table") for value in pair]


def peaks_dry(outputs: Sequence[Output]) -> list[Figure]:
    """The dry peak farthest from its mode, within 5 %; and how much a start moved by 10 nm changes single windows."""
    farthest = max(peaks_beside_modes(outputs[0].text, "dry Hertz"), key=lambda pair: abs(pair[0] / pair[1] - 1.0))
    apart = 100.0 * abs(farthest[0] / farthest[1] - 1.0)
    dry = outputs[1].text.partition("law hertz: ")[2]
    moved = re.search(r"(?m)^start moved by 10 nm (.*)$", dry)
    assert moved is not None
    values = [float(value) for value in re.findall(NUMBER, moved[1])]
    return [Given("5") if 4.0 < apart < 5.0 else apart, *farthest, *given("10"), max(values[8], values[10], values[12])]


def readme_of_the_gearbox(outputs: Sequence[Output]) -> list[Figure]:
    """Levels beside dry contacts and their range; largest falls and rises over speed, by cage angle."""
    levels, beside_damped, clearances, *angles = (output.text for output in outputs)
    rows = variants(levels, "S1")
    base = rows["base", "-"]
    damped = [row.median for sensor in ("S1", "S2", "S3") for row in variants(beside_damped, sensor).values()]
    least, most, *_ = films_beside_dry(outputs[:1])
    middle = one_case([clearances], "film table, 30 um")
    cases = [middle, *(sweep_cases(text)[0] for text in angles)]
    falls, rises = ([getattr(case, name)() for case in cases] for name in ("steepest", "highest_rise"))
    return [
        -base.median,
        *given("5 95"),
        -base.high,
        significant(-base.low, 2),
        *given("500 2500 40 30"),
        least,
        most,
        *given("1.25e-5"),
        abs(variants(beside_damped, "S1")["base", "-"].median),
        min(damped),
        max(damped),
        -max(falls),
        -min(falls),
        min(rises),
        max(rises),
    ]
