// Script of the briefing page: map, time, lists, themes and keys. Texts of files are inserted by textContent only.
"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const find = (id) => document.getElementById(id);
  const all = (query, root = document) => [...root.querySelectorAll(query)];
  const map = drawMap();
  const layers = addLayers();
  const points = addPoints();
  const time = addTime();
  addFilters();
  addTheme();
  addKeys();
  addPrint();
  addPosters();
  addScrolling();

  function drawMap() {
    document.documentElement.classList.add("js");
    for (const id of ["map", "time", "theme", "print"]) find(id).hidden = false;
    const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    const motion = { zoomAnimation: !still, fadeAnimation: !still, markerZoomAnimation: !still, inertia: !still };
    const made = L.map("map", { ...motion, zoomSnap: 0.25, maxZoom: 16, minZoom: 2, maxBoundsViscosity: 0.6 });
    made.attributionControl.setPrefix('<a href="https://leafletjs.com" rel="noopener noreferrer">Leaflet</a>');
    const credit = document.createElement("span");
    credit.textContent = data.credit;
    made.attributionControl.addAttribution(credit.innerHTML);
    L.control.scale().addTo(made);
    made.fitBounds(data.view);
    made.setMaxBounds(L.latLngBounds(data.bounds).pad(0.5));
    made.createPane("context").style.zIndex = 405;
    made.createPane("fronts").style.zIndex = 410;
    made.createPane("towns").style.zIndex = 420;
    addMarks();
    return made;
  }

  function addMarks() {
    if (!data.marks.length) return;
    const box = document.createElement("div");
    box.className = "map-mark";
    box.setAttribute("aria-hidden", "true");
    for (const word of data.marks) {
      const line = document.createElement("span");
      line.textContent = word;
      box.append(line);
    }
    find("map").append(box);
  }

  function addLayers() {
    const made = {};
    for (const box of all(".layer[data-layer]")) {
      const name = box.dataset.layer;
      const picture = document.querySelector(`#pictures img[data-layer="${name}"]`);
      const own = data.overlays[name];
      if (picture) {
        const copy = picture.cloneNode();
        copy.removeAttribute("data-layer");
        copy.classList.add(name === "hillshade" ? "shade" : "crisp");
        made[name] = L.imageOverlay(copy, own.bounds, { opacity: own.opacity, zIndex: own.order });
      } else {
        made[name] = L.layerGroup(data.context[name] ? data.context[name].flatMap(shapes) : []);
      }
      const [check, range] = all("input", box);
      const show = () => {
        box.classList.toggle("off", !check.checked);
        check.checked ? made[name].addTo(map) : made[name].remove();
      };
      check.addEventListener("change", show);
      if (range) range.addEventListener("input", () => made[name].setOpacity(range.value / 100));
      show();
    }
    return made;
  }

  function shapes(feature) {
    const style = {
      pane: "context", color: feature.colour, weight: feature.weight, dashArray: feature.dashes || null, lineCap: "butt",
    };
    const white = { ...style, color: "#fff", weight: feature.weight + 2, dashArray: null, opacity: 0.85, fill: false, interactive: false };
    const fill = { fill: feature.fill > 0, fillColor: feature.colour, fillOpacity: feature.fill };
    const symbol = () => L.divIcon({
      className: "symbol", iconSize: [20, 20], html: `<svg viewBox="-1 -1 2 2" aria-hidden="true">${data.symbols[feature.symbol]}</svg>`,
    });
    const casing = (shape) => (feature.casing ? [shape(white)] : []);
    const line = (points) => (more) => L.polyline(points, more);
    const area = (rings) => (more) => L.polygon(rings, more);
    const made = [...feature.lines.map(line), ...feature.polygons.map(area)].flatMap((shape) => [
      ...casing(shape), shape({ ...style, ...(feature.polygons.length ? fill : {}) }),
    ]);
    made.push(...feature.points.map((at) => L.marker(at, { icon: symbol(), keyboard: false, pane: "context" })));
    for (const each of made) if (each.options.interactive) each.bindTooltip(label(feature.text), { sticky: true });
    return made;
  }

  function addPoints() {
    const made = new Map();
    for (const point of data.points) {
      const station = point.kind === "station";
      const dot = L.circleMarker([point.latitude, point.longitude], {
        radius: station ? 7 : 3.5, weight: 2, color: "#111", fillColor: "#fff", fillOpacity: 1, pane: "towns",
        dashArray: point.exercise ? "3 2" : null,
      }).addTo(map);
      dot.bindTooltip(station ? () => tip(point) : label(point.name), station ? { direction: "top" } : {
        permanent: true, direction: "right", className: "town", offset: [2, 0],
      });
      dot.on("click", () => select(point.id, false));
      const skip = () => dot.getElement().setAttribute("tabindex", "-1"); // Tab reaches the same places in the list
      dot.on("add", skip);
      skip();
      made.set(point.id, { point, dot, row: document.querySelector(`[data-id="${point.id}"]`) });
    }
    for (const button of all("button.name")) {
      button.addEventListener("click", () => select(button.closest("[data-id]").dataset.id, true));
    }
    return made;
  }

  function label(text) {
    const made = document.createElement("span");
    made.textContent = text;
    return made;
  }

  function tip(point) {
    const box = document.createElement("div");
    const name = document.createElement("b");
    name.textContent = point.name;
    const when = document.createElement("div");
    when.textContent = `Fire: ${point.text}`;
    box.append(name, when);
    if (point.exercise) {
      const mark = document.createElement("div");
      mark.textContent = "exercise";
      box.append(mark);
    }
    return box;
  }

  function select(id, fromList) {
    for (const row of all("tr.selected")) row.classList.remove("selected");
    const chosen = points.get(id);
    if (!chosen) return;
    if (chosen.row) {
      const row = chosen.row.matches("tr") ? chosen.row : chosen.row.querySelector("tr");
      row.classList.add("selected");
      if (!fromList && !chosen.row.hidden) row.scrollIntoView({ block: "nearest" });
    }
    if (fromList) {
      map.setView(chosen.dot.getLatLng(), Math.max(map.getZoom(), 11), { animate: map.options.zoomAnimation });
      chosen.dot.openTooltip();
      find("map").scrollIntoView({ block: "nearest" });
    }
  }

  function addTime() {
    const slider = find("slider"), play = find("play"), clock = find("clock"), cursor = find("cursor");
    const drawn = [];
    let shown = null, timer = 0, seen = null;
    const front = (index) => {
      if (!drawn[index]) {
        const rings = data.fronts.features[index].geometry.coordinates.map((ring) => ring.map(([x, y]) => [y, x]));
        drawn[index] = L.polygon(rings, {
          pane: "fronts", className: "front", color: data.front.edge, weight: 2, fillColor: data.front.fill, fillOpacity: 0.22,
          smoothFactor: 0.6, interactive: false,
        });
      }
      return drawn[index];
    };
    const observed = (moment) => {
      if (!data.observed || !layers.observed) return;
      const last = data.observed.features.filter((each) => Date.parse(each.properties.time) <= moment).pop();
      if (last === seen) return;
      seen = last;
      layers.observed.clearLayers();
      if (last) {
        layers.observed.addLayer(L.geoJSON(last, {
          pane: "fronts", interactive: false, style: { color: data.front.observed, weight: 2, dashArray: "6 4", fill: false },
        }));
      }
    };
    const show = () => {
      const index = Number(slider.value), step = data.times[index], moment = Date.parse(step.utc);
      if (shown) shown.remove();
      shown = front(index);
      layers.front ? layers.front.clearLayers().addLayer(shown) : shown.addTo(map);
      const local = document.createElement("b");
      local.textContent = step.local;
      clock.replaceChildren(local, ` = ${step.utc_text}; burned ${step.area}`);
      slider.setAttribute("aria-valuetext", `${step.local}, burned ${step.area}`);
      for (const end of ["x1", "x2"]) cursor.setAttribute(end, step.x);
      for (const { point, dot, row } of points.values()) {
        const burned = point.state === "before" || (point.state === "reached" && Date.parse(point.time) <= moment);
        dot.setStyle({ fillColor: burned ? "#e02b12" : point.kind === "station" ? "#ffffff" : "#222222" });
        if (row) row.classList.toggle("burned", burned);
      }
      observed(moment);
      document.dispatchEvent(new Event("timechange"));
    };
    const stop = () => {
      clearInterval(timer);
      timer = 0;
      play.setAttribute("aria-pressed", "false");
      play.querySelector("span").textContent = "\u25b6";
      play.querySelector(".word").textContent = "Play";
    };
    const move = (index) => {
      slider.value = Math.max(0, Math.min(index, data.times.length - 1));
      show();
    };
    const start = () => {
      if (Number(slider.value) >= data.times.length - 1) move(0);
      play.setAttribute("aria-pressed", "true");
      play.querySelector("span").textContent = "\u25a0";
      play.querySelector(".word").textContent = "Stop";
      timer = setInterval(() => {
        move(Number(slider.value) + 1);
        if (Number(slider.value) >= data.times.length - 1) stop();
      }, data.step_ms);
    };
    play.addEventListener("click", () => (timer ? stop() : start()));
    slider.addEventListener("input", show);
    show();
    return { step: (by) => move(Number(slider.value) + by), toggle: () => play.click(), playing: () => timer !== 0, stop };
  }

  function addFilters() {
    const search = find("search"), count = find("count");
    if (!search) return;
    const choices = all(".filters select");
    const groups = all("[data-id]");
    const texts = new Map(groups.map((group) => [group, plain(group.textContent)]));
    const filter = () => {
      const words = plain(search.value).split(/\s+/).filter(Boolean);
      let left = 0;
      for (const group of groups) {
        const fits = words.every((word) => texts.get(group).includes(word))
          && choices.every((choice) => !choice.value || agrees(group, choice.name, choice.value));
        group.hidden = !fits;
        left += fits;
        const known = points.get(group.dataset.id);
        if (known) fits ? known.dot.addTo(map) : known.dot.remove();
      }
      count.textContent = `${left} of ${groups.length} shown`;
    };
    search.addEventListener("input", filter);
    for (const choice of choices) choice.addEventListener("change", filter);
    document.addEventListener("timechange", () => {
      if (choices.some((choice) => choice.name === "fire" && choice.value === "now")) filter();
    });
    filter();
  }

  function plain(text) {
    return text.normalize("NFKD").replace(/[\u0300-\u036f]/g, "").toLowerCase();
  }

  function agrees(group, name, value) {
    if (name === "fire" && value === "now") return group.classList.contains("burned");
    return (group.dataset[name] || "").split("|").includes(value);
  }

  function addTheme() {
    const button = find("theme"), root = document.documentElement, system = matchMedia("(prefers-color-scheme: dark)");
    const dark = () => (root.dataset.theme ? root.dataset.theme === "dark" : system.matches);
    const name = () => {
      button.textContent = dark() ? "Light" : "Dark";
      button.setAttribute("aria-label", `${button.textContent} colours`);
    };
    button.addEventListener("click", () => {
      root.dataset.theme = dark() ? "light" : "dark";
      name();
    });
    system.addEventListener("change", name);
    name();
  }

  function addKeys() {
    const search = find("search");
    document.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.altKey || event.metaKey || event.defaultPrevented) return;
      const at = event.target;
      if (event.key === "Escape") {
        if (time.playing()) return time.stop();
        for (const { dot } of points.values()) if (!dot.getTooltip().options.permanent) dot.closeTooltip();
        if (at === search && search.value) {
          search.value = "";
          search.dispatchEvent(new Event("input"));
        } else if (at !== document.body) at.blur();
        return;
      }
      if (at.matches("input:not([type=checkbox]), select, video") || at.matches(".wide") || find("map").contains(at)) return;
      const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (step) time.step(step);
      else if (event.key === "/" && search) {
        search.focus();
        search.select();
      } else if (event.key === " " && !at.matches("button, a, input")) time.toggle();
      else return;
      event.preventDefault();
    });
  }

  function addPosters() {
    for (const clip of all("video")) {
      const frame = all(".gallery img").find((each) => each.dataset.view === clip.dataset.view);
      if (frame) clip.poster = frame.src;
    }
  }

  // Tables wider than the window scroll with the arrow keys, so they take the focus.
  function addScrolling() {
    const boxes = all(".wide");
    const check = () => {
      for (const box of boxes) {
        const scrolls = box.scrollWidth > box.clientWidth;
        for (const name of ["tabindex", "role", "aria-label"]) box.removeAttribute(name);
        if (!scrolls) continue;
        const title = box.querySelector("caption") || box.closest("section").querySelector("h2");
        box.setAttribute("tabindex", "0");
        box.setAttribute("role", "region");
        box.setAttribute("aria-label", `Table: ${title.textContent}, ${boxes.indexOf(box) + 1}`);
      }
    };
    addEventListener("resize", check);
    check();
  }

  function addPrint() {
    find("print").addEventListener("click", () => window.print());
    const folded = all("details:not([open])");
    addEventListener("beforeprint", () => folded.forEach((each) => (each.open = true)));
    addEventListener("afterprint", () => folded.forEach((each) => (each.open = false)));
  }
})();
