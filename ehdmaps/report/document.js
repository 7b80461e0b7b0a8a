"use strict";
// Reads values off the charts: a line at the cursor, and the values of all curves there in the legend.
document.documentElement.classList.add("js");
for (const figure of document.querySelectorAll("figure.chart")) {
  const block = figure.querySelector("script");
  if (!block) continue;
  let data = JSON.parse(block.textContent);
  const svg = figure.querySelector("svg");
  const line = svg.querySelector(".line");
  const at = figure.querySelector(".cursor output");
  const values = figure.querySelectorAll(".legend output");
  const { values: places, pixels } = data.x;
  // a page that draws its curves anew writes the block anew
  new MutationObserver(() => {
    data = JSON.parse(block.textContent);
  }).observe(block, { childList: true });
  let index = 0;
  const text = (value) => (value === null ? "none" : String(Number(value.toPrecision(4))));
  const show = (next) => {
    index = Math.min(Math.max(next, 0), places.length - 1);
    line.setAttribute("d", `M${pixels[index]} ${data.frame[1]}V${data.frame[3]}`);
    line.classList.add("on");
    at.textContent = text(places[index]);
    values.forEach((output, curve) => {
      const value = data.curves[curve][index];
      output.textContent = value === null || !data.unit ? text(value) : `${text(value)} ${data.unit}`;
    });
  };
  svg.addEventListener("pointermove", (event) => {
    const box = svg.getBoundingClientRect();
    const x = ((event.clientX - box.left) / box.width) * svg.viewBox.baseVal.width;
    let nearest = 0;
    pixels.forEach((pixel, place) => {
      if (Math.abs(pixel - x) < Math.abs(pixels[nearest] - x)) nearest = place;
    });
    show(nearest);
  });
  svg.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!step) return;
    event.preventDefault();
    show(index + step);
  });
}
