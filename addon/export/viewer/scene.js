// Scene of the viewer page: loading, materials that burn with time, levels of detail, and lines. Uses three.js (THREE).
"use strict";

const MOST_PAST = 16; // earlier fronts
const BRIGHT = 1.9; // factor of leaves, by eye: light shines through them
const GLOW = 600; // s for which reached ground and trees glow
const BURNED = `
  float age = uTime - vArrival;
  float burned = smoothstep(0.0, 60.0, age);
  float glow = step(0.0, age) * (1.0 - smoothstep(0.0, ${GLOW}.0, age));`;

/** Decode the text of the scene element: base64 of a compressed .glb. */
async function decodeScene(text) {
  const packed = atob(text);
  const bytes = new Uint8Array(packed.length);
  for (let i = 0; i < packed.length; i++) bytes[i] = packed.charCodeAt(i);
  const plain = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(plain).arrayBuffer();
}

/** Load the scene and return its parts; `time` is a uniform with the model time in s after the run's start. */
async function loadScene(text, time) {
  const gltf = await new THREE.GLTFLoader().parseAsync(await decodeScene(text), "");
  const named = (name) => gltf.scene.getObjectByName(name);
  const found = {
    gltf, about: gltf.scene.userData.firetwin, cameras: gltf.cameras, terrain: named("terrain"), cells: [], coarsest: {},
    fronts: (named("fronts")?.children ?? []).slice(), places: (named("places")?.children ?? []).slice(),
  };
  if (found.terrain) found.terrain.material = await groundMaterial(gltf, found.terrain.material, time);
  addForest(found, time);
  addLines(found);
  return found;
}

/** Ground that turns black where the picture of arrival times says so, with a smooth border between pixels. */
async function groundMaterial(gltf, plain, time) {
  const arrival = plain.userData.arrival;
  const made = new THREE.MeshLambertMaterial({ map: plain.map });
  if (!arrival) return made;
  const picture = await gltf.parser.getDependency("texture", arrival.texture);
  picture.magFilter = picture.minFilter = THREE.NearestFilter;
  picture.generateMipmaps = false;
  picture.needsUpdate = true;
  made.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, { uTime: time, uArrival: { value: picture } });
    shader.fragmentShader = shader.fragmentShader
      .replace("#include <common>", `#include <common>
        uniform float uTime; uniform sampler2D uArrival;
        vec2 fire(ivec2 at, ivec2 size) {
          vec4 texel = texelFetch(uArrival, clamp(at, ivec2(0), size - 1), 0) * 255.0;
          float count = floor(texel.r + 0.5) * 256.0 + floor(texel.g + 0.5);
          float age = uTime - count * ${arrival.step_s.toFixed(9)};
          float reached = count < ${arrival.never}.0 && age >= 0.0 ? 1.0 : 0.0;
          return vec2(reached, reached * (1.0 - smoothstep(0.0, ${GLOW}.0, age)));
        }`)
      .replace("#include <map_fragment>", `#include <map_fragment>
        ivec2 size = textureSize(uArrival, 0);
        vec2 place = vMapUv * vec2(size) - 0.5, share = fract(place);
        ivec2 low = ivec2(floor(place));
        vec2 state = mix(mix(fire(low, size), fire(low + ivec2(1, 0), size), share.x),
                         mix(fire(low + ivec2(0, 1), size), fire(low + ivec2(1, 1), size), share.x), share.y);
        diffuseColor.rgb = mix(diffuseColor.rgb, vec3(0.022, 0.020, 0.019), smoothstep(0.35, 0.65, state.x));`)
      .replace("#include <emissivemap_fragment>", `#include <emissivemap_fragment>
        totalEmissiveRadiance += vec3(0.9, 0.16, 0.015) * state.y;`);
  };
  return made;
}

