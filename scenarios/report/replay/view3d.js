// SPDX-License-Identifier: Apache-2.0
// The run in three dimensions. The only part that uses three.js; it is given a moment and draws it.
"use strict";

Plumb.View3d = class {
  /** Throws where there is no WebGL. */
  constructor(canvas, data, labels) {
    THREE.ColorManagement.enabled = false; // colours of the page are those of the picture
    this.data = data;
    this.base = data.run.base * 1e-3; // of the robot's frame above the floor
    this.labels = labels;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, stencil: true, preserveDrawingBuffer: Plumb.testing === true });
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
    this.camera = new THREE.PerspectiveCamera(45, 1, 0.1, 1000);
    this.camera.up.set(0, 0, 1);
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.maxPolarAngle = 0.49 * Math.PI;
    this.controls.screenSpacePanning = false;
    this.controls.addEventListener("start", () => { this.placed = true; });
    this.scene = new THREE.Scene();
    this.groups = {};
    for (const name of ["building", "scan", "paths", "robots", "particles", "hypotheses", "walls", "graph", "plangraph", "map", "deviations", "selection"]) {
      this.groups[name] = new THREE.Group();
      this.scene.add(this.groups[name]);
    }
    this.cut = { value: 0 };
    this.buildBuilding();
    this.buildScan();
    this.buildPaths();
    this.buildDeviations();
    this.home();
  }

  /** From the south and above, so that the building fits the narrow side. */
  home(storey = 0) {
    const box = this.box(), level = this.data.storeys[storey] ? this.data.storeys[storey].z : 0;
    const cx = 0.5 * (box.min[0] + box.max[0]), cy = 0.5 * (box.min[1] + box.max[1]);
    const corners = [box.min[0], box.max[0]].flatMap((x) => [box.min[1], box.max[1]].map((y) => new THREE.Vector3(x, y, level)));
    this.controls.target.set(cx, cy, level);
    for (let distance = 3; distance < 900; distance *= 1.05) {
      this.camera.position.set(cx, cy - 0.5 * distance, level + 0.87 * distance);
      this.camera.lookAt(cx, cy, level);
      this.camera.updateMatrixWorld(true);
      if (corners.every((p) => { const v = p.clone().project(this.camera); return Math.abs(v.x) < 0.97 && Math.abs(v.y) < 0.92 && v.z < 1; })) break;
    }
    this.controls.update();
  }

  box() {
    const min = [1e9, 1e9], max = [-1e9, -1e9];
    const add = (x, y) => {
      min[0] = Math.min(min[0], x);
      min[1] = Math.min(min[1], y);
      max[0] = Math.max(max[0], x);
      max[1] = Math.max(max[1], y);
    };
    for (const f of this.data.faces) {
      add(f.p[0], f.p[1]);
      add(f.q[0], f.q[1]);
    }
    if (this.data.faces.length === 0)
      for (let i = 0; i < this.data.mesh.position.length; i += 3) add(this.data.mesh.position[i], this.data.mesh.position[i + 1]);
    return { min, max };
  }

  buildBuilding() {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(this.data.mesh.position, 3));
    geometry.setIndex(new THREE.BufferAttribute(this.data.mesh.index, 1));
    this.buildingMaterial = new THREE.ShaderMaterial({
      side: THREE.DoubleSide,
      uniforms: { cut: this.cut, floor: { value: 0 }, light: { value: 1 } },
      vertexShader: "varying vec3 at; void main() { at = position; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }",
      fragmentShader: `
        uniform float cut, floor, light;
        varying vec3 at;
        void main() {
          if (at.z > cut) discard;
          vec3 n = normalize(cross(dFdx(at), dFdy(at)));
          float up = abs(n.z), side = 0.5 + 0.5 * abs(n.x * 0.8 + n.y * 0.35);
          vec3 wall = mix(vec3(0.70, 0.74, 0.79), vec3(0.86, 0.88, 0.91), side);
          vec3 ground = vec3(0.955, 0.96, 0.97);
          vec3 c = mix(wall, ground, smoothstep(0.6, 0.9, up));
          if (!gl_FrontFacing) c = vec3(0.22, 0.26, 0.31);
          if (at.z < floor - 0.4) c = mix(c, vec3(0.9), 0.5);
          gl_FragColor = vec4(mix(c * vec3(0.42, 0.45, 0.5), c, light), 1.0);
        }`,
    });
    this.building = new THREE.Mesh(geometry, this.buildingMaterial);
    this.building.frustumCulled = false;
    this.groups.building.add(this.building);
    if (this.data.faces.length) this.buildCaps(geometry);
  }

  /** Tops of what is cut. Of a closed solid that the cut goes through, a ray from above meets one more back face than front faces below the
      cut: these are counted in the stencil, and a plane is drawn where some are left. A building without faces need not be closed. */
  buildCaps(geometry) {
    const [front, back, keep, more, less, always, unequal] = [0, 1, 7680, 34055, 34056, 519, 517];
    const { vertexShader } = this.buildingMaterial, add = (mesh, order) => {
      mesh.frustumCulled = false;
      mesh.renderOrder = order;
      this.groups.building.add(mesh);
    };
    for (const [side, op] of [[back, more], [front, less]])
      add(new THREE.Mesh(geometry, new THREE.ShaderMaterial({ side, uniforms: { cut: this.cut }, vertexShader, depthTest: false, depthWrite: false,
        colorWrite: false, stencilWrite: true, stencilFunc: always, stencilFail: op, stencilZFail: op, stencilZPass: op,
        fragmentShader: "uniform float cut; varying vec3 at; void main() { if (at.z > cut) discard; gl_FragColor = vec4(1.0); }" })), -2);
    const { min, max } = this.box(), [x0, y0, x1, y1] = [min[0] - 5, min[1] - 5, max[0] + 5, max[1] + 5];
    this.caps = this.quads([x0, y0, 0, x1, y0, 0, x1, y1, 0, x0, y1, 0], this.flat("#38424f"));
    Object.assign(this.caps.material, { stencilWrite: true, stencilFunc: unequal, stencilRef: 0, stencilFail: keep, stencilZFail: keep, stencilZPass: keep });
    add(this.caps, -1);
  }

  pointsOf(most, size, lift) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * most), 3));
    geometry.setAttribute("colour", new THREE.BufferAttribute(new Uint8Array(3 * most), 3, true));
    const material = new THREE.ShaderMaterial({
      uniforms: { size: { value: size }, lift: { value: lift } },
      vertexShader: `
        attribute vec3 colour;
        uniform float size, lift;
        varying vec3 shown;
        void main() {
          shown = colour;
          gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
          gl_Position.z -= lift * gl_Position.w;
          gl_PointSize = size;
        }`,
      fragmentShader: "varying vec3 shown; void main() { gl_FragColor = vec4(shown, 1.0); }",
    });
    const points = new THREE.Points(geometry, material);
    points.frustumCulled = false;
    return points;
  }

  setPoints(points, positions, colours, count) {
    const { position, colour } = points.geometry.attributes;
    position.array.set(positions.subarray(0, 3 * count));
    colour.array.set(colours.subarray(0, 3 * count));
    position.needsUpdate = colour.needsUpdate = true;
    points.geometry.setDrawRange(0, count);
  }

  buildScan() {
    this.scanPoints = this.pointsOf(this.data.scans.size, 3, 2e-4);
    this.groups.scan.add(this.scanPoints);
    this.particlePoints = this.pointsOf(2048, 4, 4e-4);
    this.groups.particles.add(this.particlePoints);
  }

  flat(colour, opacity = 1) {
    return new THREE.MeshBasicMaterial({ color: colour, side: THREE.DoubleSide, transparent: opacity < 1, opacity, depthWrite: opacity === 1 });
  }

  /** A mesh of quads, four corners each. */
  quads(corners, material) {
    const n = corners.length / 12, index = new Uint32Array(6 * n);
    for (let i = 0; i < n; ++i) index.set([4 * i, 4 * i + 1, 4 * i + 2, 4 * i, 4 * i + 2, 4 * i + 3], 6 * i);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(corners), 3));
    geometry.setIndex(new THREE.BufferAttribute(index, 1));
    const mesh = new THREE.Mesh(geometry, material);
    mesh.frustumCulled = false;
    return mesh;
  }

  /** Paths are ribbons a few cm above the floor; a piece is never drawn over a gap, a jump, or where the method is lost. */
  buildPaths() {
    this.paths = {};
    const names = ["truth", ...this.data.run.methods.map((m) => m.name)];
    names.forEach((name, k) => {
      const track = this.data.tracks[name];
      if (!track) return;
      const corners = [], half = name === "truth" ? 0.035 : 0.03, lift = name === "truth" ? 0.06 : 0.05 - 0.002 * k;
      const ends = []; // index of the pose at the end of each piece
      for (let i = 1, from = 0; i < track.t.length; ++i) {
        const dx = track.p[0][i] - track.p[0][from], dy = track.p[1][i] - track.p[1][from], d = Math.hypot(dx, dy);
        if (track.t[i] - track.t[i - 1] > 1 || d > 1 || track.lost[i] > 0.5) {
          from = i;
          continue;
        }
        if (d < 0.05) continue;
        const nx = (-dy / d) * half, ny = (dx / d) * half, z0 = track.p[2][from] - this.base + lift, z1 = track.p[2][i] - this.base + lift;
        corners.push(track.p[0][from] + nx, track.p[1][from] + ny, z0, track.p[0][from] - nx, track.p[1][from] - ny, z0,
          track.p[0][i] - nx, track.p[1][i] - ny, z1, track.p[0][i] + nx, track.p[1][i] + ny, z1);
        ends.push(i);
        from = i;
      }
      const method = this.data.run.methods.find((m) => m.name === name);
      const mesh = this.quads(corners, this.flat(method ? method.colour : "#111111"));
      this.paths[name] = { mesh, ends };
      this.groups.paths.add(mesh);
      const robot = this.robot(method ? method.colour : "#111111", name === "truth");
      this.paths[name].robot = robot;
      this.groups.robots.add(robot);
    });
  }

  /** An arrow on the floor with a rim, 0.7 m long. */
  robot(colour, isTruth) {
    const group = new THREE.Group(), scale = isTruth ? 1.15 : 1;
    const shape = (s, material) => {
      const tip = [0.4 * s, 0, 0], left = [-0.26 * s, 0.24 * s, 0], right = [-0.26 * s, -0.24 * s, 0], tail = [-0.12 * s, 0, 0];
      return this.quads([...tip, ...left, ...tail, ...right], material);
    };
    const rim = shape(1.35 * scale, this.flat("#ffffff"));
    rim.position.z = -0.004;
    group.add(rim, shape(scale, this.flat(colour)));
    return group;
  }

  buildDeviations() {
    for (const d of this.data.scene.deviations) {
      const floor = this.data.storeys[d.s] ? this.data.storeys[d.s].z : 0;
      for (const [outline, colour] of [[d.built, "#E8871E"], [d.planned, "#7A4A9E"]]) {
        const corners = [];
        for (let i = 0; i < outline.length; ++i) {
          const a = outline[i].map((v) => v * 1e-3), b = outline[(i + 1) % outline.length].map((v) => v * 1e-3);
          const z = floor + (colour === "#7A4A9E" ? 1.22 : 1.21);
          const d2 = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1, nx = (-(b[1] - a[1]) / d2) * 0.03, ny = ((b[0] - a[0]) / d2) * 0.03;
          corners.push(a[0] + nx, a[1] + ny, z, a[0] - nx, a[1] - ny, z, b[0] - nx, b[1] - ny, z, b[0] + nx, b[1] + ny, z);
        }
        const mesh = this.quads(corners, this.flat(colour));
        mesh.userData.storey = d.s;
        this.groups.deviations.add(mesh);
      }
    }
  }

  clear(group) {
    for (const child of [...group.children]) {
      group.remove(child);
      child.traverse((part) => {
        if (part.geometry) part.geometry.dispose();
        if (part.material) part.material.dispose();
      });
    }
  }

  /** Draws a moment: see app.js for what it holds. `changed`: what to build again. */
  draw(moment, changed) {
    this.cut.value = moment.floor + 1.2;
    if (this.caps) {
      this.caps.position.z = this.cut.value;
      this.caps.material.color.set(moment.dark ? "#7c8896" : "#38424f");
    }
    this.buildingMaterial.uniforms.floor.value = moment.floor;
    this.buildingMaterial.uniforms.light.value = moment.dark ? 0 : 1;
    this.renderer.setClearColor(moment.dark ? 0x14181e : 0xffffff, 1);
    for (const [name, group] of Object.entries(this.groups)) group.visible = !moment.off.has(name);
    if (changed && moment.cloud) this.setPoints(this.scanPoints, moment.cloud.points, moment.colours, moment.cloud.count);
    this.scanPoints.visible = !!moment.cloud;
    this.scanPoints.material.uniforms.size.value = this.pointSize;
    for (const [name, path] of Object.entries(this.paths)) this.place(name, path, moment);
    if (changed) {
      this.drawParticles(moment);
      this.drawHypotheses(moment);
      this.drawWalls(moment);
      this.drawDisplaced(moment);
      this.drawGraph(moment);
      this.drawPlanGraph(moment);
      this.drawMap(moment);
      this.drawSelection(moment);
    }
    for (const mesh of this.groups.deviations.children) mesh.visible = mesh.userData.storey === moment.storey;
    this.renderer.render(this.scene, this.camera);
    this.placeLabels(moment);
  }

  place(name, path, moment) {
    const pose = moment.poses[name], hidden = moment.hidden.has(name);
    path.robot.visible = !!pose && !hidden && !moment.off.has("robots");
    path.mesh.visible = !hidden;
    const i = moment.known[name];
    let n = 0, hi = path.ends.length;
    while (n < hi) {
      const mid = (n + hi) >> 1;
      if (path.ends[mid] <= i) n = mid + 1;
      else hi = mid;
    }
    path.mesh.geometry.setDrawRange(0, 6 * n);
    path.mesh.material.color.set(name === "truth" ? (moment.dark ? "#ffffff" : "#111111") : path.mesh.material.color);
    if (!pose) return;
    path.robot.position.set(pose.p[0], pose.p[1], pose.p[2] - this.base + (name === "truth" ? 0.12 : 0.09));
    path.robot.rotation.z = Plumb.data.yawOf(pose.q);
  }

  get pointSize() { return 3 * this.renderer.getPixelRatio(); }

  resize(width, height) {
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio || 1));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.size = [width, height];
  }

  /** Where a point of the scene is in the picture, px, or null behind the camera. */
  project(p) {
    const v = new THREE.Vector3(...p).project(this.camera);
    if (v.z > 1 || Math.abs(v.x) > 1.2 || Math.abs(v.y) > 1.2) return null;
    return [(0.5 + 0.5 * v.x) * this.size[0], (0.5 - 0.5 * v.y) * this.size[1]];
  }

  placeLabels(moment) { Plumb.placeLabels(this.labels, moment, (p) => this.project(p)); }

  /** Id of the element under a place of the picture, or null. */
  pick(x, y, moment) {
    const ray = new THREE.Raycaster(), cut = moment.floor + 1.2;
    ray.setFromCamera(new THREE.Vector2((2 * x) / this.size[0] - 1, 1 - (2 * y) / this.size[1]), this.camera);
    const { origin: o, direction: d } = ray.ray, along = (cut - o.z) / d.z;
    // Walls are hollow where they are cut: there the ray would go through.
    const top = along > 0 ? [o.x + along * d.x, o.y + along * d.y] : null;
    const pixel = (2 * along * Math.tan((this.camera.fov * Math.PI) / 360)) / this.size[1];
    const near = (reach) => {
      let best = null, least = reach;
      for (const f of top ? this.data.faces : []) {
        const apart = f.s === moment.storey ? Plumb.Residuals.prototype.toFace(f, ...top) : reach;
        if (apart < least) [best, least] = [f.wall, apart];
      }
      return best;
    };
    const hit = ray.intersectObject(this.building, false).find((h) => h.point.z <= cut + 1e-6);
    const element = hit && hit.point.z >= moment.floor - 0.3 ? this.data.scene.elements.find((e) => hit.faceIndex >= e[3] && hit.faceIndex < e[3] + e[4]) : null;
    return near(3 * pixel) || (element && element[1] !== "slab" ? element[0] : near(8 * pixel));
  }

  camera6() {
    const round = (v) => Math.round(100 * v) / 100;
    return [...this.camera.position.toArray(), ...this.controls.target.toArray()].map(round);
  }

  setCamera6(values) {
    this.placed = true;
    this.camera.position.set(values[0], values[1], values[2]);
    this.controls.target.set(values[3], values[4], values[5]);
    this.controls.update();
  }

  onMove(callback) { this.controls.addEventListener("change", callback); }
};
