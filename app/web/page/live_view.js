// The robot in its cell, live: lines at the last readings, surfaces, and the touches as they come.

function surface_mesh(surface) {
  const [x, y, z] = surface.center, radius = surface.radius || 0.1;
  const material = new THREE.MeshBasicMaterial({color: colour("after"), transparent: true, opacity: 0.13, side: THREE.DoubleSide,
                                                depthWrite: false});
  const disc = new THREE.Mesh(new THREE.CircleBufferGeometry(radius, 48), material);
  const edge = new THREE.LineLoop(new THREE.BufferGeometry().setFromPoints([...Array(48).keys()].map(i =>
    new THREE.Vector3(radius * Math.cos(i * Math.PI / 24), radius * Math.sin(i * Math.PI / 24), 0))),
    new THREE.LineBasicMaterial({color: colour("after")}));
  const group = new THREE.Group();
  group.add(disc, edge);
  group.position.set(x, y, z);
  group.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), new THREE.Vector3(...surface.normal).normalize());
  return group;
}

function touches_mesh(touches, name, pixels) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(touches.flatMap(touch => touch.at), 3));
  return new THREE.Points(geometry, new THREE.PointsMaterial({color: colour(name), size: pixels, sizeAttenuation: false}));
}

function discard(group) {
  group.traverse(object => {
    if (object.geometry) object.geometry.dispose();
    if (object.material) object.material.dispose();
  });
}

// {figure, show(cell, pose, touches)}; show draws what it is given, and what is the same stays.
function live_view() {
  const words = element("figcaption", {});
  const holder = element("div", {class: "view", role: "img", "aria-label": "the robot in its cell"});
  const figure_of_view = element("figure", {}, holder, words);
  const empty = text => {
    holder.className = "view empty";
    holder.textContent = text;
    words.textContent = "";
    if (scene) discard(scene);
    scene = built_for = null;
  };
  let renderer, camera, turning, scene, size = 1, built_for = null, robot = null, marks = null, drawn_pose = null, drawn_count = -1;
  const update = () => { if (scene) renderer.render(scene, camera); };
  function open() {
    renderer = new THREE.WebGLRenderer({antialias: true, alpha: true, preserveDrawingBuffer: true});
    camera = new THREE.PerspectiveCamera(40, 1, 0.01, 100);
    camera.up.set(0, 0, 1);
    turning = new THREE.OrbitControls(camera, renderer.domElement);
    turning.addEventListener("change", update);
    new ResizeObserver(fit).observe(holder);
  }
  function fit() {
    if (!scene || holder.clientWidth === 0) return;
    renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    renderer.setSize(holder.clientWidth, holder.clientHeight);
    camera.aspect = holder.clientWidth / holder.clientHeight;
    camera.updateProjectionMatrix();
    update();
  }
  function place_camera(cell, box) {
    const center = box.getCenter(new THREE.Vector3());
    size = Math.max(1e-3, box.getSize(new THREE.Vector3()).length());
    camera.near = size / 100;
    camera.far = 20 * size;
    const narrow = Math.max(1, 1.4 * holder.clientHeight / Math.max(1, holder.clientWidth));  // a phone, upright
    camera.position.copy(center).add(new THREE.Vector3(0.75, -1, 0.55).normalize().multiplyScalar(1.25 * narrow * size));
    turning.target.copy(center);
    turning.update();
  }
  function build(cell) {
    const points = cell.home.flat().concat(cell.surfaces.flatMap(({center, radius}) =>
      [-radius, radius].map(way => center.map(each => each + 0.7 * way))));
    const box = bounds_of(points);
    if (box.isEmpty()) return empty("It is not known where this kind of robot has its links.");
    if (!renderer) {
      try { open(); } catch (error) { return empty("The 3D view needs WebGL, which this browser does not give."); }
    }
    if (scene) discard(scene);
    if (!built_for || built_for.model_hash !== cell.model_hash) place_camera(cell, box);
    holder.className = "view";
    holder.replaceChildren(renderer.domElement);
    scene = new THREE.Scene();
    scene.add(new THREE.HemisphereLight(0xffffff, 0x777777, 1.1));
    const floor = new THREE.GridHelper(2 * round_down(size), 20, colour("line"), colour("line"));
    floor.rotation.x = Math.PI / 2;
    const center = box.getCenter(new THREE.Vector3());
    floor.position.set(center.x, center.y, Math.min(0, box.min.z));
    scene.add(floor);
    for (const surface of cell.surfaces) scene.add(surface_mesh(surface));
    built_for = cell;
    robot = marks = drawn_pose = null;
    drawn_count = -1;
    fit();
  }
  function show(cell, pose, touches) {
    if (!cell) return empty("The robot is drawn where its configuration is given: selfcal monitor --web ADDRESS:PORT CONFIG.yaml");
    if (cell !== built_for) build(cell);
    if (!scene) return;
    const lines = pose ? pose.lines : cell.home, count = touches.length;
    if (lines === drawn_pose && count === drawn_count) return;
    for (const old of [robot, marks])
      if (old) { scene.remove(old); discard(old); }
    robot = robot_mesh(lines.map(points => ({points})), size);
    marks = new THREE.Group();
    const placed = touches.filter(touch => touch.at);
    const taken = placed.filter(touch => touch.accepted), aside = placed.filter(touch => !touch.accepted);
    if (taken.length) marks.add(touches_mesh(taken, "after", 5));
    if (aside.length) marks.add(touches_mesh(aside, "before", 9));
    scene.add(robot, marks);
    drawn_pose = lines;
    drawn_count = count;
    words.textContent = {joints: "As its joints are now.", plan: "As planned for the last touch; no joint states are heard.",
                         before: "As last heard; no joint states come any more."}[pose ? pose.from : ""] || "At home; no joint states are heard.";
    if (placed.length) words.textContent += " Points: touches" + (aside.length ? ", the large ones put aside." : ".");
    update();
  }
  drawn.views.push(() => { const cell = built_for; if (!cell) return; build(cell); });
  return {figure: figure_of_view, show};
}
