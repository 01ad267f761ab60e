// SPDX-License-Identifier: Apache-2.0
// What the replay page uses of three.js, as the global THREE.
import {
  BufferAttribute, BufferGeometry, ColorManagement, DoubleSide, Group, LinearSRGBColorSpace, LineBasicMaterial, LineSegments, Mesh,
  MeshBasicMaterial, PerspectiveCamera, Points, Raycaster, Scene, ShaderMaterial, Vector2, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

globalThis.THREE = {
  BufferAttribute, BufferGeometry, ColorManagement, DoubleSide, Group, LinearSRGBColorSpace, LineBasicMaterial, LineSegments, Mesh,
  MeshBasicMaterial, OrbitControls, PerspectiveCamera, Points, Raycaster, Scene, ShaderMaterial, Vector2, Vector3, WebGLRenderer,
};
