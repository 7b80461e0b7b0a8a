"use strict";
// Mode shapes that move, in WebGL 2: turned by the mouse, enlarged, surfaces coloured by amplitude.
(() => {
const get = name => document.getElementById("shapes-" + name);
const data = JSON.parse(get("data").textContent);

const canvas = get("view");
const gl = canvas.getContext("webgl2", {antialias: true, preserveDrawingBuffer: true});
const bytes = text => Uint8Array.from(atob(text), letter => letter.charCodeAt(0)).buffer;
const points = new Float32Array(bytes(data.points)), triangles = new Uint32Array(bytes(data.triangles));
const count = points.length / 3, low = [0, 1, 2].map(() => Infinity), high = low.map(() => -Infinity);
points.forEach((value, place) => {
  low[place % 3] = Math.min(low[place % 3], value); high[place % 3] = Math.max(high[place % 3], value);
});
const middle = low.map((value, axis) => 0.5 * (value + high[axis]));
const reach = 0.5 * Math.hypot(...low.map((value, axis) => high[axis] - value)) || 1;
const view = {azimuth: -62, elevation: 22, zoom: 1, x: 0, y: 0};
const parts = text => Float32Array.from(new Int16Array(bytes(text)), value => value / 32767);
const modes = data.modes.map(mode => ({name: mode.name, real: parts(mode.real), imaginary: parts(mode.imaginary)}));
modes.forEach((mode, place) => get("mode").add(new Option(mode.name, place)));
data.names.forEach(([name, colour]) => {
  const entry = document.createElement("span"), mark = document.createElement("i");
  if (colour === "surface") mark.className = "surface"; else mark.style.background = colour;
  entry.append(mark, name); get("names").append(entry);
});
if (!gl) get("names").append("This browser has no WebGL 2, which draws the shapes.");

function program(vertex, fragment) {
  const made = gl.createProgram();
  [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]].forEach(([kind, text]) => {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, "#version 300 es\nprecision highp float;\n" + text); gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(made, shader);
  });
  ["place", "real", "imaginary", "colour"].forEach((name, index) => gl.bindAttribLocation(made, index, name));
  gl.linkProgram(made);
  return made;
}
const surface = gl && program(`
  in vec3 place, real, imaginary; uniform mat4 turn; uniform float scale, phase; out vec3 at; out float share;
  void main() {
    at = place + scale * (real * cos(phase) - imaginary * sin(phase));
    share = length(vec2(length(real), length(imaginary))); gl_Position = turn * vec4(at, 1.0);
  }`, `
  in vec3 at; in float share; uniform float opacity, most; out vec4 shown;
  vec3 map(float x) {
    vec3 c[5] = vec3[5](vec3(.267, .005, .329), vec3(.231, .322, .545), vec3(.129, .569, .549), vec3(.369, .788, .384),
      vec3(.992, .906, .145));
    float place = clamp(x, 0.0, 1.0) * 4.0; int i = int(min(place, 3.0)); return mix(c[i], c[i + 1], place - float(i));
  }
  void main() {
    vec3 normal = normalize(cross(dFdx(at), dFdy(at)));
    shown = vec4(map(share / most) * (0.5 + 0.5 * abs(dot(normal, vec3(0.45, -0.75, 0.48)))), opacity);
  }`);
const strip = gl && program(
  `in vec3 place, colour; out vec3 tint; void main() { tint = colour; gl_Position = vec4(place, 1.0); }`,
  `in vec3 tint; out vec4 shown; void main() { shown = vec4(tint, 1.0); }`);
const buffers = gl && [0, 1, 2, 3, 4].map(() => gl.createBuffer());
if (gl) {
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffers[4]);
  gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, triangles, gl.STATIC_DRAW);
}

function attribute(index, values, kind) {
  gl.bindBuffer(gl.ARRAY_BUFFER, buffers[index]);
  gl.bufferData(gl.ARRAY_BUFFER, values, kind);
  gl.enableVertexAttribArray(index);
  gl.vertexAttribPointer(index, 3, gl.FLOAT, false, 0, 0);
}
function axes() {
  // Rows: right, up, away from the viewer.
  const a = view.azimuth * Math.PI / 180, e = view.elevation * Math.PI / 180;
  return [[-Math.sin(a), Math.cos(a), 0], [-Math.sin(e) * Math.cos(a), -Math.sin(e) * Math.sin(a), Math.cos(e)],
    [-Math.cos(e) * Math.cos(a), -Math.cos(e) * Math.sin(a), -Math.sin(e)]];
}
// How far the machine reaches to the right and up, as it is seen first: there it fits, with room to move.
const [wide, tall] = axes().map(row => row.reduce((sum, value, axis) =>
  sum + 0.5 * Math.abs(value) * (high[axis] - low[axis]), 0) + 0.1 * reach);
