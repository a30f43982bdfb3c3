// The robot in space, drawn by three.js: its links at a chosen row, what each row still misses, and how
// well the end position is known where.

const CIVIDIS = [[0, 34, 78], [53, 69, 108], [102, 105, 112], [148, 142, 119], [200, 184, 102], [254, 232, 56]];

function cividis(share) {
  const at = Math.min(0.9999, Math.max(0, share)) * (CIVIDIS.length - 1), i = Math.floor(at), f = at - i;
  return CIVIDIS[i].map((low, c) => Math.round(low + f * (CIVIDIS[i + 1][c] - low)));
}

function cividis_bar() {
  const bar = element("span", {class: "scale"});
  const stops = CIVIDIS.map(rgb => "rgb(" + rgb.join(",") + ")");
  bar.style.background = "linear-gradient(90deg," + stops.join(",") + ")";
  return bar;
}

// 1, 2 or 5 times a power of ten, at most `value`.
function round_down(value) {
  const power = Math.pow(10, Math.floor(Math.log10(value)));
  return [5, 2, 1].find(digit => digit * power <= value * 1.0001) * power;
}

function quantile(values, share) {
  const sorted = values.filter(known).sort((a, b) => a - b);
  return sorted.length ? sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))] : 0;
}

function length_of(v) { return Math.hypot(v[0], v[1], v[2]); }

function bounds_of(points) {
  const box = new THREE.Box3();
  for (const p of points) if (p.every(known)) box.expandByPoint(new THREE.Vector3(...p));
  return box;
}

function rod(a, b, radius, material) {
  const from = new THREE.Vector3(...a), to = new THREE.Vector3(...b), along = to.clone().sub(from);
  if (along.length() < 1e-9) return null;
  const mesh = new THREE.Mesh(new THREE.CylinderBufferGeometry(radius, radius, along.length(), 12), material);
  mesh.position.copy(from).addScaledVector(along, 0.5);
  mesh.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), along.normalize());
  return mesh;
}

function ball(at, radius, material) {
  const mesh = new THREE.Mesh(new THREE.SphereBufferGeometry(radius, 16, 12), material);
  mesh.position.set(...at);
  return mesh;
}

function robot_mesh(lines, size) {
  const group = new THREE.Group();
  const link = new THREE.MeshLambertMaterial({color: colour("soft")});
  const joint = new THREE.MeshLambertMaterial({color: colour("ink")});
  for (const line of lines) {
    line.points.forEach((point, i) => {
      const part = i > 0 ? rod(line.points[i - 1], point, 0.009 * size, link) : null;
      if (part) group.add(part);
      group.add(ball(point, 0.014 * size, joint));
    });
  }
  return group;
}

function vectors_mesh(rows, ways, scale, name) {
  const corners = [];
  rows.at.forEach((at, i) => {
    const way = ways[i];
    if (!at.every(known) || !way.every(known) || length_of(way) === 0) return;
    corners.push(...at, ...at.map((each, c) => each + scale * way[c]));
  });
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(corners, 3));
  return new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({color: colour(name)}));
}

function rows_mesh(rows, size) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(
    rows.at.filter(at => at.every(known)).flat(), 3));
  return new THREE.Points(geometry, new THREE.PointsMaterial({color: colour("ink"), size: 0.008 * size}));
}

function cells_mesh(cells, least, most, size) {
  const group = new THREE.Group();
  for (const cell of cells) {
    const rgb = cividis((cell.value - least) / (most - least || 1));
    const material = new THREE.MeshBasicMaterial({color: "rgb(" + rgb.join(",") + ")", transparent: true, opacity: 0.75});
    group.add(ball(cell.center, cell.radius || 0.025 * size, material));
  }
  return group;
}

function switch_for(title, name, object, update) {
  const box = element("input", {type: "checkbox"});
  box.checked = object.visible;
  box.addEventListener("change", () => { object.visible = box.checked; update(); });
  const label = element("label", {}, box, " " + title);
  if (name) label.style.color = "var(--" + name + ")";
  return label;
}

function row_slider(picture, show) {
  if (picture.rows.length < 2) return null;
  const slider = element("input", {type: "range", min: 0, max: picture.rows.length - 1, value: 0,
                                   "aria-label": "row whose pose is shown"});
  const text = element("span", {}, "robot at row " + picture.rows[0]);
  slider.addEventListener("input", () => {
    text.textContent = "robot at row " + picture.rows[slider.value];
    show(Number(slider.value));
  });
  return element("label", {}, slider, " ", text);
}

