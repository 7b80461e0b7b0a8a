package {name} "{title}"
  // {lines}
  package Table
    constant Integer cells = {cells};
    constant Real offset(unit = "m") = {offset};
    constant Real inverseScale(unit = "1/m") = {inverse_scale};
    constant Real start = {start};
    constant Real step = {step};
    constant Real highestApproach(unit = "m") = {highest} "from here on the load is above the map";
    constant Real cubic[{cells}, 8] = {{
      {rows}}} "cubics over the part of a cell: four numbers of w^(1/3), four of ln(c/w)";
  end Table;

  function atRest "Load at rest and ln(c/w) of a contact, with two derivatives by the approach"
    input Real approach(unit = "m", nominal = {nominal}) "positive together";
    output Real rest(unit = "N/m", nominal = {load});
    output Real drest(unit = "N/m2");
    output Real ddrest(unit = "N/m3");
    output Real ratio(unit = "s/m") "c/w";
    output Real slope(unit = "1/m") "of ln(c/w)";
    output Real bend(unit = "1/m2") "of ln(c/w)";
  protected
    Real z;
    Real root;
    Real s;
    Real x;
    Integer cell;
    Real t;
    Real scale;
    Real dscale;
    Real g;
    Real dg;
    Real ddg;
    Real logRatio;
  algorithm
    assert(approach <= Table.highestApproach, "approach is above the map");
    z := (approach - Table.offset) * Table.inverseScale;
    root := sqrt(1.0 + z * z);
    s := if z >= 0.0 then log(z + root) else -log(root - z);
    x := max(0.0, min((s - Table.start) * Table.step, Table.cells));
    cell := integer(min(floor(x), Table.cells - 1)) + 1;
    t := x - (cell - 1);
    scale := Table.step * Table.inverseScale / root;
    dscale := -scale * Table.inverseScale * z / (root * root);
    g := max(0.0, Table.cubic[cell, 1] + t * (Table.cubic[cell, 2] + t * (Table.cubic[cell, 3]
      + t * Table.cubic[cell, 4])));
    dg := Table.cubic[cell, 2] + t * (2.0 * Table.cubic[cell, 3] + 3.0 * t * Table.cubic[cell, 4]);
    ddg := 2.0 * Table.cubic[cell, 3] + 6.0 * t * Table.cubic[cell, 4];
    ddg := ddg * scale * scale + dg * dscale;
    dg := dg * scale;
    logRatio := Table.cubic[cell, 5] + t * (Table.cubic[cell, 6] + t * (Table.cubic[cell, 7]
      + t * Table.cubic[cell, 8]));
    slope := Table.cubic[cell, 6] + t * (2.0 * Table.cubic[cell, 7] + 3.0 * t * Table.cubic[cell, 8]);
    bend := 2.0 * Table.cubic[cell, 7] + 6.0 * t * Table.cubic[cell, 8];
    bend := bend * scale * scale + slope * dscale;
    slope := slope * scale;
    rest := g ^ 3;
    drest := 3.0 * g * g * dg;
    ddrest := 3.0 * g * (2.0 * dg * dg + g * ddg);
    ratio := exp(max(-700.0, min(logRatio, 700.0)));
  end atRest;

  function force "Load of a contact, its stiffness and damping, per unit length"
    input Real approach(unit = "m", nominal = {nominal}) "positive together";
    input Real rate(unit = "m/s", nominal = 1e-3) "of the approach";
    output Real w(unit = "N/m", nominal = {load}) "presses the bodies together";
    output Real k(unit = "N/m2", nominal = {stiffness}) "dw/dapproach";
    output Real c(unit = "N.s/m2", nominal = {damping}) "dw/drate";
  protected
    Real rest;
    Real drest;
    Real ddrest;
    Real ratio;
    Real slope;
    Real bend;
    Real drag;
    Real ddrag;
    Real part;
    Real share;
  algorithm
    (rest, drest, ddrest, ratio, slope, bend) := atRest(approach);
    drag := rest * ratio;
    ddrag := ratio * (drest + rest * slope);
    part := drag * rate;
    if rest <= 0.0 then
      w := 0.0;
      k := 0.0;
      c := 0.0;
    elseif part >= -0.5 * rest then
      w := rest + part;
      k := drest + ddrag * rate;
      c := drag;
    else
      share := rest / part;
      w := -0.25 * rest * share;
      k := 0.25 * share * (share * ddrag * rate - 2.0 * drest);
      c := 0.25 * share * share * drag;
    end if;
    annotation(derivative = forceDerivative, smoothOrder = 1);
  end force;

  function forceDerivative "Rates of load, stiffness and damping in time: the derivative of force"
    input Real approach(unit = "m", nominal = {nominal}) "positive together";
    input Real rate(unit = "m/s", nominal = 1e-3) "of the approach";
    input Real der_approach(unit = "m/s") "of the approach, as force has it";
    input Real der_rate(unit = "m/s2") "of the rate, as force has it";
    output Real der_w(unit = "N/(m.s)");
    output Real der_k(unit = "N/(m2.s)");
    output Real der_c(unit = "N/m2");
  protected
    Real rest;
    Real drest;
    Real ddrest;
    Real ratio;
    Real slope;
    Real bend;
    Real q;
    Real dq;
    Real ddq;
    Real mixed;
  algorithm
    (rest, drest, ddrest, ratio, slope, bend) := atRest(approach);
    if rest <= 0.0 then
      der_w := 0.0;
      der_k := 0.0;
      der_c := 0.0;
    elseif ratio * rate >= -0.5 then
      // w = rest + q * rate
      q := rest * ratio;
      dq := ratio * (drest + rest * slope);
      ddq := ratio * (ddrest + 2.0 * drest * slope + rest * (bend + slope * slope));
      der_w := (drest + dq * rate) * der_approach + q * der_rate;
      der_k := (ddrest + ddq * rate) * der_approach + dq * der_rate;
      der_c := dq * der_approach;
    else
      // w = -q / (4 * rate)
      q := rest / ratio;
      dq := (drest - rest * slope) / ratio;
      ddq := (ddrest - 2.0 * drest * slope + rest * (slope * slope - bend)) / ratio;
      mixed := 0.25 * dq / (rate * rate);
      der_w := -0.25 * dq / rate * der_approach + 0.25 * q / (rate * rate) * der_rate;
      der_k := -0.25 * ddq / rate * der_approach + mixed * der_rate;
      der_c := mixed * der_approach - 0.5 * q / (rate * rate * rate) * der_rate;
    end if;
  end forceDerivative;

  model Example "A mass on the contact, under a constant load"
    parameter Real mass(unit = "kg/m") = {mass} "per unit length of contact";
    parameter Real load(unit = "N/m") = {load};
    Real approach(unit = "m", start = {begin}, fixed = true, nominal = {nominal});
    Real rate(unit = "m/s", start = 0.0, fixed = true, nominal = 1e-3);
    Real w(unit = "N/m", nominal = {load});
    Real k(unit = "N/m2", nominal = {stiffness});
    Real c(unit = "N.s/m2", nominal = {damping});
  equation
    (w, k, c) = force(approach, rate);
    der(approach) = rate;
    mass * der(rate) = load - w;
  end Example;
end {name};
