// Up to nine rotors on a square grid with massless bars: the linear motion about upright, and whether it stays bounded.
//
// A bar along x holds the tilts along x of its two tips equal, a bar along y those along y. So rotors joined along x share
// one freedom, a row, and those joined along y another, a column; each rotor lies in one of each, and its axial momentum
// couples the two. With a the inertia of an axis about its joint and kappa the moment of its weight, both the same for all,
// a motion s of the pair of degrees of freedom with the coupling beta obeys a² s⁴ + (beta² − 2 a kappa) s² + kappa² = 0: it is bounded
// where beta >= 2 sqrt(a kappa). beta: the singular values of W, W[row][column] the sum of the G of the rotors in both, over
// the root of the two's numbers of rotors. Degrees of freedom without a partner have beta = 0, and fall at any spin.

const SIDE = 3, GRAVITY = 9.81; // m/s²; every rotor has M = R = I1 = I3 = 1

// Lists of places that bars join, each from a place in `joined` to the one `next` further on.
function runs(present, joined, next) {
  const found = [];
  for (const i of present) {
    if (joined.has(i - next) && present.includes(i - next)) found.find((run) => run.includes(i - next)).push(i);
    else found.push([i]);
  }
  return found;
}

// Eigenvalues of a symmetric matrix by Jacobi's rotations, none beyond an eighth of a turn.
function eigenvalues(given) {
  const A = given.map((row) => [...row]), n = A.length;
  for (let sweep = 0; sweep < 50; sweep++) {
    let off = 0;
    for (let p = 0; p < n; p++) {
      for (let q = p + 1; q < n; q++) {
        if (A[p][q] === 0) continue;
        off += A[p][q] ** 2;
        const angle = 0.5 * Math.atan(2 * A[p][q] / (A[q][q] - A[p][p])), c = Math.cos(angle), s = Math.sin(angle);
        for (let k = 0; k < n; k++) [A[k][p], A[k][q]] = [c * A[k][p] - s * A[k][q], s * A[k][p] + c * A[k][q]];
        for (let k = 0; k < n; k++) [A[p][k], A[q][k]] = [c * A[p][k] - s * A[q][k], s * A[p][k] + c * A[q][k]];
      }
    }
    if (off < 1e-28 * (1 + A.reduce((sum, row, i) => sum + row[i] ** 2, 0))) break;
  }
  return A.map((row, i) => row[i]);
}

// Of modes that the spins hold the rates (β ± sqrt(β² − 4 a κ))/2a, fast ones of positive and slow ones of negative energy: the
// fast one and the two slow ones that come nearest to fast = slow + slow, as a share of the fast one.
function nearestResonance(betas, a, kappa) {
  const root = (beta) => Math.sqrt(Math.max(beta ** 2 - 4 * a * kappa, 0));
  const fast = betas.map((beta) => (beta + root(beta)) / (2 * a)), slow = betas.map((beta) => (beta - root(beta)) / (2 * a));
  const all = fast.flatMap((f) => slow.flatMap((s, i) => slow.slice(i).map((other) => ({ off: Math.abs(f - s - other) / f, fast: f, slow: [s, other] }))));
  return all.reduce((best, one) => (one.off < best.off ? one : best), { off: Infinity });
}

// spins: of the nine places in rad/s, null where there is no rotor; right, up: places from which a bar goes to the next
// along x, along y; load: kg on each tip.
function standing(spins, right, up, load) {
  const present = spins.flatMap((spin, i) => (spin === null ? [] : [i]));
  const rows = runs(present, new Set(right), 1), columns = runs(present, new Set(up), SIDE);
  const a = 1.25 + load, kappa = GRAVITY * (0.5 + load), needed = 2 * Math.sqrt(a * kappa);
  const W = rows.map((row) => columns.map((column) =>
    row.filter((i) => column.includes(i)).reduce((sum, i) => sum + spins[i], 0) / Math.sqrt(row.length * column.length)));
  const wide = rows.length <= columns.length;
  const few = wide ? W : columns.map((_, j) => W.map((row) => row[j]));
  const square = few.map((one) => few.map((other) => one.reduce((sum, x, k) => sum + x * other[k], 0)));
  const betas = eigenvalues(square).map((x) => Math.sqrt(Math.max(x, 0))).sort((x, y) => x - y);
  const alone = Math.abs(rows.length - columns.length), free = alone + betas.filter((x) => x < 1e-6).length;
  const least = alone ? 0 : betas[0] ?? Infinity;
  const growth = least >= needed * (1 - 1e-12) ? 0 : Math.sqrt(Math.max(needed ** 2 - least ** 2, 0)) / (2 * a);
  return {
    rows, columns, a, kappa, betas, alone, free, growth,
    stands: present.length > 0 && growth === 0, factor: free ? Infinity : needed / least,
    resonance: growth === 0 ? nearestResonance(betas, a, kappa) : { off: Infinity },
  };
}

// The tilts (x, y) of the places after a push, by steps of Runge and Kutta; `state` holds the coordinates and their rates.
function stepper(found, spins) {
  const { rows, columns, a, kappa } = found, h = rows.length, n = h + columns.length;
  const runsOf = [...rows, ...columns], places = rows.flat();
  const at = (i) => [rows.findIndex((run) => run.includes(i)), h + columns.findIndex((run) => run.includes(i))];
  const rate = (y) => {
    const force = runsOf.map((run, k) => kappa * run.length * y[k]);
    for (const i of places) {
      const [x, across] = at(i);
      force[x] -= spins[i] * y[n + across];
      force[across] += spins[i] * y[n + x];
    }
    return [...y.slice(n), ...force.map((f, k) => f / (a * runsOf[k].length))];
  };
  const moved = (y, by, k) => y.map((v, i) => v + by * k[i]);
  return {
    step: (y, dt) => {
      const k1 = rate(y), k2 = rate(moved(y, dt / 2, k1)), k3 = rate(moved(y, dt / 2, k2)), k4 = rate(moved(y, dt, k3));
      return y.map((v, i) => v + dt / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]));
    },
    pushed: () => Array.from({ length: 2 * n }, (_, k) => (k < n ? 0 : 0.2 * Math.cos(1 + 2 * k))), // 1/s, in no special direction
    tilts: (y) => Object.fromEntries(places.map((i) => [i, at(i).map((k) => y[k])])),
  };
}
