// Script of the viewer page: time, views, keys and labels. Texts of files are inserted by textContent only.
"use strict";
(() => {
  const find = (id) => document.getElementById(id);
  const still = matchMedia("(prefers-reduced-motion: reduce)");
  const RUN_MS = 24000; // duration of the whole run when it plays
  const LEAST = 0.01; // share of the plants that are drawn at least
  const canvas = find("view"), time = { value: 0 };
  let world, renderer, scene, camera, orbit, mixer, zone;
  let playing = null; // { camera: entry or null, from: model or film time, since: ms }
  let active = null; // entry of the camera whose view is shown
  let entries = [], quality = 0.1, finer = 0, dirty = true, last = 0, moved = 0;

  start().catch((error) => say(`The scene cannot be shown: ${error.message}`));

  async function start() {
    renderer = newRenderer();
    const holder = find("scene"), text = holder.textContent;
    holder.remove();
    world = await loadScene(text.trim(), time);
    zone = world.about.zone || "UTC";
    scene = makeScene();
    mixer = new THREE.AnimationMixer(world.gltf.scene);
    entries = world.cameras.map(cameraEntry);
    addControls();
    addKeys();
    addPlaces();
    showOverview();
    setTime(world.about.end_s);
    new ResizeObserver(resize).observe(find("stage"));
    resize();
    find("controls").hidden = false;
    say("");
    window.viewer = { world, renderer, draw, view: () => active?.name ?? "", time: () => time.value, quality: () => quality };
    requestAnimationFrame(tick);
  }

  function newRenderer() {
    const slow = isSoftware();
    const made = new THREE.WebGLRenderer({ canvas, antialias: !slow, powerPreference: "high-performance" });
    made.setPixelRatio(slow ? 0.6 : Math.min(devicePixelRatio, 2));
    if (slow) quality = LEAST;
    return made;
  }

  /** Whether the processor draws: no smooth edges then, fewer pixels and few plants. */
  function isSoftware() {
    const gl = document.createElement("canvas").getContext("webgl2");
    if (!gl) throw new Error("this browser has no WebGL 2");
    const info = gl.getExtension("WEBGL_debug_renderer_info");
    const name = String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
    gl.getExtension("WEBGL_lose_context")?.loseContext();
    return /swiftshader|llvmpipe|software|basic render/i.test(name);
  }

  function say(text) {
    find("message").textContent = text;
    if (text) document.documentElement.dataset.state = "message"; else document.documentElement.dataset.state = "ready";
  }

  function makeScene() {
    const made = new THREE.Scene();
    made.background = new THREE.Color(0xb9cbdc);
    made.fog = new THREE.Fog(0xb9cbdc, 15000, 140000);
    const sun = new THREE.DirectionalLight(0xfff1dc, 4.6);
    sun.position.set(-0.75, 0.55, 0.4);
    made.add(sun, new THREE.HemisphereLight(0xcfe0f2, 0x6a5f50, 1.5), world.gltf.scene);
    camera = new THREE.PerspectiveCamera(45, 1, 5, 400000);
    orbit = new THREE.OrbitControls(camera, canvas);
    orbit.maxPolarAngle = 1.52;
    orbit.minDistance = 30;
    orbit.maxDistance = 200000;
    orbit.addEventListener("change", () => { dirty = true; moved = performance.now(); });
    orbit.addEventListener("start", takeOver);
    return made;
  }

  function cameraEntry(own) {
    const clip = world.gltf.animations.find((each) => each.tracks[0].name.split(".")[0] === own.name) ?? null;
    return { own, clip, name: own.userData.name ?? own.name, yfov: own.userData.yfov ?? null, base: { aspect: own.aspect, fov: own.fov } };
  }

  // Time

  function setTime(value) {
    const end = world.about.end_s;
    time.value = Math.min(Math.max(value, 0), end);
    const front = world.drawFronts(time.value);
    const utc = new Date(Date.parse(world.about.start_utc) + 1000 * time.value);
    const words = `${clockText(utc, zone)} = ${clockText(utc, "UTC")}` + (front ? `; front of ${clockText(new Date(front.time_utc), zone)}` : "");
    find("clock").textContent = words;
    find("slider").value = String(Math.round(time.value));
    find("slider").setAttribute("aria-valuetext", words);
    if (active) pose(active, filmSeconds(active, time.value));
    dirty = true;
  }

  function clockText(utc, where) {
    const words = { timeZone: where, day: "2-digit", month: "short", year: "numeric", hour: "2-digit", minute: "2-digit", hourCycle: "h23", timeZoneName: "short" };
    const part = Object.fromEntries(new Intl.DateTimeFormat("en-US", words).formatToParts(utc).map((each) => [each.type, each.value]));
    return `${part.day} ${part.month} ${part.year} ${part.hour}:${part.minute} ${part.timeZoneName}`;
  }

  /** Film time (s after the first frame) of a model time, clamped to the film. */
  function filmSeconds(entry, value) {
    const { frame_times_s: times, frames, rate } = world.about;
    const low = times[0], high = times[times.length - 1];
    const share = high > low ? Math.min(Math.max((value - low) / (high - low), 0), 1) : 0;
    return (share * (frames[frames.length - 1] - frames[0])) / rate;
  }

  function modelTime(seconds) {
    const { frame_times_s: times, frames, rate } = world.about;
    const share = Math.min((seconds * rate) / Math.max(frames[frames.length - 1] - frames[0], 1), 1);
    return times[0] + share * (times[times.length - 1] - times[0]);
  }

  // Views

  function pose(entry, seconds) {
    if (entry.clip) {
      mixer.stopAllAction();
      mixer.clipAction(entry.clip).play();
      mixer.setTime(Math.min(seconds, entry.clip.duration - 1e-6));
    }
    entry.own.updateWorldMatrix(true, false);
    const rate = world.about.rate;
    if (entry.yfov) entry.base.fov = (entry.yfov[Math.min(Math.round(seconds * rate), entry.yfov.length - 1)] * 180) / Math.PI;
    fit(entry);
    dirty = true;
    moved = performance.now();
  }

  /** Fit a scene camera into the canvas: all of its picture stays visible. */
  function fit(entry) {
    const aspect = canvas.clientWidth / Math.max(canvas.clientHeight, 1), own = entry.own;
    if (own.isPerspectiveCamera) {
      const half = Math.tan((entry.base.fov * Math.PI) / 360), wide = Math.max(entry.base.aspect / aspect, 1);
      own.aspect = aspect;
      own.fov = (Math.atan(half * wide) * 360) / Math.PI;
    } else {
      entry.box ??= { x: own.right, y: own.top };
      const y = Math.max(entry.box.y, entry.box.x / aspect);
      Object.assign(own, { top: y, bottom: -y, left: -y * aspect, right: y * aspect });
    }
    own.updateProjectionMatrix();
  }

  function show(entry) {
    active = entry;
    orbit.enabled = !entry;
    for (const button of find("views").children) button.setAttribute("aria-pressed", String((button.entry ?? null) === entry));
    dirty = true;
  }

  function showOverview() {
    const box = world.fronts.length ? world.fronts[world.fronts.length - 1] : world.terrain;
    const ball = new THREE.Sphere(new THREE.Vector3(), 5000);
    if (box) {
      box.geometry.computeBoundingSphere();
      ball.copy(box.geometry.boundingSphere);
    }
    const wide = Math.max(1, 1.05 / Math.max(canvas.clientWidth / Math.max(canvas.clientHeight, 1), 0.2));
    orbit.target.copy(ball.center);
    camera.position.copy(ball.center).add(new THREE.Vector3(0, 0.62, 0.9).multiplyScalar(2.05 * wide * ball.radius));
    show(null);
    orbit.update();
  }

  function watch(entry) {
    stop();
    show(entry);
    const first = world.about.frame_times_s[0];
    const plays = entry.clip && !still.matches;
    setTime(plays ? first : Math.min(Math.max(time.value, first), modelTime(Infinity)));
    if (plays) play(entry);
  }

  /** Go on by hand from the view of a camera. */
  function takeOver() {
    if (playing?.entry) stop();
  }

  function leave() {
    if (!active) return;
    const own = active.own;
    own.getWorldPosition(camera.position);
    const ahead = own.getWorldDirection(new THREE.Vector3());
    const ground = orbit.target.y, fall = (ground - camera.position.y) / Math.min(ahead.y, -0.02);
    orbit.target.copy(camera.position).addScaledVector(ahead, Math.min(Math.max(fall, 200), 60000));
    stop();
    show(null);
    orbit.update();
  }

  // Playback

  function play(entry) {
    const from = entry ? 0 : time.value >= world.about.end_s - 1 ? 0 : time.value;
    playing = { entry, from, since: performance.now() };
    markPlaying();
  }

  function stop() {
    playing = null;
    markPlaying();
  }

  function markPlaying() {
    const on = Boolean(playing);
    find("play").setAttribute("aria-pressed", String(on));
    find("play").querySelector(".word").textContent = on ? "Stop" : "Play";
  }

  function advance(now) {
    if (!playing) return;
    const seconds = (now - playing.since) / 1000;
    if (playing.entry) {
      const end = playing.entry.clip.duration;
      setTime(modelTime(Math.min(seconds, end)));
      pose(playing.entry, Math.min(seconds, end));
      if (seconds >= end) stop();
    } else {
      const value = playing.from + (seconds * 1000 * world.about.end_s) / RUN_MS;
      setTime(value);
      if (value >= world.about.end_s) stop();
    }
  }

  // Drawing

  function tick(now) {
    requestAnimationFrame(tick);
    advance(now);
    if (!active) orbit.update();
    const moving = playing || now - moved < 300;
    if (moving && now - last < 2000) adapt(now - last);
    last = now;
    if (dirty) {
      finer = quality;
      dirty = false;
      draw(quality);
    } else if (!moving && finer < 1) refine();
  }

  /** Draw fewer plants when frames take long, and more when there is time. */
  function adapt(duration) {
    if (duration > 80) quality = Math.max(quality * 0.8, LEAST);
    else if (duration < 40) quality = Math.min(quality * 1.05, 1);
  }

  /** Draw the still view again with more plants, until all are drawn or a frame takes too long. */
  function refine() {
    const before = performance.now(), gl = renderer.getContext();
    finer = Math.min(1, 2 * finer);
    draw(finer);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4)); // waits for the frame
    if (performance.now() - before > 200) finer = 1;
  }

  function draw(share) {
    const own = active ? active.own : camera, eye = own.getWorldPosition(new THREE.Vector3());
    scene.fog.far = Math.max(140000, 3 * eye.y);
    scene.fog.near = Math.max(15000, 1.5 * eye.y);
    thinForest(world.cells, eye, share);
    renderer.render(scene, own);
    placeLabels(own);
  }

  function resize() {
    const { clientWidth: width, clientHeight: height } = find("stage");
    if (!width || !height) return;
    renderer.setSize(width, height, false);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    if (active) fit(active);
    dirty = true;
  }

  // Controls, keys and labels

  function addControls() {
    const slider = find("slider"), end = world.about.end_s;
    slider.max = String(Math.ceil(end));
    slider.step = String([1, 10, 60, 300, 600, 1800, 3600].find((step) => end / step <= 700) ?? 3600);
    slider.addEventListener("input", () => { stop(); setTime(Number(slider.value)); });
    find("play").addEventListener("click", () => (playing ? stop() : play(active?.clip ? active : null)));
    find("overview").addEventListener("click", () => { stop(); showOverview(); });
    for (const entry of entries) {
      const button = document.createElement("button");
      Object.assign(button, { type: "button", textContent: `Camera: ${entry.name}`, entry });
      button.setAttribute("aria-pressed", "false");
      button.addEventListener("click", () => watch(entry));
      find("views").append(button);
    }
    canvas.addEventListener("pointerdown", leave, true);
    canvas.addEventListener("wheel", leave, { capture: true, passive: true });
  }

  function addKeys() {
    const turns = { ArrowLeft: [-0.08, 0], ArrowRight: [0.08, 0], ArrowUp: [0, -0.06], ArrowDown: [0, 0.06] };
    canvas.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      if (event.key in turns) { leave(); turn(...turns[event.key]); }
      else if ("+=-".includes(event.key)) { leave(); zoom(event.key === "-" ? 1.2 : 1 / 1.2); }
      else if (event.key === "Home") { stop(); showOverview(); }
      else return;
      event.preventDefault();
    });
    document.addEventListener("keydown", (event) => { if (event.key === "Escape") stop(); });
  }

  function turn(around, down) {
    const arm = camera.position.clone().sub(orbit.target), flat = Math.hypot(arm.x, arm.z), reach = arm.length();
    const angle = Math.atan2(arm.x, arm.z) + around;
    const tilt = Math.min(Math.max(Math.atan2(flat, arm.y) + down, 0.02), orbit.maxPolarAngle);
    arm.set(Math.sin(tilt) * Math.sin(angle), Math.cos(tilt), Math.sin(tilt) * Math.cos(angle)).multiplyScalar(reach);
    camera.position.copy(orbit.target).add(arm);
    orbit.update();
  }

  function zoom(factor) {
    camera.position.sub(orbit.target).multiplyScalar(factor).add(orbit.target);
    orbit.update();
  }

  function addPlaces() {
    if (!world.places.length) return;
    find("places").replaceChildren();
    for (const place of world.places.slice(0, 200)) {
      const { title, kind, lines } = place.userData;
      const item = document.createElement("li");
      item.textContent = [`${title} (${kind})`, ...(lines ?? [])].join(", ");
      find("places").append(item);
      place.label = document.createElement("span");
      place.label.textContent = title;
      find("labels").append(place.label);
    }
  }

  function placeLabels(own) {
    const { clientWidth: width, clientHeight: height } = canvas, at = new THREE.Vector3();
    for (const place of world.places) {
      if (!place.label) continue;
      place.getWorldPosition(at).project(own);
      const inside = Math.abs(at.x) < 1 && Math.abs(at.y) < 1 && Math.abs(at.z) < 1;
      place.label.hidden = !inside;
      if (inside) place.label.style.transform = `translate(${((at.x + 1) * width) / 2}px, ${((1 - at.y) * height) / 2}px)`;
    }
  }
})();
