// The three motions of a choice: the exact one by stepping, the series, the paper's formula. The functions that they are
// made of are above, generated.

const STEPS = 48; // of the exact run, a turn
const RATES = { short: rate_short, equal: rate_equal, long: rate_long };
const AXES = { short: axes_short, equal: axes_equal, long: axes_long };
const SLOPES = { short: slopes_short, equal: slopes_equal, long: slopes_long };
const STARTS = { short: start_short, equal: start_equal, long: start_long };

// One step of an explicit scheme of order 8: midpoint rules of 2, 4, 6, 8 parts, extrapolated in the square of their
// step (Gragg; Hairer, Norsett & Wanner, Solving ODEs I, II.9).
function step(rate, y, h) {
  const slope = rate(y), rows = [];
  for (let j = 0; j < 4; j++) {
    const parts = 2 * (j + 1), part = h / parts;
    let before = y, now = y.map((v, i) => v + part * slope[i]);
    for (let n = 1; n < parts; n++) {
      const middle = rate(now), after = before.map((v, i) => v + 2 * part * middle[i]);
      before = now;
      now = after;
    }
    const row = [now];
    for (let m = 1; m <= j; m++) {
      const share = 1 / (((j + 1) / (j + 1 - m)) ** 2 - 1);
      row.push(row[m - 1].map((v, i) => v + share * (v - rows[j - 1][m - 1][i])));
    }
    rows.push(row);
  }
  return rows[3][3];
}

function travel(rate, y, time, steps) {
  for (let n = 0; n < steps; n++) y = step(rate, y, time / steps);
  return y;
}

// x with matrix x = right, by elimination with pivots.
function solve(matrix, right) {
  const rows = matrix.map((row, i) => [...row, right[i]]), n = rows.length;
  for (let j = 0; j < n; j++) {
    const pivot = rows.reduce((best, row, i) => (i >= j && Math.abs(row[j]) > Math.abs(rows[best][j]) ? i : best), j);
    [rows[j], rows[pivot]] = [rows[pivot], rows[j]];
    for (let i = 0; i < n; i++) {
      if (i === j) continue;
      const share = rows[i][j] / rows[j][j];
      rows[i] = rows[i].map((v, m) => v - share * rows[j][m]);
    }
  }
  return rows.map((row, i) => row[n] / row[i]);
}

// The periodic orbit by shooting: a quarter of a turn from parallel axes, U = alpha = 0 and chi' = 0.
// Unknown: chi'(0), alpha'(0) over the natural rate, and the quarter times it. null where none is found.
function periodic(rate, state, natural) {
  const from = (u) => [...state.slice(0, 4), u[0] * natural, u[1] * natural];
  const miss = (u) => {
    const end = travel(rate, from(u), u[2] / natural, STEPS / 4);
    return [end[0], end[2], end[4] / natural];
  };
  let u = [state[4] / natural, state[5] / natural, Math.PI / 2];
  for (let n = 0; n < 12; n++) {
    const off = miss(u);
    const size = Math.max(...off.map(Math.abs));
    if (!Number.isFinite(size)) return null;
    if (size < 1e-12) break;
    const columns = u.map((v, j) => {
      const moved = miss(u.map((w, i) => (i === j ? w + 1e-6 : w)));
      return moved.map((w, i) => (w - off[i]) / 1e-6);
    });
    const change = solve(off.map((_, i) => columns.map((column) => column[i])), off);
    u = u.map((v, i) => v - change[i]);
  }
  const close = Math.max(...miss(u).map(Math.abs)) < 1e-10;
  return close ? { state: from(u), rate: Math.PI / 2 / u[2] * natural } : null;
}

// A run that is extended as far as it is needed. `states[n]` at n h; `turns[n]` the angles of the wheels about their axes.
function exactRun(rate, axesOf, start, h, spins) {
  const states = [start], axes = [axesOf(start)], turns = [[0, 0]];
  const run = { h, states, axes, turns, end: Infinity };
  const sound = (y) => y.every(Number.isFinite) && Math.abs(y[0]) < 12;
  const turned = (from, next, before, time) => [0, 1].map((i) => {
    const [x, y, z] = from.slice(3 * i), [p, q, r] = next.slice(3 * i);
    return before[i] + spins[i] * time + (x * q - y * p) / (1 + (z + r) / 2);
  });
  run.reach = (time) => {
    while (run.end === Infinity && (states.length - 1) * h < time) {
      const last = states.length - 1, y = step(rate, states[last], h), seen = axesOf(y);
      if (!sound(y) || !seen.every(Number.isFinite)) { run.end = last * h; break; }
      turns.push(turned(axes[last], seen, turns[last], h));
      states.push(y);
      axes.push(seen);
    }
  };
  run.stateAt = (time) => {
    run.reach(time);
    if (time > run.end) return null;
    const n = Math.min(Math.floor(time / h), states.length - 1), rest = time - n * h;
    return rest > 0 ? step(rate, states[n], rest) : states[n];
  };
  run.at = (time) => {
    run.reach(time);
    if (time > run.end) return null;
    const n = Math.min(Math.floor(time / h), states.length - 1), rest = time - n * h;
    const seen = rest > 0 ? axesOf(step(rate, states[n], rest)) : axes[n];
    return { axes: seen, turns: turned(axes[n], seen, turns[n], rest) };
  };
  return run;
}