// Everything of a 3D view; null where there is nothing to show or no WebGL. cells: {center, value, radius?}.
function view3d({picture, rows, cells, cells_title, cells_text}) {
  const points = [...(rows ? rows.at : []), ...(cells || []).map(cell => cell.center),
                  ...(picture ? picture.poses.flatMap(pose => pose.flatMap(line => line.points)) : [])];
  const box = bounds_of(points);
  if (points.length === 0 || box.isEmpty()) return null;
  let renderer;
  try {
    renderer = new THREE.WebGLRenderer({antialias: true, alpha: true, preserveDrawingBuffer: true});
  } catch (error) {
    return paragraph("The 3D view needs WebGL, which this browser does not give.", "soft");
  }
  const size = Math.max(1e-3, box.getSize(new THREE.Vector3()).length()), center = box.getCenter(new THREE.Vector3());
  const holder = element("div", {class: "view"}, renderer.domElement);
  const camera = new THREE.PerspectiveCamera(40, 1, size / 100, 20 * size);
  camera.up.set(0, 0, 1);
  camera.position.copy(center).add(new THREE.Vector3(0.75, -1, 0.55).normalize().multiplyScalar(1.35 * size));
  const turning = new THREE.OrbitControls(camera, renderer.domElement);
  turning.target.copy(center);
  turning.enableZoom = true;
  turning.update();
  let scene, pose = 0, robot = null;
  const hidden = new Set();
  const update = () => renderer.render(scene, camera);
  const reach = rows ? quantile(rows.way_before.map(length_of), 0.95) : 0;  // none of rows that have angles alone
  const scale = reach > 0 ? round_down(0.12 * size / reach) : 0;
  const layers = [];
  const values = (cells || []).map(cell => cell.value);
  const least = Math.min(...values), most = Math.max(...values);
  function build() {
    scene = new THREE.Scene();
    scene.add(new THREE.HemisphereLight(0xffffff, 0x777777, 1.1));
    const floor = new THREE.GridHelper(2 * round_down(size), 20, colour("line"), colour("line"));
    floor.rotation.x = Math.PI / 2;
    floor.position.set(center.x, center.y, Math.min(0, box.min.z));
    scene.add(floor);
    robot = picture && picture.poses.length ? robot_mesh(picture.poses[pose], size) : null;
    if (robot) scene.add(robot);
    layers.length = 0;
    if (scale) {
      layers.push(["what rows miss before", "before", vectors_mesh(rows, rows.way_before, scale, "before")]);
      layers.push(["after", "after", vectors_mesh(rows, rows.way_after, scale, "after")]);
    }
    if (rows) scene.add(rows_mesh(rows, size));
    if (cells && cells.length) layers.push([cells_title, "", cells_mesh(cells, least, most, size)]);
    for (const [title, , object] of layers) {
      object.visible = !hidden.has(title);
      scene.add(object);
    }
  }
  build();
  const fit = () => {
    if (holder.clientWidth === 0) return;
    renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    renderer.setSize(holder.clientWidth, holder.clientHeight);
    camera.aspect = holder.clientWidth / holder.clientHeight;
    camera.updateProjectionMatrix();
    update();
  };
  turning.addEventListener("change", update);
  new ResizeObserver(fit).observe(holder);
  drawn.views.push(() => { build(); fit(); });
  const controls = element("div", {class: "controls"},
    layers.map(([title, name]) => {
      const box_for = switch_for(title, name, {get visible() { return !hidden.has(title); },
        set visible(on) { on ? hidden.delete(title) : hidden.add(title); }}, () => { build(); update(); });
      return box_for;
    }),
    picture ? row_slider(picture, chosen => { pose = chosen; build(); update(); }) : null);
  const words = ["Drag to turn, pinch or roll to come closer."];
  if (scale) words.push("Lines lead from the tool to where the row says it was, " + figure(scale) + " times enlarged.");
  const legend = cells && cells.length && cells_text
    ? element("p", {class: "soft"}, cells_text(least)[0], cividis_bar(), cells_text(most)[1]) : null;
  return element("figure", {}, holder, controls, legend, element("figcaption", {}, words.join(" ")));
}

drawn.views = [];
