// SPDX-License-Identifier: Apache-2.0
// Graphs above the plan: the situational graph of a method, and the architectural graph of the plan itself.
"use strict";

Object.assign(Plumb.View3d.prototype, {
  /** Keyframes, walls, rooms and floors above the plan, each kind higher than the one before. */
  drawGraph(moment) {
    this.clear(this.groups.graph);
    const graph = moment.graph;
    if (!graph) return;
    const lift = moment.lift, m = (p) => p.map((v) => v * 1e-3);
    const heights = { keyframe: 2.0, wall: 3.6, room: 5.4, floor: 7.0 };
    const at = {
      keyframe: graph.keyframes.map((k) => { const p = m(k.slice(0, 3)); return [p[0], p[1], p[2] + heights.keyframe * lift]; }),
      wall: [], room: [], floor: [],
    };
    for (const [id, p, q] of graph.walls) {
      const a = m(p), b = m(q);
      at.wall[id] = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), a[2] + heights.wall * lift];
    }
    for (const [id, p] of graph.rooms) { const a = m(p); at.room[id] = [a[0], a[1], a[2] + heights.room * lift]; }
    for (const [id, p] of graph.floors) { const a = m(p); at.floor[id] = [a[0], a[1], a[2] + heights.floor * lift + 1]; }
    const shown = graph.keyframes.map((k) => k[3] * 1e-3 <= moment.t + 1e-6);
    const nodes = [], colours = [], sizes = { keyframe: [86, 180, 233], wall: [0, 114, 178], room: [204, 121, 167], floor: [230, 159, 0] };
    for (const [kind, list] of Object.entries(at))
      list.forEach((p, i) => {
        if (!p || (kind === "keyframe" && !shown[i])) return;
        nodes.push(...p);
        colours.push(...sizes[kind]);
      });
    const points = this.pointsOf(nodes.length / 3, 8, 1e-4);
    this.setPoints(points, new Float32Array(nodes), new Uint8Array(colours), nodes.length / 3);
    this.groups.graph.add(points);
    const walls = [];
    for (const [, p, q] of graph.walls) {
      const a = m(p), b = m(q), z = a[2] + heights.wall * lift;
      walls.push(a[0], a[1], z - 0.35, b[0], b[1], z - 0.35, b[0], b[1], z + 0.35, a[0], a[1], z + 0.35);
    }
    this.groups.graph.add(this.quads(walls, this.flat("#0072B2", 0.35)));
    const path = [];
    for (let i = 1; i < at.keyframe.length; ++i) if (shown[i]) path.push(...at.keyframe[i - 1], ...at.keyframe[i]);
    this.lines(path, "#56B4E9", 0.9);
    const edges = [];
    for (let i = 0; i < graph.keyframe_wall.length; i += 6) // one edge in three, or they would hide everything
      if (shown[graph.keyframe_wall[i]]) this.edge(edges, at.keyframe[graph.keyframe_wall[i]], at.wall[graph.keyframe_wall[i + 1]]);
    this.lines(edges, "#888888", 0.18);
    const upper = [];
    for (let i = 0; i < graph.room_wall.length; i += 2) this.edge(upper, at.room[graph.room_wall[i]], at.wall[graph.room_wall[i + 1]]);
    for (let i = 0; i < graph.floor_room.length; i += 2) this.edge(upper, at.floor[graph.floor_room[i]], at.room[graph.floor_room[i + 1]]);
    this.lines(upper, "#CC79A7", 0.8);
  },

  /**
   * Rooms of the plan over their middles, faces over their own, an edge where a face bounds a room and where a door joins two rooms.
   * Faces that the first hypothesis matches now are green where rightly and vermilion where wrongly, and larger.
   */
  drawPlanGraph(moment) {
    this.clear(this.groups.plangraph);
    const graph = moment.plangraph;
    if (!graph) return;
    const matched = new Map(), z = (height) => moment.floor + height * moment.lift, byId = this.facesById();
    if (moment.set && moment.set.hypotheses[0])
      for (const w of moment.set.hypotheses[0].walls) for (const id of w.faces) matched.set(id, w.right);
    const room = graph.rooms.map((r) => (r.s === moment.storey ? [...r.p, z(5.4)] : null));
    const face = (id) => {
      const f = byId.get(id);
      return f && f.s === moment.storey ? [0.5 * (f.p[0] + f.q[0]), 0.5 * (f.p[1] + f.q[1]), z(3.6)] : null;
    };
    const seen = new Set(), nodes = { plain: [[], [122, 74, 158], 7], room: [[], [230, 159, 0], 10], right: [[], Plumb.colours.right, 11], wrong: [[], Plumb.colours.wrong, 11] };
    for (const p of room) if (p) nodes.room[0].push(...p);
    const bounds = [], doors = [], matches = [];
    for (let i = 0; i < graph.faces.length; i += 2) {
      const id = graph.faces[i + 1], p = face(id);
      if (!p) continue;
      this.edge(bounds, room[graph.faces[i]], p);
      if (seen.has(id)) continue;
      seen.add(id);
      const known = matched.get(id);
      nodes[known === undefined ? "plain" : known ? "right" : "wrong"][0].push(...p);
      if (known !== undefined) this.edge(matches, p, [p[0], p[1], moment.floor + 1.2]);
    }
    for (let i = 0; i < graph.doors.length; i += 2) this.edge(doors, room[graph.doors[i]], room[graph.doors[i + 1]]);
    for (const [at, colour, size] of Object.values(nodes)) {
      const n = at.length / 3, points = this.pointsOf(n, size, 1e-4);
      this.setPoints(points, new Float32Array(at), new Uint8Array(Array.from({ length: n }, () => colour).flat()), n);
      this.groups.plangraph.add(points);
    }
    this.lines(bounds, "#7A4A9E", 0.45, this.groups.plangraph);
    this.lines(doors, "#E69F00", 0.9, this.groups.plangraph);
    this.lines(matches, "#888888", 0.7, this.groups.plangraph);
  },

  edge(list, a, b) { if (a && b) list.push(...a, ...b); },

  lines(positions, colour, opacity, group = this.groups.graph) {
    if (positions.length === 0) return;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(positions), 3));
    const line = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: colour, transparent: true, opacity }));
    line.frustumCulled = false;
    group.add(line);
  },
});
