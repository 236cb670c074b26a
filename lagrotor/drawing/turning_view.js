const [canvas] = document.getElementsByTagName("canvas");
const [button] = document.getElementsByTagName("button");
const [slider] = document.getElementsByTagName("input");
const [clock] = document.getElementsByTagName("output");
const pen = canvas.getContext("2d");
const times = scene.t, last = times.length - 1, span = times[last] - times[0];
const pace = span > 0 ? Math.max(span / 20, Math.min(1, span / 4)) : 0; // seconds of the motion in one of the clock
let azimuth = -1.0, height = 0.35, zoom = 1, playing = span > 0, now = times[0], before = null;
slider.min = times[0];
slider.max = times[last];

function project(x, y, z) {
  const [mx, my, mz] = scene.middle, [c, s, u, w] = [Math.cos(azimuth), Math.sin(azimuth), Math.cos(height), Math.sin(height)];
  const [dx, dy, dz] = [x - mx, y - my, z - mz], depth = c * dx + s * dy;
  const scale = (0.46 * zoom * Math.min(canvas.width, canvas.height)) / scene.size;
  return [canvas.width / 2 + scale * (c * dy - s * dx), canvas.height / 2 - scale * (u * dz - w * depth)];
}

function stroke(points, ink, width) {
  pen.beginPath();
  points.forEach(([x, y, z], i) => (i ? pen.lineTo : pen.moveTo).apply(pen, project(x, y, z)));
  pen.strokeStyle = ink;
  pen.lineWidth = width * (canvas.width / canvas.clientWidth);
  pen.lineJoin = pen.lineCap = "round";
  pen.stroke();
}

const triples = (flat, from, count) => Array.from({ length: count }, (_, i) => flat.slice(from + 3 * i, from + 3 * i + 3));

function carried(body, k, [x, y, z]) {
  const o = body.origin.slice(3 * k, 3 * k + 3), R = body.rotation.slice(9 * k, 9 * k + 9);
  return o.map((e, i) => e + R[3 * i] * x + R[3 * i + 1] * y + R[3 * i + 2] * z);
}

const axes = ["#d55e00", "#009e73", "#0072b2"];

function triad(place, length, width) {
  [0, 1, 2].forEach((i) => stroke([place([0, 0, 0]), place([0, 1, 2].map((j) => length * (i === j)))], axes[i], width));
}

function draw() {
  const k = Math.max(0, times.findLastIndex((t) => t <= now));
  canvas.width = canvas.clientWidth * devicePixelRatio;
  canvas.height = canvas.clientHeight * devicePixelRatio;
  pen.clearRect(0, 0, canvas.width, canvas.height);
  triad((p) => p, scene.size / 4, 1);
  for (const body of scene.bodies) {
    const tip = triples(body.lines[0], body.lines[0].length - 3, 1)[0];
    stroke(times.slice(0, k + 1).map((_, i) => carried(body, i, tip)), scene.inks.trace, 1);
    for (const line of body.lines) stroke(triples(line, 0, line.length / 3).map((p) => carried(body, k, p)), body.ink, 2.6);
    triad((p) => carried(body, k, p), scene.size / 8, 1.4);
  }
  for (const line of scene.lines) {
    const end = (i) => line.points.slice(3 * (line.count * (i + 1) - 1), 3 * line.count * (i + 1));
    stroke(times.slice(0, k + 1).map((_, i) => end(i)), scene.inks.trace, 1);
    stroke(triples(line.points, 3 * line.count * k, line.count), line.ink, 2.6);
  }
  slider.value = now;
  clock.value = `t = ${now.toFixed(2)} s`;
}

function tick(at) {
  if (playing && before !== null) now = times[0] + ((now - times[0] + (pace * (at - before)) / 1000) % span);
  before = at;
  draw();
  requestAnimationFrame(tick);
}

button.onclick = () => { playing = !playing; button.textContent = playing ? "pause" : "play"; };
slider.oninput = () => { now = Number(slider.value); playing = false; button.textContent = "play"; };
canvas.onpointermove = (e) => {
  if (!e.buttons) return;
  azimuth -= e.movementX / 150;
  height = Math.max(-1.57, Math.min(1.57, height + e.movementY / 150));
};
canvas.onpointerdown = (e) => canvas.setPointerCapture(e.pointerId);
canvas.onwheel = (e) => { e.preventDefault(); zoom *= Math.exp(-e.deltaY / 600); };
canvas.ondblclick = () => { azimuth = -1.0; height = 0.35; zoom = 1; };
requestAnimationFrame(tick);