/** Plants that glow when the fire arrives, and then are black and bare. */
function plantMaterial(plain, time) {
  const leaves = plain.name === "foliage" || plain.name === "grass";
  const made = new THREE.MeshLambertMaterial({ vertexColors: true, side: plain.side, name: plain.name });
  if (leaves) made.color.setScalar(BRIGHT);
  made.onBeforeCompile = (shader) => {
    shader.uniforms.uTime = time;
    shader.vertexShader = shader.vertexShader
      .replace("#include <common>", "#include <common>\nuniform float uTime; attribute float _ARRIVAL; varying float vArrival;")
      .replace("#include <begin_vertex>", `#include <begin_vertex>
        vArrival = _ARRIVAL;
        ${leaves ? "transformed.xz *= mix(1.0, 0.3, smoothstep(0.0, 300.0, uTime - _ARRIVAL));" : ""}`);
    shader.fragmentShader = shader.fragmentShader
      .replace("#include <common>", "#include <common>\nuniform float uTime; varying float vArrival;")
      .replace("#include <color_fragment>", `#include <color_fragment>${BURNED}
        diffuseColor.rgb = mix(diffuseColor.rgb, vec3(0.020, 0.018, 0.017), burned);`)
      .replace("#include <emissivemap_fragment>", `#include <emissivemap_fragment>
        totalEmissiveRadiance += vec3(1.0, 0.22, 0.02) * glow${leaves ? "" : " * 0.3"};`);
  };
  made.customProgramCacheKey = () => (leaves ? "leaves" : "wood");
  return made;
}

/** Give every instanced mesh a coarse twin of the same plants, and note where both are. */
function addForest(found, time) {
  const made = new Map(), meshes = [];
  found.gltf.scene.traverse((each) => { if (each.isInstancedMesh) meshes.push(each); });
  for (const mesh of meshes) {
    if (!made.has(mesh.material.name)) made.set(mesh.material.name, plantMaterial(mesh.material, time));
    mesh.material = made.get(mesh.material.name);
    const about = mesh.userData, model = `${about.model} ${mesh.material.name}`;
    const known = found.coarsest[model];
    if (!known || about.level > known.level) found.coarsest[model] = { level: about.level, geometry: mesh.geometry };
    mesh.computeBoundingSphere();
    found.cells.push({ mesh, model, level: about.level, count: mesh.count, sphere: mesh.boundingSphere });
  }
  for (const cell of found.cells) addTwin(cell, found.coarsest[cell.model]);
}

function addTwin(cell, coarse) {
  if (coarse.level <= cell.level) return;
  const geometry = coarse.geometry.clone();
  geometry.setAttribute("_ARRIVAL", cell.mesh.geometry.getAttribute("_ARRIVAL"));
  cell.twin = new THREE.InstancedMesh(geometry, cell.mesh.material, 0);
  cell.twin.instanceMatrix = cell.mesh.instanceMatrix;
  cell.twin.boundingSphere = cell.sphere;
  cell.mesh.parent.add(cell.twin);
}

/** Choose level and number of the plants of each cell, by distance and a quality from 0 to 1. */
function thinForest(cells, eye, quality) {
  for (const cell of cells) {
    const away = Math.max(eye.distanceTo(cell.sphere.center) - cell.sphere.radius, 0);
    const near = away < 500 && quality > 0.6;
    const share = Math.min(1, quality * (away < 4000 ? 1 : Math.max(4000 / away, 0.3)));
    const count = Math.ceil(cell.count * share);
    const drawn = near || !cell.twin ? cell.mesh : cell.twin;
    for (const each of [cell.mesh, cell.twin]) {
      if (!each) continue;
      each.visible = each === drawn;
      each.count = count;
    }
  }
}

function addLines(found) {
  const past = new THREE.LineBasicMaterial({ color: 0xb3361f, transparent: true, opacity: 0.35, depthWrite: false });
  const now = new THREE.LineBasicMaterial({ color: 0xffcf3f });
  for (const front of found.fronts) front.position.y = 12; // m above the ground, as the drawn terrain is coarser
  found.fronts.sort((a, b) => a.userData.time_s - b.userData.time_s);
  let drawn = -Infinity;
  for (const front of found.fronts) {
    front.old = front.userData.time_s - drawn >= found.about.end_s / MOST_PAST;
    if (front.old) drawn = front.userData.time_s;
  }
  found.drawFronts = (time) => {
    const last = found.fronts.findLast((each) => each.userData.time_s <= time);
    for (const each of found.fronts) {
      each.material = each === last ? now : past;
      each.visible = each === last || (each.old && each.userData.time_s < time);
    }
    return last?.userData ?? null;
  };
}
