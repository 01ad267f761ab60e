// SPDX-License-Identifier: Apache-2.0
// What the page holds: unpacks its blocks, decodes scans, looks poses and beliefs up by time. No drawing, no three.js.
// Lengths in m relative to the building's origin, times in s, angles in rad.
"use strict";
globalThis.Plumb = globalThis.Plumb || {};

Plumb.data = (() => {
  async function bytesOf(id) {
    const element = document.getElementById(id);
    if (!element) throw new Error("the page lacks its block '" + id + "'; it is cut short or was changed");
    if (typeof DecompressionStream === "undefined")
      throw new Error("this browser cannot unpack the page (DecompressionStream); Chrome 103, Firefox 113 or Safari 16.4 can");
    const text = atob(element.textContent);
    const packed = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) packed[i] = text.charCodeAt(i);
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
    try {
      return new Uint8Array(await new Response(stream).arrayBuffer());
    } catch {
      throw new Error("block '" + id + "' of the page is damaged; make the page again with plumbline report --3d");
    }
  }

  async function treeOf(id) {
    return JSON.parse(new TextDecoder().decode(await bytesOf(id)));
  }

  /** Values of a column of differences, in units. */
  function column(differences, unit) {
    const out = new Float64Array(differences.length);
    let sum = 0;
    for (let i = 0; i < differences.length; ++i) {
      sum += differences[i];
      out[i] = sum * unit;
    }
    return out;
  }

  const half_ms = 6e-4; // times are whole ms

  /** Index of the last value <= t, or -1. */
  function lastAt(times, t) {
    let lo = 0, hi = times.length;
    while (lo < hi) {
      const mid = (lo + hi) >> 1;
      if (times[mid] <= t + half_ms) lo = mid + 1;
      else hi = mid;
    }
    return lo - 1;
  }

  function trackOf(packed) {
    return {
      t: column(packed.t, 1e-3),
      p: ["x", "y", "z"].map((k) => column(packed[k], 1e-3)),
      q: ["q0", "q1", "q2", "q3"].map((k) => column(packed[k], 1e-5)),
      e: column(packed.e, 1e-4),
      lost: column(packed.lost, 1),
    };
  }

  function poseAt(track, i) {
    const q = track.q.map((c) => c[i]);
    const norm = Math.hypot(...q) || 1;
    return { p: track.p.map((c) => c[i]), q: q.map((v) => v / norm) };
  }

  const yawOf = (q) => Math.atan2(2 * (q[3] * q[2] + q[0] * q[1]), 1 - 2 * (q[1] * q[1] + q[2] * q[2]));

  /** q v q* of a unit quaternion x, y, z, w, added to p; written to out at o. */
  function transform(q, p, x, y, z, out, o) {
    const [a, b, c, w] = q;
    const tx = 2 * (b * z - c * y), ty = 2 * (c * x - a * z), tz = 2 * (a * y - b * x);
    out[o] = p[0] + x + w * tx + b * tz - c * ty;
    out[o + 1] = p[1] + y + w * ty + c * tx - a * tz;
    out[o + 2] = p[2] + z + w * tz + a * ty - b * tx;
  }

  /** Between two poses: positions in a line, rotations by the normalised mean. */
  function between(a, b, s) {
    const sign = a.q[0] * b.q[0] + a.q[1] * b.q[1] + a.q[2] * b.q[2] + a.q[3] * b.q[3] < 0 ? -1 : 1;
    const q = a.q.map((v, k) => v * (1 - s) + sign * b.q[k] * s);
    const norm = Math.hypot(...q) || 1;
    return { p: a.p.map((v, k) => v * (1 - s) + b.p[k] * s), q: q.map((v) => v / norm) };
  }

  /** Ranges in units, ring by ring, of scan k of an unpacked chunk. */
  function rangesOf(chunk, k, n) {
    const out = new Uint16Array(n), low = 2 * n * k, high = low + n;
    return { out, low, high, chunk };
  }

  class Scans {
    constructor(about) {
      this.rings = about.rings;
      this.columns = about.columns;
      this.size = about.rings * about.columns;
      this.unit = about.unit * 1e-3;
      this.turn = about.turn * 1e-9;
      this.span = about.span * 1e-6;
      this.columnTime = about.column * 1e-9;
      this.azimuth = about.azimuth.map((v) => v * 1e-6);
      this.cosine = about.cosine.map((v) => v * 1e-6);
      this.sine = about.sine.map((v) => v * 1e-6);
      this.height = about.height.map((v) => v * 1e-5);
      this.mount = { p: about.mount.slice(0, 3).map((v) => v * 1e-5), q: about.mount.slice(3).map((v) => v * 1e-7) };
      this.all = about.all;
      this.perChunk = about.chunk;
      this.t = column(about.t, 1e-3);
      this.a = column(about.a, 1e-5);
      this.cache = new Map();
    }

    get count() { return this.t.length; }

    /** The kept scan nearest to t, or -1. */
    nearest(t) {
      const i = lastAt(this.t, t);
      if (i < 0) return this.count ? 0 : -1;
      return i + 1 < this.count && this.t[i + 1] - t < t - this.t[i] ? i + 1 : i;
    }

    async chunk(c) {
      if (!this.cache.has(c)) {
        if (this.cache.size > 24) this.cache.delete(this.cache.keys().next().value);
        this.cache.set(c, bytesOf("scans" + c));
      }
      return this.cache.get(c);
    }

    /** Ranges of kept scan i in units of 1 cm or so, ring by ring; 0: no return. */
    async ranges(i) {
      const chunk = await this.chunk(Math.floor(i / this.perChunk));
      const { out, low, high } = rangesOf(chunk, i % this.perChunk, this.size);
      if (chunk.length < high + this.size) throw new Error("a block of scans is cut short");
      for (let ring = 0, k = 0; ring < this.rings; ++ring) {
        let sum = 0;
        for (let c = 0; c < this.columns; ++c, ++k) {
          const v = chunk[low + k] | (chunk[high + k] << 8);
          sum = (sum + ((v >>> 1) ^ -(v & 1))) & 0xffff;
          out[k] = sum;
        }
      }
      return out;
    }

    /** Points of a scan in W, with the robot at `first` at its first column and at `last` at its stamp. */
    points(i, ranges, first, last) {
      const points = new Float32Array(3 * this.size), ring = new Uint8Array(this.size);
      const inRobot = [0, 0, 0];
      let n = 0;
      const poses = [];
      for (let c = 0; c < this.columns; ++c) poses.push(between(first, last, Math.min(1, (c * this.columnTime) / this.span)));
      for (let r = 0; r < this.rings; ++r) {
        for (let c = 0; c < this.columns; ++c) {
          const range = ranges[r * this.columns + c] * this.unit;
          if (range === 0) continue;
          const az = this.a[i] + c * this.turn + this.azimuth[r], flat = range * this.cosine[r];
          transform(this.mount.q, this.mount.p, flat * Math.cos(az), -flat * Math.sin(az), range * this.sine[r] + this.height[r],
            inRobot, 0);
          transform(poses[c].q, poses[c].p, inRobot[0], inRobot[1], inRobot[2], points, 3 * n);
          ring[n++] = r;
        }
      }
      return { points: points.subarray(0, 3 * n), ring: ring.subarray(0, n), count: n };
    }
  }

  async function load() {
    const [run, scene, mesh, tracks, beliefs, graphs, scans] = await Promise.all([
      treeOf("run"), treeOf("scene"), bytesOf("mesh"), treeOf("tracks"), treeOf("beliefs"), treeOf("graphs"), treeOf("scans"),
    ]);
    const triangles = scene.elements.reduce((sum, e) => Math.max(sum, e[3] + e[4]), 0);
    const vertices = (mesh.length - 12 * triangles) / 12;
    const data = {
      run, scene, beliefs, graphs,
      end: run.end * 1e-3,
      mesh: {
        position: new Float32Array(mesh.buffer, 0, 3 * vertices),
        index: new Uint32Array(mesh.buffer, 12 * vertices, 3 * triangles),
      },
      tracks: Object.fromEntries(Object.entries(tracks).map(([name, packed]) => [name, trackOf(packed)])),
      scans: new Scans(scans),
    };
    data.faces = scene.faces.map((f) => ({
      id: f.id, wall: f.wall, s: f.s, p: f.p.map((v) => v * 1e-3), q: f.q.map((v) => v * 1e-3), z: f.z.map((v) => v * 1e-3),
      holes: f.holes.map((h) => h.map((v) => v * 1e-3)),
    }));
    data.storeys = scene.storeys.map((s) => ({ name: s.name, z: s.z * 1e-3, h: s.h * 1e-3 }));
    data.rooms = scene.rooms.map((r) => ({ name: r.name, s: r.s, at: r.at.map((p) => p.map((v) => v * 1e-3)) }));
    data.plangraph = scene.plangraph && {
      rooms: scene.plangraph.rooms.map(([name, s, x, y]) => ({ name, s, p: [x * 1e-3, y * 1e-3] })),
      faces: scene.plangraph.room_face, doors: scene.plangraph.room_room,
    };
    for (const belief of Object.values(beliefs)) {
      belief.stateTimes = belief.states.map((s) => s[0] * 1e-3);
      belief.setTimes = belief.sets.map((s) => s[0] * 1e-3);
      belief.particleTimes = belief.particles.map((s) => s[0] * 1e-3);
    }
    run.marks.forEach((m) => { m.t *= 1e-3; });
    for (const [name, belief] of Object.entries(beliefs)) {
      // While it has no answer yet, its first hypothesis may be a wrong one.
      const answers = (t) => { const i = lastAt(belief.stateTimes, t); return i >= 0 && states[belief.states[i][1]] === "CONVERGED"; };
      const first = belief.sets.find((set) => set[2].length > 0 && set[2][0][7].some((wall) => wall[2] === 0) && answers(set[0] * 1e-3));
      if (first) run.marks.push({ t: first[0] * 1e-3, label: "first wall matched wrongly", kind: "wrong", m: name });
    }
    run.marks.sort((a, b) => a.t - b.t);
    return data;
  }

  const longest_gap = 1.0; // s without a pose after which a method has none

  /** The pose of a track at t as it was known then: the last one given, or null where that is too long ago. */
  function known(track, t) {
    const i = lastAt(track.t, t);
    if (i < 0 || t - track.t[i] > longest_gap) return null;
    return { ...poseAt(track, i), e: track.e[i], lost: track.lost[i] > 0.5, i };
  }

  /** Whether a pose of a track is an answer that is too far off: LOST is none. */
  const isWrong = (data, track, i) => track.e[i] > data.run.wrong * 1e-3 && track.lost[i] < 0.5;

  /** Poses at the first and the last firing of a scan that ended at t, or null. */
  function sweepPoses(track, t, span) {
    const i = lastAt(track.t, t + 0.02);
    if (i < 0 || Math.abs(track.t[i] - t) > longest_gap) return null;
    const last = poseAt(track, i);
    if (i === 0 || track.t[i] - track.t[i - 1] > 2 * span || track.lost[i - 1] > 0.5) return [last, last];
    return [between(poseAt(track, i - 1), last, Math.max(0, 1 - span / (track.t[i] - track.t[i - 1]))), last];
  }

  function stateAt(belief, t) {
    const i = lastAt(belief.stateTimes, t);
    return i < 0 ? null : { state: belief.states[i][1], hypotheses: belief.states[i][2] };
  }

  /** The hypotheses kept last, with their age in s. */
  function setAt(belief, t) {
    const i = lastAt(belief.setTimes, t);
    if (i < 0) return null;
    const hypotheses = belief.sets[i][2].map((h) => ({
      share: h[0] * 1e-4, p: h.slice(1, 4).map((v) => v * 1e-3), yaw: h[4] * 1e-3, room: h[5], cov: h[6].map((v) => v * 1e-4),
      walls: h[7].map((w) => ({ patch: w[0].map((v) => v * 1e-3), faces: w[1], right: w[2] === 1, seen: w[3] || "" })),
    }));
    return { t: belief.setTimes[i], age: t - belief.setTimes[i], all: belief.sets[i][1], hypotheses };
  }

  /** A patch [x0, y0, x1, y1] that was seen from a hypothesis, where it stands as seen from the true pose. */
  function patchFrom(patch, hypothesis, truth) {
    const turn = yawOf(truth.q) - hypothesis.yaw, c = Math.cos(turn), s = Math.sin(turn);
    const put = (x, y) => [truth.p[0] + c * (x - hypothesis.p[0]) - s * (y - hypothesis.p[1]), truth.p[1] + s * (x - hypothesis.p[0]) + c * (y - hypothesis.p[1])];
    return [...put(patch[0], patch[1]), ...put(patch[2], patch[3])];
  }

  function particlesAt(belief, t) {
    const i = lastAt(belief.particleTimes, t);
    if (i < 0 || t - belief.particleTimes[i] > 2.0) return null;
    return belief.particles[i][1];
  }

  /** Points of a method's final map, m, or null where it has none: x, y, z in cm, low bytes, then high bytes. */
  function mapOf(data, name) {
    const map = data.run.maps[name];
    if (!map) return null;
    if (!map.points)
      map.points = bytesOf(map.block).then((bytes) => {
        const n = map.count, points = new Float32Array(3 * n);
        for (let k = 0; k < 3 * n; ++k) points[3 * (k % n) + Math.floor(k / n)] = 0.01 * (((bytes[k] | (bytes[3 * n + k] << 8)) << 16) >> 16);
        return points;
      });
    return map.points;
  }

  const states = ["SEARCHING", "AMBIGUOUS", "CONVERGED", "LOST"];
  return { load, mapOf, known, isWrong, sweepPoses, stateAt, setAt, patchFrom, particlesAt, lastAt, yawOf, poseAt, states, bytesOf };
})();
