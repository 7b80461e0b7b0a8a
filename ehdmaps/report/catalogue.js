"use strict";
// Films, stiffness, damping and capacitance of one contact, read from both film tables as `ehdmaps.table` and
// `ehdmaps.electrics` read them. All numbers are in SI.
{
  const data = JSON.parse(document.getElementById("tables").textContent);
  const { line: lines, point: points, oil: oils, bearing: bearings, constants: C, gap: gaps } = data;

  const bytesOf = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  for (const part of [lines.piezoviscous, lines.isoviscous, points]) {
    part.values = new Float32Array(bytesOf(part.values).buffer);
    part.codes = bytesOf(part.codes);
  }

  const named = (kind, row) => Object.fromEntries(data.names[kind].map((name, i) => [name, row[i]]));
  for (const of of Object.values(bearings)) of.contacts = of.contacts.map((row) => named(of.kind, row));

  const clip = (x, low, high) => Math.min(Math.max(x, low), high);
  const last = (list) => list[list.length - 1];
  const within = (x, nodes, slack) => x >= nodes[0] - slack && x <= last(nodes) + slack;

  // Cubic B-splines at a place: the first that counts, four weights, and their derivatives.
  const spline = (knots, x) => {
    let span = 3;
    while (span < knots.length - 5 && x >= knots[span + 1]) span += 1;
    let weights = [1];
    let quadratic = weights;
    for (let degree = 1; degree <= 3; degree += 1) {
      const next = new Array(degree + 1).fill(0);
      for (let r = 0; r < degree; r += 1) {
        const right = knots[span + r + 1];
        const left = knots[span + r + 1 - degree];
        const part = weights[r] / (right - left);
        next[r] += (right - x) * part;
        next[r + 1] += (x - left) * part;
      }
      quadratic = weights;
      weights = next;
    }
    const slopes = [0, 0, 0, 0];
    quadratic.forEach((value, r) => {
      const part = (3 * value) / (knots[span + r + 1] - knots[span + r - 2]);
      slopes[r] -= part;
      slopes[r + 1] += part;
    });
    return { first: span - 3, weights, slopes };
  };

  // Weights of all nodes of an axis, and their derivatives.
  const cardinal = (axis, x) => {
    const { first, weights, slopes } = spline(axis.knots, x);
    const count = axis.nodes.length;
    const sum = (by) => axis.nodes.map((_, m) => by.reduce((s, b, p) => s + b * axis.inverse[(first + p) * count + m], 0));
    return { weights: sum(weights), slopes: sum(slopes) };
  };

  const lagrange = (nodes, x) =>
    nodes.map((own, i) => nodes.reduce((p, other, j) => (j === i ? p : (p * (x - other)) / (own - other)), 1));

  const cellOf = (nodes, x) => {
    let place = 0;
    while (place < nodes.length - 2 && x >= nodes[place + 1]) place += 1;
    return place;
  };

  // Sums of values over nodes; the last list of weights is that of the innermost axis.
  const sums = (values, fields, weights) => {
    const out = new Array(fields).fill(0);
    const step = (level, weight, place) => {
      if (level === weights.length) {
        for (let f = 0; f < fields; f += 1) out[f] += weight * values[place * fields + f];
        return;
      }
      const own = weights[level];
      for (let i = 0; i < own.length; i += 1) if (own[i] !== 0) step(level + 1, weight * own[i], place * own.length + i);
    };
    step(0, 1, 0);
    return out;
  };

  // State of an oil at a temperature: Chebyshev series of what `oil_states` gives.
  const series = (coefficients, x) => {
    let [a, b] = [0, 0];
    for (let i = coefficients.length - 1; i > 0; i -= 1) [a, b] = [2 * x * a - b + coefficients[i], a];
    return x * a - b + coefficients[0];
  };
  const stateOf = (oil, T) => {
    if (!(T >= oil.low && T <= oil.high)) return null;
    const x = (2 * T - oil.low - oil.high) / (oil.high - oil.low);
    const exponents = oil.exponents.map((one) => series(one, x));
    return { viscosity: Math.exp(series(oil.viscosity, x)), alpha: Math.exp(series(oil.alpha, x)), exponents };
  };

  const bendOf = (alpha, z) => (1 - z) * Math.sqrt(C.ALPHA / alpha);
  const shiftOf = (L, alpha, z) => {
    const bend = bendOf(alpha, z);
    const moved = (0.62 * (1 - z)) / (alpha * C.ROELANDS_PRESSURE) + 0.18 * bend + 0.115 * bend * bend;
    return 0.17 * Math.log1p((L * L) / C.HARDENING_L ** 2) + (moved * L * L) / (L * L + C.BENDING_L ** 2);
  };
  const zetaOf = (M, L, shift) => Math.log((M / 2.2) * (1 + L / 12)) - shift;
  const matchedPressure = (zeta, L) => {
    const dive = (Math.exp(-((zeta / C.VALLEY_WIDTH) ** 2)) * L * L) / (L * L + 100);
    return clip(0.9 * L ** 0.28, 0.9, 2.6) * (1 + dive);
  };
  const exponentAt = (exponents, matched) =>
    lagrange(C.MATCHED.map(Math.log), Math.log(matched)).reduce((s, w, i) => s + w * exponents[i], 0);

  const decoded = (code) => C.LEAST_ERROR * (C.LARGEST_ERROR / C.LEAST_ERROR) ** (code / C.CODES);

  // Smooth forms of one part of the table of lines, beyond its nodes too, and errors of what a law is made from.
  const readPart = (part, zeta, size, alpha, bend) => {
    const [held, heldSize] = [part.zeta, part.size].map((axis, i) =>
      clip([zeta, size][i], axis.nodes[0], last(axis.nodes)));
    const away = zeta - held;
    const [below, above, flatter] = [Math.min(away, 0), Math.max(away, 0), Math.expm1(Math.min(size - heldSize, 0))];
    const [along, by] = [cardinal(part.zeta, held), cardinal(part.size, heldSize)];
    const rest = [lagrange(part.alpha, alpha), lagrange(part.bend, bend)];
    const fields = C.FIELDS.length;
    const read = (first, second) => sums(part.values, fields, [first, second, ...rest]);
    let values = read(along.weights, by.weights);
    if (below < 0 || above > 0 || flatter < 0) {
      const slope = read(along.slopes, by.weights);
      const bySize = read(along.weights, by.slopes);
      const slopeBySize = read(along.slopes, by.slopes);
      values = values.map((value, k) => {
        const field = C.FIELDS[k];
        const v = value + flatter * bySize[k];
        const s = slope[k] + flatter * slopeBySize[k];
        if (below < 0) {
          const rigid = field.rigid * (field.scale ? Math.sign(v) : 1);
          return v + rigid * below + (s - rigid) * Math.expm1(below);
        }
        if (field.fades) {
          const rate = Math.min(slope[k] / value, 0);
          return (v + flatter * above * (slopeBySize[k] - rate * bySize[k])) * Math.exp(rate * above);
        }
        return field.scale ? v - s * Math.expm1(-above) : v + s * above;
      });
    }
    const axes = [[part.zeta.nodes, zeta], [part.size.nodes, size], [part.alpha, alpha], [part.bend, bend]];
    const cell = axes.reduce((place, [nodes, x]) => place * (nodes.length - 1) + cellOf(nodes, x), 0);
    const beyond = C.BEYOND_HEAVY * above - C.BEYOND_FLAT * flatter - C.BEYOND_LIGHT * Math.expm1(below);
    const errors = [0, 1, 2].map((k) => decoded(part.codes[cell * 3 + k]) + beyond);
    return { values, errors };
  };

  const readLine = (M, L, alpha, z) => {
    const { piezoviscous: piezo, isoviscous: iso } = lines;
    const [begin, end] = [piezo.alpha[0], Math.log(last(iso.alpha))];
    const t = clip((Math.log(alpha) - begin) / (end - begin), 0, 1);
    const share = t * t * (3 - 2 * t);
    const all = [
      [piezo, share, zetaOf(M, L, shiftOf(L, alpha, z)), Math.log(L), Math.log(alpha), bendOf(alpha, z)],
      [iso, 1 - share, zetaOf(M, L, 0), Math.log(L / alpha), alpha, 1 - z],
    ];
    const found = { values: C.FIELDS.map(() => 0), errors: [0, 0, 0] };
    for (const [part, counts, zeta, size, byAlpha, byBend] of all) {
      if (!counts) continue;
      const one = readPart(part, zeta, size, byAlpha, clip(byBend, part.bend[0], last(part.bend)));
      one.values.forEach((value, k) => { found.values[k] += counts * value; });
      one.errors.forEach((value, k) => { found.errors[k] += counts * value; });
    }
    return found;
  };

  const NONE = { offset: NaN, stiffness: NaN, damping: NaN, central: NaN, minimum: NaN, capacitance: NaN };

  const lineFilms = (contact, state, w, u) => {
    const { radius: R, modulus: E } = contact;
    const { viscosity, exponents } = state;
    const alpha = Math.max(state.alpha, C.LEAST_ALPHA);
    const { piezoviscous: piezo, isoviscous: iso } = lines;
    const number = (2 * viscosity * u) / (E * R);
    const [M, L] = [w / (E * R) / Math.sqrt(number), alpha * E * number ** 0.25];
    const own = exponents.length === 1;
    let [z, beside] = [exponents[0], exponents[0]];
    if (!own) {
      const matched = matchedPressure(zetaOf(M, L, shiftOf(L, alpha, exponents[1])), L);
      [z, beside] = [exponentAt(exponents, matched), exponentAt(exponents, C.BESIDE * matched)];
    }
    const bends = (exponent) => {
      const slack = C.SLACK * (last(piezo.bend) - piezo.bend[0]);
      return within(bendOf(Math.max(alpha, Math.exp(piezo.alpha[0])), exponent), piezo.bend, slack);
    };
    const pressure = Math.sqrt((w * E) / (2 * Math.PI * R));
    const refused = !(M > 0 && Number.isFinite(L)) || pressure > C.LARGEST_PRESSURE
      || M > C.HEAVIEST_LOAD_NUMBER || M < C.LIGHTEST_LOAD_NUMBER
      || L > Math.exp(last(piezo.size.nodes)) * (1 + C.SLACK)
      || (alpha < last(iso.alpha) && L > Math.exp(last(iso.size.nodes)) * (1 + C.SLACK) * alpha)
      || Math.log(alpha) > last(piezo.alpha) + C.SLACK || !bends(z)
      || zetaOf(M, L, shiftOf(L, alpha, z)) > last(piezo.zeta.nodes) + C.FARTHEST;
    if (refused) return NONE;
    const { values, errors } = readLine(M, L, alpha, z);
    if (!own) {
      const moved = readLine(M, L, alpha, bends(beside) ? beside : 2 * z - beside).values;
      contact.factors(state.fitted).forEach((factor, k) => { errors[k] += Math.abs(values[k] - moved[k]) * factor; });
    }
    if (errors.some((error) => !(error < C.WORST_ERROR))) return NONE;
    const half = Math.sqrt((8 * w * R) / (Math.PI * E));
    const unit = R * Math.sqrt(number);
    const reduced = values.map((value, k) => (C.FIELDS[k].scale ? C.FIELDS[k].scale * Math.sinh(value) : Math.exp(value)));
    const offset = reduced[0] * unit;
    if (offset > C.THICKEST_FILM * R) return NONE;
    const stiffness = 1 / (0.9 * contact.dry * w ** -0.1 + reduced[1] / E);
    const damping = ((reduced[2] * half) / (u * E)) * stiffness ** 2;
    return { offset, stiffness, damping, central: reduced[3] * unit, minimum: reduced[4] * unit, half, pressure };
  };

  const pointFilms = (contact, state, F, u) => {
    const { radius: R, modulus: E, ellipticity: kappa } = contact;
    const { viscosity, alpha, exponents } = state;
    const number = (2 * viscosity * u) / (E * R);
    const [M, L] = [(F / (E * R * R)) * number ** -0.75, alpha * E * number ** 0.25];
    const zeta = Math.log(M) - (Math.log(C.KNEE) + C.KNEE_OF_KAPPA * Math.log(kappa) - C.KNEE_OF_L * Math.log(L / C.KNEE_L));
    const z = exponents.length === 1 ? exponents[0] : exponentAt(exponents, matchedPressure(Infinity, L));
    const bend = bendOf(alpha, z);
    const a = Math.cbrt(contact.width * F);
    const pressure = contact.pressure * a;
    const inside = (x, nodes) => within(x, nodes, C.SLACK);
    const refused = !(M > 0 && Number.isFinite(L)) || pressure > C.LARGEST_PRESSURE
      || !inside(Math.log(kappa), points.shape.nodes) || !inside(Math.log(alpha), points.alpha)
      || !inside(bend, points.bend) || !inside(Math.log(L), points.size.nodes)
      || zeta > last(points.zeta.nodes) + C.SLACK || zeta < C.LIGHTEST;
    if (refused) return NONE;
    const places = [[points.zeta.nodes, zeta], [points.size.nodes, Math.log(L)], [points.shape.nodes, Math.log(kappa)],
      [points.alpha, Math.log(alpha)], [points.bend, bend]].map(([nodes, x]) => [nodes, clip(x, nodes[0], last(nodes))]);
    const cell = places.reduce((place, [nodes, x]) => place * (nodes.length - 1) + cellOf(nodes, x), 0);
    if (points.codes[cell] === C.CODES) return NONE;
    const [along, size, shape] = [points.zeta, points.size, points.shape].map((axis, i) => cardinal(axis, places[i][1]));
    const rest = [size.weights, shape.weights, lagrange(points.alpha, places[3][1]), lagrange(points.bend, places[4][1])];
    const below = Math.min(zeta - points.zeta.nodes[0], 0);
    let values = sums(points.values, C.POINT_SLOPES.length, [along.weights, ...rest]);
    let slope = sums(points.values, C.POINT_SLOPES.length, [along.slopes, ...rest])[0];
    if (below < 0) {
      values = values.map((value, k) => value + C.POINT_SLOPES[k] * below);
      slope = C.POINT_SLOPES[0];
    }
    const [offset, damping, central, minimum] = values.map(Math.exp);
    const unit = R * Math.sqrt(number);
    const film = offset * unit;
    if (film / R > C.THICKEST_FILM || film > contact.widest) return NONE;
    const stiffness = 1 / (1 / (contact.stiffness * Math.cbrt(F)) - (slope * film) / F);
    return { offset: film, stiffness, damping: (damping * E * R * R * Math.sqrt(number)) / u, central: central * unit,
      minimum: Math.min(minimum, central) * unit, a, b: kappa * a, approach: contact.approach * a * a, pressure };
  };

  // Capacitance, see `ehdmaps.electrics.gaps`: the cubic of `_beside_lines`, with its slope.
  const besideLines = (x) => {
    const step = (last(gaps.lines.x) - gaps.lines.x[0]) / (gaps.lines.x.length - 1);
    const place = clip(Math.floor((x - gaps.lines.x[0]) / step), 0, gaps.lines.x.length - 2);
    const d = x - gaps.lines.x[place];
    const [a, b, c, e] = gaps.lines.c.map((row) => row[place]);
    return [((a * d + b) * d + c) * d + e, (3 * a * d + 2 * b) * d + c];
  };
  const opening = (R, half, film) => {
    const [value, slope] = besideLines(Math.log(clip((2 * R * film) / half ** 2, gaps.THIN, gaps.THICKEST)));
    return [((2 * R) / half) * Math.exp(value), slope];
  };
  const outlet = (R, half, film, permittivity) => {
    const [full, slope] = opening(R, half, film);
    const squared = full * -slope;
    return [full, squared + (full - squared) / permittivity];
  };
  const denser = (permittivity, ratio) => {
    const part = ((permittivity - 1) / (permittivity + 2)) * ratio;
    return (1 + 2 * part) / (1 - part);
  };
  const underPressure = (permittivity, pressure, [shares, weights]) =>
    shares.reduce((s, share, i) => {
      const p = pressure * share;
      return s + weights[i] * denser(permittivity, 1 + (C.DENSER * p) / (1 + C.STIFFER * p));
    }, 0);
  const evenness = ([f, byRatio, byOffset], films) =>
    f + byRatio * (films.central / films.minimum - 1) + byOffset * (films.offset / films.central - 1);

  const lineCapacitance = (contact, films, permittivity) => {
    const { half, central, offset } = films;
    const zone = (evenness(gaps.LINE, films) * 2 * half) / central;
    const beside = 2 * opening(contact.radius, half, offset)[0];
    const [full, left] = outlet(contact.radius, half, central, permittivity);
    const pressed = underPressure(permittivity, films.pressure, gaps.shares.line);
    return C.VACUUM * (pressed * zone + permittivity * (beside - full + left));
  };
  const pointCapacitance = (contact, films, permittivity, outer) => {
    const { a, b, central, offset } = films;
    const eta = clip(offset / films.approach, gaps.THIN, gaps.THICK);
    const shape = Math.log(clip(contact.ellipticity, 1, gaps.LONGEST));
    const [x, y] = [spline(gaps.points.x, shape), spline(gaps.points.y, Math.log(eta))];
    const row = gaps.points.y.length - 4;
    let w = 0;
    x.weights.forEach((one, i) => y.weights.forEach((other, j) => {
      w += one * other * gaps.points.c[(x.first + i) * row + y.first + j];
    }));
    const beside = Math.max(contact.scale * (Math.log1p(outer / offset) + w), 0);
    const zone = (evenness(gaps.POINT, films) * Math.PI * a * b) / central;
    let [full, left] = [0, 0];
    gaps.strips[0].forEach((place, i) => {
      const parts = outlet(contact.radius, a * Math.sqrt(1 - place ** 2), central, permittivity);
      full += b * gaps.strips[1][i] * parts[0];
      left += b * gaps.strips[1][i] * parts[1];
    });
    const pressed = underPressure(permittivity, films.pressure, gaps.shares.point);
    return C.VACUUM * (pressed * zone + permittivity * (beside - full + left));
  };

  // One contact of a rolling element under a load [N], by entrainment speed [m/s] and temperature [K].
  const contactAt = (bearing, place, oil, F, u, T, permittivity, outer) => {
    const [of, lubricant] = [bearings[bearing], oils[oil]];
    const state = stateOf(lubricant, T);
    if (!state || !(F > 0 && u > 0)) return NONE;
    state.fitted = lubricant.fitted;
    if (of.kind === "line") {
      const contact = { ...of.contacts[place], factors: (fitted) => C.MAPPED[fitted ? 0 : 1] };
      const films = lineFilms(contact, state, F / of.length, u);
      if (Number.isNaN(films.offset)) return NONE;
      const [stiffness, damping] = [films.stiffness * of.length, films.damping * of.length];
      return { ...films, stiffness, damping, capacitance: lineCapacitance(contact, films, permittivity) * of.length };
    }
    const films = pointFilms(of.contacts[place], state, F, u);
    if (Number.isNaN(films.offset)) return NONE;
    return { ...films, capacitance: pointCapacitance(of.contacts[place], films, permittivity, outer) };
  };
  window.ehdmaps = { contactAt, bearings, oils };

  // The page: charts whose axes stand, and whose curves are drawn anew.
  const field = (name) => document.getElementById(`catalogue-${name}`);
  const asked = () => {
    const value = (name) => Number(field(name).value);
    const bearing = field("bearing").value.trim();
    const speed = ((bearings[bearing]?.speed ?? NaN) * value("speed") * Math.PI) / 30;
    return { bearing, oil: field("oil").value, load: value("load"), speed, temperature: value("temperature") + 273.15,
      permittivity: value("permittivity"), outer: value("gap") * 1e-3 };
  };
  const at = (now, place, load) =>
    contactAt(now.bearing, place, now.oil, load, now.speed, now.temperature, now.permittivity, now.outer);
  const draw = (now) => {
    const found = [0, 1].map((place) => data.loads.map((load) => at(now, place, load)));
    for (const [name, chart] of Object.entries(data.charts)) {
      const figure = document.getElementById(name);
      const block = figure.querySelector("script");
      const shown = JSON.parse(block.textContent);
      const [, top, , bottom] = shown.frame;
      const rows = chart.curves.map(([place, key]) => found[place].map((one) => one[key] * chart.factor));
      const height = (value) => bottom - (Math.log(value / chart.low) / Math.log(chart.high / chart.low)) * (bottom - top);
      figure.querySelectorAll("svg g path.curve").forEach((path, curve) => {
        let pen = "M";
        let d = "";
        rows[curve].forEach((value, i) => {
          if (!(value > 0)) { pen = "M"; return; }
          d += `${pen}${shown.x.pixels[i].toFixed(1)} ${height(value).toFixed(1)}`;
          pen = "L";
        });
        path.setAttribute("d", d || "M0 0");
      });
      shown.curves = rows.map((row) => row.map((value) => (Number.isFinite(value) ? value : null)));
      block.textContent = JSON.stringify(shown);
    }
  };
  const text = (value) => (Number.isFinite(value) ? String(Number(value.toPrecision(5))) : "none");
  const update = () => {
    const now = asked();
    const problem = bearings[now.bearing] ? "" : `no bearing ${now.bearing} in this page; choose one of the list`;
    field("problem").textContent = problem;
    if (problem) return;
    draw(now);
    field("table").querySelectorAll("tbody tr").forEach((row) => {
      const { key, factor } = row.dataset;
      [0, 1].forEach((place) => { row.cells[place + 1].textContent = text(at(now, place, now.load)[key] * factor); });
    });
  };
  for (const name of ["bearing", "oil", "load", "speed", "temperature", "permittivity", "gap"])
    field(name).addEventListener("input", update);
  update();
}
