  package Film "cells are binary digits of 1 + the distance from the centre in scales, or of 1 + w/(1 N/m)"
    constant Integer above = {above} "cells above the centre; those below follow";
    constant Integer below = {below};
    constant Integer loads = {loads};
    constant Real centre(unit = "m") = {centre};
    constant Real inverseScale(unit = "1/m") = {inverse_scale};
    constant Real liftOff(unit = "m") = {lift_off} "nothing is carried up to here";
    constant Real leastDamping(unit = "N.s/m2") = {least_damping};
    constant Real opening = {opening} "a film that opens follows more slowly below twice this part of its load at rest";
    constant Real filmCubic[{rows}, 11] = {{
      {film}}} "cubics of p [N/m] and y [m], then those of G [N.s/m2] but for its value";
    constant Real stretchCubic[{loads}, 4] = {{
      {load}}} "cubics of a [m]";
  end Film;

  function cellOf "Cell of a number from 1 on, and what it is above the begin of the cell"
    input Real a;
    input Integer cells;
    output Integer cell;
    output Real rest;
  protected
    Real size;
    Integer octave;
    Integer digit;
  algorithm
    octave := integer(floor(log(a) / log(2.0)));
    size := 2.0 ^ octave;
    digit := integer(max(0.0, min(floor((a / size - 1.0) * {digits}.0), {last}.0)));
    cell := octave * {digits} + digit + 1;
    if cell > cells then
      cell := cells;
      octave := integer(floor((cells - 1) / {digits}));
      size := 2.0 ^ octave;
      digit := cells - 1 - octave * {digits};
    end if;
    rest := a - size * (1.0 + digit / {digits}.0);
  end cellOf;

  function loadAt "Load at which what answers at once is stretched so much"
    input Real stretch(unit = "m");
    output Real w(unit = "N/m");
  protected
    Integer low;
    Integer high;
    Integer middle;
    Integer octave;
    Real size;
    Real left;
    Real right;
    Real t;
    Real value;
    Real slope;
  algorithm
    low := 1;
    high := Film.loads + 1;
    for n in 1:12 loop
      middle := integer(floor((low + high) / 2));
      if high - low > 1 then
        if Film.stretchCubic[middle, 1] <= stretch then
          low := middle;
        else
          high := middle;
        end if;
      end if;
    end for;
    octave := integer(floor((low - 1) / {digits}));
    size := 2.0 ^ octave;
    left := 0.0;
    right := size / {digits}.0;
    t := 0.5 * right;
    for n in 1:30 loop
      value := Film.stretchCubic[low, 1] + t * (Film.stretchCubic[low, 2] + t * (Film.stretchCubic[low, 3]
        + t * Film.stretchCubic[low, 4])) - stretch;
      slope := Film.stretchCubic[low, 2] + t * (2.0 * Film.stretchCubic[low, 3] + 3.0 * t * Film.stretchCubic[low, 4]);
      if value > 0.0 then
        right := t;
      else
        left := t;
      end if;
      t := if slope > 0.0 then t - value / slope else 0.5 * (left + right);
      if t < left then
        t := 0.5 * (left + right);
      elseif t > right then
        t := 0.5 * (left + right);
      end if;
    end for;
    w := if stretch > 0.0 then size * (1.0 + (low - 1 - octave * {digits}) / {digits}.0) - 1.0 + t else 0.0;
  end loadAt;

  function film "Load of a contact whose film has a memory, per unit length, and the rate of its state"
    input Real approach(unit = "m", nominal = {nominal}) "positive together";
    input Real state(unit = "m", nominal = {nominal}) "approach at which the film would be at rest";
    output Real w(unit = "N/m", nominal = {nominal_load}) "presses the bodies together";
    output Real rate(unit = "m/s", nominal = 1e-3) "of the state";
  protected
    Real z;
    Integer cells;
    Integer cell;
    Real rest;
    Real t;
    Real p;
    Real y;
    Real c;
    Real edge;
    Real part;
    Real m;
  algorithm
    assert(approach <= Table.highestApproach + 1e-6, "approach is above the map");
    z := (max(state, Film.liftOff) - Film.centre) * Film.inverseScale;
    cells := if z >= 0.0 then Film.above else Film.below;
    (cell, rest) := cellOf(1.0 + abs(z), cells);
    t := if z >= 0.0 then rest else -rest;
    cell := if z >= 0.0 then cell else cell + Film.above;
    p := max(0.0, Film.filmCubic[cell, 1] + t * (Film.filmCubic[cell, 2] + t * (Film.filmCubic[cell, 3]
      + t * Film.filmCubic[cell, 4])));
    y := Film.filmCubic[cell, 5] + t * (Film.filmCubic[cell, 6] + t * (Film.filmCubic[cell, 7]
      + t * Film.filmCubic[cell, 8]));
    c := Film.leastDamping + Film.inverseScale * max(0.0, Film.filmCubic[cell, 9]
      + t * (2.0 * Film.filmCubic[cell, 10] + 3.0 * t * Film.filmCubic[cell, 11]));
    w := loadAt(approach - y);
    edge := Film.opening * p;
    part := if w < 2.0 * edge then 0.5 * w / edge else 1.0;
    m := if part < 1.0 then edge * (1.0 + part * part) else w;
    rate := if m > 0.0 then 0.5 * (w - p) * (w + p) / (m * c) else 0.0;
  end film;

  model ExampleMemory "A mass on a contact with memory, under a constant load"
    parameter Real mass(unit = "kg/m") = {mass} "per unit length of contact";
    parameter Real load(unit = "N/m") = {nominal_load};
    Real approach(unit = "m", start = {begin}, fixed = true, nominal = {nominal});
    Real rate(unit = "m/s", start = 0.0, fixed = true, nominal = 1e-3);
    Real state(unit = "m", start = {begin}, fixed = true, nominal = {nominal});
    Real relaxing(unit = "m/s", nominal = 1e-3);
    Real w(unit = "N/m", nominal = {nominal_load});
  equation
    (w, relaxing) = film(approach, state);
    der(state) = relaxing;
    der(approach) = rate;
    mass * der(rate) = load - w;
  end ExampleMemory;
