/**
 * The arm inside the page. One interface over two kinds: generated C as WebAssembly, or frames that were
 * computed beforehand. Metres, radians, base frame; q is an array with one number per joint.
 *
 * @typedef {Object} Kinematics
 * @property {"wasm"|"frames"} kind
 * @property {string} note One sentence about the kind, for the reader of the page.
 * @property {number} dof
 * @property {string[]} jointNames
 * @property {number[]} lower Lower limits of the joints.
 * @property {number[]} upper Upper limits of the joints.
 * @property {Object<string, number>} landmarks Index of shoulder, elbow, wrist, hand in what joints() returns.
 * @property {boolean} canSwivel Whether the elbow can be turned while the hand stays.
 * @property {string} whyNoSwivel Why it cannot; empty if it can.
 * @property {number} step Distance of the swivel angles that posture() knows; 0 if it knows all.
 * @property {function(number[]): number[][]} joints A point on the axis of each joint, then the hand.
 * @property {function(number[]): {position: number[], rotation: number[][]}} hand Pose of the hand.
 * @property {function(number[], number[]=): number} swivel Swivel angle of a posture, -pi to pi; the second
 *   argument is the unit vector along which the elbow points at 0, the arm's own if left out.
 * @property {function(number, number[], number[]=): number[]} posture The posture with the hand where q has
 *   it, on the branches of q, at a swivel angle.
 * @property {function(number[]): Blocked[]} blocked Joints outside their range of motion, the worst first.
 * @property {function(number[], number, number[]=): {psi: number, blocked: Blocked[]}[]} blockedAlong What
 *   blocks at that many swivel angles from -pi on.
 *
 * @typedef {Object} Blocked
 * @property {number} joint Index of the joint.
 * @property {string} name Its name.
 * @property {number} missing By how much it misses its range.
 * @property {"lower"|"upper"} limit Which limit it misses.
 */