function turned() {
  // Places about the middle, the same scale along both sides of the canvas.
  const rows = axes(), unit = view.zoom * Math.min(canvas.width / wide, canvas.height / tall);
  const factors = [unit / canvas.width, unit / canvas.height, 0.3 / (reach * Math.max(1, view.zoom))];
  const moved = [view.x, view.y, 0];
  return rows.map((row, k) => [...row.map(value => factors[k] * value),
    moved[k] - factors[k] * row.reduce((sum, value, axis) => sum + value * middle[axis], 0)]);
}
let phase = 0, before = 0, running = true;
function draw(now) {
  const mode = modes[get("mode").value];
  if (running) phase += 0.25 * Number(get("speed").value) * Math.min(now - before, 100) / 1000;
  before = now;
  if (mode && gl) {
    canvas.width = canvas.clientWidth * devicePixelRatio; canvas.height = canvas.clientHeight * devicePixelRatio;
    const rows = turned(), scale = 0.01 * Number(get("size").value) * data.size;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(1, 1, 1, 1); gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT); gl.enable(gl.DEPTH_TEST);
    lines(mode, rows, scale);
    if (triangles.length) skin(mode, rows, scale);
  }
  requestAnimationFrame(draw);
}
function seen(mode, rows, scale, place) {
  const at = [0, 1, 2].map(axis => points[3 * place + axis] + scale * (mode.real[3 * place + axis] * Math.cos(phase)
    - mode.imaginary[3 * place + axis] * Math.sin(phase)));
  return rows.map(row => row[0] * at[0] + row[1] * at[1] + row[2] * at[2] + row[3]);
}
function lines(mode, rows, scale) {
  const places = [], colours = [];
  data.lines.forEach(([begin, end], line) => {
    const a = seen(mode, rows, scale, begin), b = seen(mode, rows, scale, end);
    const along = [(b[0] - a[0]) * canvas.width, (b[1] - a[1]) * canvas.height], length = Math.hypot(...along) || 1;
    const half = data.widths[line] * devicePixelRatio / length;
    const x = -along[1] * half / canvas.width, y = along[0] * half / canvas.height;
    const corners = [[a, 1], [a, -1], [b, 1], [b, 1], [a, -1], [b, -1]];
    const colour = [1, 3, 5].map(at => parseInt(data.colours[line].slice(at, at + 2), 16) / 255);
    corners.forEach(([p, side]) => { places.push(p[0] + side * x, p[1] + side * y, p[2]); colours.push(...colour); });
  });
  gl.useProgram(strip);
  attribute(0, new Float32Array(places), gl.STREAM_DRAW); attribute(3, new Float32Array(colours), gl.STREAM_DRAW);
  gl.disableVertexAttribArray(1); gl.disableVertexAttribArray(2); gl.depthFunc(gl.LESS);
  gl.drawArrays(gl.TRIANGLES, 0, places.length / 3);
}
function skin(mode, rows, scale) {
  gl.useProgram(surface);
  [points, mode.real, mode.imaginary].forEach((values, index) => attribute(index, values, gl.STREAM_DRAW));
  gl.disableVertexAttribArray(3);
  const uniform = name => gl.getUniformLocation(surface, name);
  const columns = [0, 1, 2, 3].map(column => [...rows.map(row => row[column]), column === 3 ? 1 : 0]);
  gl.uniformMatrix4fv(uniform("turn"), false, columns.flat());
  gl.uniform1f(uniform("scale"), scale); gl.uniform1f(uniform("phase"), phase);
  mode.most = mode.most || triangles.reduce((most, place) => Math.max(most, Math.hypot(mode.real[3 * place],
    mode.real[3 * place + 1], mode.real[3 * place + 2], mode.imaginary[3 * place], mode.imaginary[3 * place + 1],
    mode.imaginary[3 * place + 2])), 1e-9);
  gl.uniform1f(uniform("most"), mode.most); gl.uniform1f(uniform("opacity"), 0.01 * Number(get("opacity").value));
  // Depth first, then colour: of a surface that is seen through, its front alone.
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffers[4]); gl.depthFunc(gl.LESS); gl.colorMask(false, false, false, false);
  gl.drawElements(gl.TRIANGLES, triangles.length, gl.UNSIGNED_INT, 0);
  gl.colorMask(true, true, true, true); gl.depthFunc(gl.EQUAL); gl.enable(gl.BLEND);
  gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  gl.drawElements(gl.TRIANGLES, triangles.length, gl.UNSIGNED_INT, 0);
  gl.disable(gl.BLEND); gl.depthFunc(gl.LESS);
}
canvas.onpointerdown = event => canvas.setPointerCapture(event.pointerId);
canvas.onpointermove = event => {
  if (!event.buttons) return;
  if (event.shiftKey) {
    view.x += 2 * event.movementX / canvas.clientWidth; view.y -= 2 * event.movementY / canvas.clientHeight;
  } else {
    view.azimuth -= 0.4 * event.movementX;
    view.elevation = Math.max(-90, Math.min(90, view.elevation + 0.4 * event.movementY));
  }
};
canvas.addEventListener("wheel", event => {
  event.preventDefault(); view.zoom = Math.max(0.2, Math.min(20, view.zoom * Math.exp(-0.001 * event.deltaY)));
}, {passive: false});
get("pause").onclick = () => { running = !running; get("pause").textContent = running ? "pause" : "go on"; };
requestAnimationFrame(draw);
})();
