// SPDX-License-Identifier: Apache-2.0
// node measure.mjs FILE.ifc: what web-ifc finds in a file, as lines
//   count TYPE NUMBER
//   wall GLOBAL_ID VOLUME_M3
import { readFileSync } from "node:fs";
import * as webIfc from "web-ifc";

const counted = [
  "IFCBUILDINGSTOREY", "IFCCOLUMN", "IFCDOOR", "IFCOPENINGELEMENT", "IFCRELSPACEBOUNDARY", "IFCSLAB", "IFCSPACE",
  "IFCSTAIR", "IFCSTAIRFLIGHT", "IFCWALL", "IFCWINDOW",
];
const quietest = 6;

function signedVolume(api, model, placed) {
  const geometry = api.GetGeometry(model, placed.geometryExpressID);
  const vertices = api.GetVertexArray(geometry.GetVertexData(), geometry.GetVertexDataSize());
  const corners = api.GetIndexArray(geometry.GetIndexData(), geometry.GetIndexDataSize());
  const point = (i) => vertices.slice(6 * corners[i], 6 * corners[i] + 3); // position and normal
  const origin = corners.length > 0 ? point(0) : [0, 0, 0];
  let six = 0;
  for (let i = 0; i < corners.length; i += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => point(i + k).map((v, axis) => v - origin[axis]));
    six += a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  geometry.delete();
  return six / 6;
}

const api = new webIfc.IfcAPI();
await api.Init();
api.SetLogLevel(quietest);
const model = api.OpenModel(new Uint8Array(readFileSync(process.argv[2])));
for (const type of counted) {
  console.log("count", type, api.GetLineIDsWithType(model, webIfc[type]).size());
}
api.StreamAllMeshesWithTypes(model, [webIfc.IFCWALL], (mesh) => {
  let volume = 0;
  for (let i = 0; i < mesh.geometries.size(); ++i) volume += signedVolume(api, model, mesh.geometries.get(i));
  console.log("wall", api.GetLine(model, mesh.expressID).GlobalId.value, volume);
});
api.CloseModel(model);
