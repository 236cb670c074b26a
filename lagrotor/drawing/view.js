// Turns and plays the lines of a motion in the elements of `root`; `changed` is called with the time and whether it plays, as they change.
function showMotion(root, motion, changed = () => {}) {
  const [canvas, slider, clock, button, speed] = ["canvas", "input", "output", "button", "select"].map((name) => root.querySelector(name));
  const { t, unit, middle } = motion, eye = { azimuth: -1.25, elevation: 0.3 };
  const begin = t[0], end = t[t.length - 1];
  let now = begin, playing = false, last = null;

  function numbers(data) {
    const bytes = Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0)), view = new DataView(bytes.buffer);
    return Array.from({ length: bytes.length / 2 }, (_, n) => view.getInt16(2 * n, true) * unit + middle[n % 3]);
  }

  const lines = motion.lines.map((each) => ({ ...each, values: numbers(each.data) }));
  slider.min = begin;
  slider.max = end;

  // The points of a line in a frame; what stands still has one.
  function pointsAt({ values, points }, frame) {
    const from = values.length === 3 * points ? 0 : 3 * points * frame;
    return Array.from({ length: points }, (_, n) => values.slice(from + 3 * n, from + 3 * n + 3));
  }

  function extent() {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (const { values } of lines) {
      values.forEach((value, n) => {
        low[n % 3] = Math.min(low[n % 3], value);
        high[n % 3] = Math.max(high[n % 3], value);
      });
    }
    return Math.hypot(...high.map((value, i) => value - low[i])) || 1;
  }

  const size = extent();

  function redraw() {
    const { pen, width, height } = sheet(canvas), [right, up] = camera(eye.azimuth, eye.elevation);
    const scale = 0.95 * Math.min(width, 1.5 * height) / size;
    const on = (p) => {
      const q = p.map((value, i) => value - middle[i]);
      return [width / 2 + scale * dot(q, right), height / 2 - scale * dot(q, up)];
    };
    const after = t.findIndex((time) => time > now + 1e-12), frame = after < 0 ? t.length - 1 : after - 1;
    for (const each of lines.filter(({ traced }) => traced)) {
      const path = [];
      for (let n = 0; n <= frame; n++) path.push(on(each.values.slice(3 * (each.points * (n + 1) - 1), 3 * each.points * (n + 1))));
      line(pen, path, each.ink, { width: 1, alpha: 0.55 });
    }
    for (const each of lines) {
      const fixedLine = each.values.length === 3 * each.points;
      line(pen, pointsAt(each, frame).map(on), each.ink, { width: fixedLine ? 1 : 2.2 });
    }
    slider.value = now;
    clock.textContent = `t = ${fixed(now, 2)} s`;
    changed({ time: now, playing });
  }

  function tick(time) {
    if (!playing) return;
    if (last !== null) now += (time - last) / 1000 * Number(speed.value);
    last = time;
    if (now > end) now = begin;
    redraw();
    requestAnimationFrame(tick);
  }

  function play(on) {
    if (on === playing) return;
    playing = on;
    last = null;
    button.textContent = on ? "Pause" : "Play";
    if (on) requestAnimationFrame(tick);
    redraw();
  }

  function turn(across, upward) {
    eye.azimuth -= across;
    eye.elevation = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, eye.elevation + upward));
    redraw();
  }

  button.onclick = () => play(!playing);
  slider.oninput = () => { now = Number(slider.value); redraw(); };
  let grip = [0, 0];
  canvas.onpointerdown = (event) => { canvas.setPointerCapture(event.pointerId); grip = [event.clientX, event.clientY]; };
  canvas.onpointermove = (event) => {
    if (!canvas.hasPointerCapture(event.pointerId)) return;
    turn((event.clientX - grip[0]) / 120, (event.clientY - grip[1]) / 120);
    grip = [event.clientX, event.clientY];
  };
  const KEYS = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] };
  canvas.onkeydown = (event) => {
    if (!KEYS[event.key]) return;
    event.preventDefault();
    turn(...KEYS[event.key]);
  };
  new ResizeObserver(redraw).observe(canvas);
  redraw();
  return {
    play,
    seek(time) {
      now = Math.min(Math.max(time, begin), end);
      redraw();
    },
  };
}