// The rates of both axes, six numbers, from those of the coordinates.
function axisRates(slopes, state, k) {
  const by = slopes(...state.slice(0, 3), k);
  return [0, 1, 2, 3, 4, 5].map((i) => [0, 1, 2].reduce((sum, j) => sum + by[3 * i + j] * state[3 + j], 0));
}

// The state after an impulse on tip 1, N s (R = 1 m): M change = slopes of r_1, transposed, times the impulse. M is that of
// a (|r_1'|² + |r_2'|²)/2 + b r_1'·r_2' in the coordinates.
function shocked(slopes, state, a, b, k, impulse) {
  const by = slopes(...state.slice(0, 3), k), at = (i, j) => by[3 * i + j], rows = [0, 1, 2];
  const mass = rows.map((m) => rows.map((n) => rows.reduce((sum, i) => sum
    + a * (at(i, m) * at(i, n) + at(i + 3, m) * at(i + 3, n)) + b * (at(i, m) * at(i + 3, n) + at(i + 3, m) * at(i, n)), 0)));
  const push = rows.map((m) => rows.reduce((sum, i) => sum + at(i, m) * impulse[i], 0));
  const change = solve(mass, push);
  return state.map((v, i) => (i < 3 ? v : v + change[i - 3]));
}

// All that a choice of amplitude, bar, spins, order and rate of the paper's formula fixes.
function motion({ r0, mass, inertia, ell, spins, order, printed }) {
  const [a, b, k, sigma, G1, G2, natural, paperRate] = constants(mass, inertia, ell, ...spins);
  const ratio = k === 1 ? "equal" : k < 1 ? "short" : "long";
  const rate = (y) => RATES[ratio](...y, a, b, k, G1, G2);
  const axesOf = (y) => AXES[ratio](y[0], y[1], y[2], k);
  const paired = spins[0] === -spins[1] && spins[0] !== 0;
  const found = { ell, paired, natural, exactRate: natural, periodic: false };
  const slopes = SLOPES[ratio];
  found.ratesOf = (state) => axisRates(slopes, state, k);
  let start;
  if (paired) {
    const sign = Math.sign(spins[0]);
    const through = (n) => series(...Array.from({ length: ORDER }, (_, i) => (i < n ? r0 ** (i + 1) : 0)), sigma, k);
    const sums = (n) => [through(n).slice(0, -1), sign * natural * through(n).at(-1)];
    const [coefficients, seriesRate] = sums(order), [best, bestRate] = sums(ORDER);
    const along = (phase, of) => orbit(Math.cos(phase), Math.sin(phase), ...of);
    found.seriesRate = seriesRate;
    found.series = (t) => along(seriesRate * t, coefficients);
    // How far a tip moves where the last two orders are added, and whether that is more than the two before them did.
    const moved = (of, less) => Math.max(...Array.from({ length: 24 }, (_, n) => n * Math.PI / 12).flatMap((phase) =>
      [0, 1].map((i) => apart(along(phase, sums(of)[0]), along(phase, sums(less)[0]), i))));
    found.undecided = moved(ORDER, ORDER - 2);
    found.diverges = found.undecided >= moved(ORDER - 2, ORDER - 4);
    // y_1', y_2' where the axes are parallel: s' = 1, c = 1 there.
    const y = best.slice(ORDER + 1, 2 * ORDER + 2), odd = (i) => i % 2;
    const sum = (keep) => y.reduce((total, v, i) => total + (keep(i) ? v : 0), 0);
    const even = sum((i) => !odd(i)), uneven = sum(odd);
    start = STARTS[ratio](r0, bestRate * (even + uneven), bestRate * (uneven - even), k);
    const exact = r0 > 0 ? periodic(rate, start, sign * natural) : null;
    found.periodic = r0 === 0 || exact !== null;
    found.exactRate = exact ? exact.rate : bestRate;
    start = exact ? exact.state : start;
    found.paperRate = printed ? paperRate : found.exactRate;
    found.paper = (t) => paper(r0, found.paperRate * t);
  } else {
    start = STARTS[ratio](r0, ...small_motion(r0, a, b, G1, G2), k);
  }
  const fastest = Math.max(natural, Math.abs(found.exactRate), Math.abs(G1) / a, Math.abs(G2) / a);
  found.turn = natural > 0 ? 2 * Math.PI / Math.abs(found.exactRate) : Infinity;
  const run = (from) => exactRun(rate, axesOf, from, fastest > 0 ? 2 * Math.PI / (STEPS * fastest) : 0.1, spins);
  found.exact = run(start);
  // The motion from a time on, after an impulse on tip 1: only the exact model has it.
  const after = (before) => (time, impulse) => {
    const state = before.exact.stateAt(time);
    if (!state) return null;
    const exact = run(shocked(slopes, state, a, b, k, impulse));
    const next = { ...before, paired: false, periodic: false, impulse, exact };
    return { ...next, after: after(next) };
  };
  found.after = after(found);
  return found;
}

const barLength = (axes, ell) => bar_length(...axes, ell)[0];
const apart = (axes, other, i) => Math.hypot(...[0, 1, 2].map((j) => axes[3 * i + j] - other[3 * i + j]));

// Mean rate between the rises of U through zero in what has been run; NaN before there are two.
function measuredRate(run) {
  const rises = [];
  for (let n = 1; n < run.states.length; n++) {
    const before = run.states[n - 1][0], now = run.states[n][0];
    if (before < 0 && now >= 0) rises.push((n - now / (now - before)) * run.h);
  }
  return rises.length < 2 ? NaN : 2 * Math.PI * (rises.length - 1) / (rises.at(-1) - rises[0]);
}
