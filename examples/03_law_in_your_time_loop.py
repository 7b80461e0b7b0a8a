"""The contact law in a time loop of your own: a mass that rings on one roller between two raceways.

Run it with `python examples/03_law_in_your_time_loop.py [FOLDER]`; the figure is written to the folder.
The period of m x'' = F - L w(x, x') after a push must be 2 pi/Im(s), s = -c/(2 m) + i sqrt(k/m - (c/2m)^2).
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import ehdmaps
from ehdmaps.outputs import write_figure

MASS, FORCE, SPEED, TEMPERATURE = 0.2, 1500.0, 2.0, 333.15
bearing, oil = ehdmaps.BearingGeometry.named("NU308"), ehdmaps.Lubricant.named("FVA3")
law = ehdmaps.law(bearing, oil, entrainment_speeds=(1.0, 4.0), temperatures=(330.0, 336.0)).at(SPEED, TEMPERATURE)
LENGTH = bearing.roller_length
rest = brentq(lambda x: LENGTH * float(law(x, 0.0)[0]) - FORCE, 1e-6, 20e-6, xtol=1e-15)
k, c = (LENGTH * float(value) for value in law(rest, 0.0)[1:])
s = np.sqrt(complex((c / (2 * MASS)) ** 2 - k / MASS)) - c / (2 * MASS)
period = 2 * np.pi / abs(s.imag)
times = np.linspace(0.0, 10 * period, 40001)
begin, options = [0.0, 1e-6 * abs(s)], {"t_eval": times, "rtol": 1e-9, "atol": 1e-14}
run = solve_ivp(
    lambda _, y: [y[1], (FORCE - LENGTH * float(law(rest + y[0], y[1])[0])) / MASS], times[[0, -1]], begin, **options
)
counted = np.diff(times[1:][np.diff(np.sign(run.y[0])) > 0.0])[-4:].mean()  # the first, larger swings are not linear
law_words = f"k = {1e-6 * k:.4g} N/um and c = {1e-3 * c:.4g} N s/mm of the law"
print(f"{1 / counted:.1f} Hz counted, {1 / period:.1f} Hz by {law_words}")
assert abs(counted / period - 1.0) < 1e-3  # what is not linear in a swing of some tenths of a micrometre
figure, axes = plt.subplots(figsize=(7.0, 3.0), layout="constrained")
axes.plot(1e3 * run.t, 1e6 * run.y[0])
axes.plot(1e3 * run.t, np.exp(s.real * run.t) * np.sin(abs(s.imag) * run.t), "--")
axes.set(xlabel="time, ms", ylabel="motion, um", title="law in a time loop; dashed: linear, k and c of the law")
write_figure(figure, Path(sys.argv[1] if len(sys.argv) > 1 else ".") / "03_time_loop.png")