/** @type {function(Object): Promise<Kinematics>} Takes the data that Python wrote into the page. */
const armikKinematics = (() => {
  "use strict";
  const TURN = 2 * Math.PI;

  const bytesOf = (text) => Uint8Array.from(atob(text), (character) => character.charCodeAt(0));

  const numbersOf = (text) => new Float64Array(bytesOf(text).buffer);

  const withoutTurns = (angle) => angle - TURN * Math.round(angle / TURN);

  /** Points of the joints and of the hand, from numbers that lie one after the other. */
  function pointsOf(drawn, dof) {
    const points = [];
    for (let j = 0; j <= dof; ++j) points.push(Array.from(drawn.slice(3 * j, 3 * j + 3)));
    return points;
  }

  function poseOf(drawn, dof) {
    const pose = Array.from(drawn.slice(3 * dof, 3 * dof + 12));
    return {
      position: pose.slice(0, 3),
      rotation: [pose.slice(3, 6), pose.slice(6, 9), pose.slice(9, 12)],
    };
  }

  /** What the generated C answers. The module has no heap, so its arrays never move. */
  async function fromWasm(data) {
    if (typeof WebAssembly === "undefined") {
      throw new Error("This browser does not run WebAssembly, which moves the arm of this page.");
    }
    const { instance } = await WebAssembly.instantiate(bytesOf(data.module), {});
    const c = instance.exports;
    c._initialize();
    const array = (name, size) => new Float64Array(c.memory.buffer, c[name + "_at"](), size);
    const q = array("q", data.dof);
    const drawn = array("drawn", 3 * data.dof + 12);
    array("lengths", data.lengths.length).set(data.lengths);
    array("points", 3 * data.dof).set(data.points);
    const draw = (posture) => {
      q.set(posture);
      c.draw();
      return drawn;
    };
    if (data.whyNoSwivel) return { step: 0, draw };
    const reference = array("reference", 3);
    const answer = array("posture", data.dof);
    array("geometry", 46).set(data.geometry);
    array("limits", 16).set(data.limits);
    const take = (posture, direction) => {
      q.set(posture);
      reference.set(direction || data.reference);
    };
    return {
      step: 0,
      draw,
      swivel(posture, direction) {
        take(posture, direction);
        return c.swivel();
      },
      posture(psi, posture, direction) {
        take(posture, direction);
        c.turn_elbow(psi);
        return Array.from(answer);
      },
    };
  }

  /** What was computed beforehand: the nearest frame answers. */
  function fromFrames(data) {
    const { dof, steps } = data;
    const q = numbersOf(data.q);
    const drawn = numbersOf(data.drawn);
    const psi = numbersOf(data.psi);
    const turned = numbersOf(data.turned);
    const rows = q.length / dof;
    const width = 3 * dof + 12;
    const stride = dof + 3;

    /** Largest difference to a stored posture, or something not below `enough`. */
    function distance(posture, stored, start, enough) {
      let largest = 0;
      for (let j = 0; j < dof && largest < enough; ++j) {
        largest = Math.max(largest, Math.abs(posture[j] - stored[start + j]));
      }
      return largest;
    }

    /** Row and step of the stored posture nearest to one; those of the motion itself come first. */
    function nearest(posture) {
      const found = { row: 0, step: 0, away: Infinity };
      const look = (row, step, away) => {
        if (away < found.away) Object.assign(found, { row, step, away });
      };
      for (let row = 0; row < rows; ++row) look(row, 0, distance(posture, q, row * dof, found.away));
      for (let k = 0; k < rows * steps && found.away > 0; ++k) {
        look(Math.floor(k / steps), k % steps, distance(posture, turned, k * stride, found.away));
      }
      return found;
    }

    return {
      step: steps ? TURN / steps : 0,
      draw(posture) {
        const { row, step } = nearest(posture);
        const answer = drawn.slice(row * width, (row + 1) * width);
        if (step) {
          const start = (row * steps + step) * stride + dof;
          answer.set(turned.subarray(start, start + 3), 3 * data.landmarks.elbow);
        }
        return answer;
      },
      swivel(posture) {
        const { row, step } = nearest(posture);
        return withoutTurns(psi[row] + (TURN * step) / steps);
      },
      posture(angle, posture) {
        const { row } = nearest(posture);
        const step = Math.round(((angle - psi[row]) / TURN) * steps);
        const start = (row * steps + (((step % steps) + steps) % steps)) * stride;
        return Array.from(turned.subarray(start, start + dof));
      },
    };
  }

  /** Joints of a posture that are outside their range of motion. */
  function blockedOf(data, q) {
    const found = [];
    for (let joint = 0; joint < data.dof; ++joint) {
      const below = data.lower[joint] - q[joint];
      const above = q[joint] - data.upper[joint];
      const missing = Math.max(below, above);
      if (!(missing > data.rounding)) continue;
      found.push({ joint, name: data.jointNames[joint], missing, limit: below > above ? "lower" : "upper" });
    }
    return found.sort((a, b) => b.missing - a.missing);
  }

  return async function (data) {
    const source = data.kind === "wasm" ? await fromWasm(data) : fromFrames(data);
    const checked = (q) => {
      if (q.length !== data.dof || !Array.prototype.every.call(q, Number.isFinite)) {
        throw new Error("A posture of this arm is " + data.dof + " finite numbers, not [" + q + "].");
      }
      return q;
    };
    const swiveling = (q) => {
      if (data.whyNoSwivel) throw new Error("The elbow cannot be turned: " + data.whyNoSwivel);
      return checked(q);
    };
    const kinematics = {
      kind: data.kind,
      note: data.note,
      dof: data.dof,
      jointNames: data.jointNames,
      lower: data.lower,
      upper: data.upper,
      landmarks: data.landmarks,
      canSwivel: !data.whyNoSwivel,
      whyNoSwivel: data.whyNoSwivel,
      step: source.step,
      joints: (q) => pointsOf(source.draw(checked(q)), data.dof),
      hand: (q) => poseOf(source.draw(checked(q)), data.dof),
      swivel: (q, reference) => source.swivel(swiveling(q), reference),
      posture: (psi, q, reference) => source.posture(psi, swiveling(q), reference),
      blocked: (q) => blockedOf(data, checked(q)),
      blockedAlong(q, count, reference) {
        return Array.from({ length: count }, (_, i) => {
          const psi = -Math.PI + (TURN * i) / count;
          return { psi, blocked: blockedOf(data, kinematics.posture(psi, q, reference)) };
        });
      },
    };
    return Object.freeze(kinematics);
  };
})();
