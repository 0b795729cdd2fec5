// The page's 3D view. Hand and object come as one GLB; each grasp is numbers that pose its nodes.
(() => {
  "use strict";
  const figure = document.getElementById("viewer");
  const block = document.getElementById("scene");
  if (!figure || !block) return;
  const find = (name) => figure.querySelector(`[data-part="${name}"]`);
  const controls = { show: find("grasp"), course: find("course"), play: find("play"), time: find("time"), now: find("now") };
  const said = find("said");
  const CYCLE_MS = 4000;
  const ARROW_M = 0.045; // length of the longest force
  const RED = 0xe03020;
  const MOST_SPOTS = 8; // places of one body that are shown in red

  const canWebGL = () => {
    try {
      const canvas = document.createElement("canvas");
      return Boolean(canvas.getContext("webgl2"));
    } catch {
      return false;
    }
  };
  if (!canWebGL()) {
    said.textContent = "This browser has no WebGL, so pictures stand here in place of the 3D view.";
    return;
  }
  find("start").hidden = false;
  said.textContent = "";

  let view = null;
  const start = () => {
    if (view) return view;
    // The library waits in a block that browsers do not run, so that the page is there before it.
    const script = document.createElement("script");
    script.textContent = document.getElementById("three").textContent;
    document.head.append(script);
    view = new View(JSON.parse(block.textContent));
    figure.view = view; // for whoever scripts the page
    return view;
  };

  class View {
    constructor(scene) {
      this.data = scene;
      this.grasp = scene.grasps[0];
      this.courses = [];
      this.playing = 0;
      this.renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
      this.canvas = this.renderer.domElement;
      this.canvas.tabIndex = 0;
      this.canvas.setAttribute("role", "img");
      find("stage").append(this.canvas);
      find("stage").hidden = false;
      find("panel").hidden = false;
      find("start").hidden = true;
      find("poster")?.toggleAttribute("hidden", true);
      this.scene = new THREE.Scene();
      this.scene.add(new THREE.HemisphereLight(0xffffff, 0x9098a4, 1.5));
      this.camera = new THREE.PerspectiveCamera(30, 1, 0.005, 20);
      this.camera.up.set(0, 0, 1);
      const lamp = new THREE.DirectionalLight(0xffffff, 1.7);
      lamp.position.set(-0.6, 0.7, 0.9);
      this.camera.add(lamp);
      this.scene.add(this.camera);
      this.orbit = new THREE.OrbitControls(this.camera, this.canvas);
      this.orbit.addEventListener("change", () => this.draw());
      this.canvas.addEventListener("keydown", (event) => this.key(event));
      this.links = scene.links.map((link) => {
        const group = new THREE.Group();
        group.userData.T = new THREE.Matrix4().set(...link.T);
        group.matrixAutoUpdate = false;
        return group;
      });
      scene.links.forEach((link, i) => (link.parent < 0 ? this.scene : this.links[link.parent]).add(this.links[i]));
      this.object = new THREE.Group(); // what the test moves
      this.stand = new THREE.Group(); // parts that stay behind
      this.marks = new THREE.Group(); // normals, cones and forces, in the object's frame
      this.object.add(this.marks);
      this.scene.add(this.object, this.stand);
      this.axes = this.makeAxes();
      this.pull = arrow(new THREE.Vector3(), new THREE.Vector3(0, 0, -1), 0.06, 0x808890, 0.0018);
      this.pull.visible = false;
      this.scene.add(this.axes, this.pull);
      this.nodes = {};
      this.ready = this.load();
      new ResizeObserver(() => this.resize()).observe(find("stage"));
    }

    async load() {
      const text = this.data.glb.slice(this.data.glb.indexOf(",") + 1);
      const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
      const model = await new THREE.GLTFLoader().parseAsync(bytes.buffer, "");
      const meshes = [];
      model.scene.traverse((node) => {
        if (node.isMesh) meshes.push(node);
      });
      for (const mesh of meshes) {
        const name = mesh.name in this.data.nodes ? mesh.name : mesh.parent.name;
        const node = this.data.nodes[name];
        if (!node) continue;
        mesh.geometry = THREE.toCreasedNormals(mesh.geometry, 0.6);
        mesh.material = mesh.material.clone();
        mesh.material.flatShading = false;
        mesh.material.side = THREE.DoubleSide;
        spotted(mesh.material);
        if (node.kind === "skin" || node.kind === "place") {
          mesh.material.polygonOffset = true;
          mesh.material.polygonOffsetFactor = -2;
        }
        const body = node.link !== null ? this.links[node.link] : node.moves ? this.object : this.stand;
        body.add(mesh);
        mesh.position.set(0, 0, 0);
        this.nodes[name] = { ...node, mesh, colour: mesh.material.color.clone() };
      }
      this.choose(this.grasp.id);
      this.resize();
      this.look(205, -18);
      said.textContent = "";
    }

    makeAxes() {
      const group = new THREE.Group();
      const length = 0.05;
      const dark = matchMedia("(prefers-color-scheme: dark)").matches;
      for (const [i, [name, colour]] of [["x", 0xc8442f], ["y", 0x2b8a4b], ["z", 0x2f64c8]].entries()) {
        const along = new THREE.Vector3().setComponent(i, 1);
        group.add(arrow(new THREE.Vector3(), along, length, colour), label(i === 0 ? "x 50 mm" : name, along.clone().multiplyScalar(length + 0.008), colour, dark));
      }
      group.visible = false;
      return group;
    }

    // Forward kinematics: the axes of a link are applied in order, the first next to its parent.
    pose(q, pose) {
      let k = 0;
      this.data.links.forEach((link, i) => {
        const T = this.links[i].matrix.copy(this.links[i].userData.T);
        for (const axis of link.axes) {
          const along = new THREE.Vector3(...axis.along);
          const step = new THREE.Matrix4();
          if (axis.slides) step.makeTranslation(along.multiplyScalar(q[k]));
          else step.makeRotationAxis(along, q[k]);
          T.multiply(step);
          k += 1;
        }
        this.links[i].matrixWorldNeedsUpdate = true;
      });
      place(this.object, pose);
    }

    choose(id) {
      this.grasp = this.data.grasps.find((grasp) => grasp.id === id) ?? this.data.grasps[0];
      const grasp = this.grasp;
      controls.show.value = grasp.id;
      place(this.stand, grasp.pose);
      const start = grasp.trials.length ? grasp.trials[0].rows[0] : null;
      const closing = grasp.approach.length ? grasp.approach : [grasp.q];
      const way = [...closing.slice(0, -1).map((q) => [q, grasp.pose]), [grasp.q, grasp.pose]];
      const states = way.map(([q, pose]) => [...q, ...pose]);
      if (start) states.push(start.slice(1));
      this.courses = [{ name: start ? "approach and squeeze" : "approach", states: paced(states, start !== null) }];
      for (const trial of grasp.trials) {
        this.courses.push({
          name: (trial.name ? `gravity ${trial.name}` : "the test") + (trial.outcome ? `: ${trial.outcome}` : ""),
          states: trial.rows.map((row) => ({ at: row[0], state: row.slice(1) })),
          trial,
        });
      }
      controls.course.replaceChildren(...this.courses.map((course, i) => new Option(course.name, String(i))));
      this.follow(0);
      this.canvas.setAttribute("aria-label", `3D view of grasp ${grasp.id}`);
    }

    follow(number) {
      this.course = this.courses[number];
      controls.course.value = String(number);
      this.mark();
      this.stop();
      this.seek(number === 0 ? this.graspShare() : 0);
    }

    graspShare() {
      const states = this.courses[0].states;
      const at = states.find((entry) => entry.isGrasp)?.at ?? 0;
      const last = states[states.length - 1].at;
      return last > 0 ? at / last : 0;
    }

    // Share of the course, from 0 to 1.
    seek(share) {
      const { states, trial } = this.course;
      const last = states[states.length - 1].at;
      const at = share * last;
      let k = 0;
      while (k < states.length - 2 && states[k + 1].at < at) k += 1;
      const from = states[k];
      const to = states[Math.min(k + 1, states.length - 1)];
      const w = to.at > from.at ? Math.min(1, Math.max(0, (at - from.at) / (to.at - from.at))) : 0;
      const state = mixed(from.state, to.state, w);
      this.pose(state.slice(0, -7), state.slice(-7));
      controls.time.value = String(Math.round(1000 * share));
      controls.now.textContent = trial ? words(trial, at) : from === to ? "the grasp" : stage(from, to, w);
      this.pull.visible = Boolean(trial && trial.gravity.some((g) => g !== 0));
      if (this.pull.visible) {
        this.pull.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), new THREE.Vector3(...trial.gravity).normalize());
      }
      this.draw();
    }

    play() {
      if (this.playing) return this.stop();
      const begin = Number(controls.time.value) / 1000;
      const from = begin >= 0.999 ? 0 : begin;
      const began = performance.now();
      controls.play.textContent = "Pause";
      const step = (now) => {
        const share = Math.min(1, from + (now - began) / CYCLE_MS);
        this.seek(share);
        this.playing = share < 1 ? requestAnimationFrame(step) : 0;
        if (!this.playing) controls.play.textContent = "Play";
      };
      this.playing = requestAnimationFrame(step);
      return undefined;
    }

    stop() {
      cancelAnimationFrame(this.playing);
      this.playing = 0;
      controls.play.textContent = "Play";
    }

    // Normals, friction cones and forces at the contacts: those of the squeeze, or those proved to balance the load.
    mark() {
      for (const child of [...this.marks.children]) this.marks.remove(child);
      const { contacts, loads } = this.grasp;
      const sets = [contacts.map((contact) => contact.squeeze), ...loads].map((set) => set.filter(Boolean));
      const largest = Math.max(1e-9, ...sets.flat().map((force) => Math.hypot(...force)));
      contacts.forEach((contact, i) => {
        const point = new THREE.Vector3(...contact.point);
        const out = new THREE.Vector3(...contact.normal);
        const normal = arrow(point, out, 0.03, 0x2b8a4b, 0.0008);
        normal.userData.layer = "normals";
        this.marks.add(normal, cone(point, out, this.data.friction));
        const acting = loads[this.course?.trial?.number]?.[i] ?? contact.squeeze;
        if (acting) this.marks.add(force(point, acting, largest));
      });
      const which = loads[this.course?.trial?.number] ? "forces that balance the load; longest" : "longest force";
      find("scale").textContent = sets.flat().length ? `${which} ${largest.toPrecision(3)} N` : "";
      this.layers();
    }

    layers() {
      const on = (name) => figure.querySelector(`[data-layer="${name}"]`).checked;
      const wanted = { regions: on("regions"), pieces: on("pieces"), penetration: on("penetration") };
      const { deep, blocking } = this.grasp;
      // Where bodies overlap is red, and what blocked the way is reddish as a whole.
      const blocked = new Set(wanted.penetration ? blocking?.bodies : []);
      const places = (body) => (wanted.penetration ? deep.flatMap((pair) => pair.places[body] ?? []) : []);
      for (const [name, node] of Object.entries(this.nodes)) {
        const { kind, mesh } = node;
        mesh.visible = { link: true, part: !wanted.pieces, piece: wanted.pieces }[kind] ?? wanted.regions;
        const body = name.split("_").slice(0, 2).join("_").replace("piece", "part");
        const isBody = kind !== "skin" && kind !== "place";
        mesh.material.transparent = isBody && on("through");
        mesh.material.opacity = mesh.material.transparent ? 0.4 : 1;
        mesh.material.depthWrite = !mesh.material.transparent;
        mesh.material.needsUpdate = true;
        mesh.material.color.copy(node.colour).lerp(new THREE.Color(RED), isBody && blocked.has(body) ? 0.5 : 0);
        mark(mesh.material, isBody ? places(body) : []);
      }
      for (const child of this.marks.children) child.visible = on(child.userData.layer);
      this.axes.visible = on("axes");
      const sunk = deep.map((pair) => `${pair.names.join(" and ")} ${pair.depth} mm`);
      const stops = blocking ? [`${blocking.names.join(" and ")} end ${blocking.ends}`] : [];
      find("deep").textContent = [...stops, ...(sunk.length ? [`sunk in: ${sunk.slice(0, 4).join(", ")}`] : [])].join("; ");
      this.draw();
    }

    look(azimuth, elevation) {
      const box = new THREE.Box3();
      for (const { kind, mesh } of Object.values(this.nodes)) {
        if (kind !== "link") continue;
        mesh.updateWorldMatrix(true, false);
        box.expandByObject(mesh);
      }
      const whole = box.clone();
      for (const { kind, mesh } of Object.values(this.nodes)) if (kind === "part") whole.expandByObject(mesh);
      // A giant, such as a guitar, does not fit with the hand; then the hand fills the view.
      const hand = box.getSize(new THREE.Vector3()).length();
      const chosen = whole.getSize(new THREE.Vector3()).length() < 2 * hand ? whole : box;
      const middle = chosen.getCenter(new THREE.Vector3());
      const radius = 0.5 * chosen.getSize(new THREE.Vector3()).length();
      const narrow = Math.min(1, this.camera.aspect);
      const distance = radius / (Math.sin((0.5 * this.camera.fov * Math.PI) / 180) * narrow);
      const [a, e] = [azimuth, elevation].map((angle) => (angle * Math.PI) / 180);
      const forward = new THREE.Vector3(Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e));
      this.camera.position.copy(middle).addScaledVector(forward, -distance);
      this.orbit.target.copy(middle);
      this.pull.position.copy(middle).add(new THREE.Vector3(0, 0, 0.6 * radius));
      this.orbit.update();
      this.draw();
    }

    key(event) {
      const turn = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
      const zoom = { "+": 0.9, "=": 0.9, "-": 1 / 0.9 }[event.key];
      if (!turn && !zoom) return;
      event.preventDefault();
      const away = this.camera.position.clone().sub(this.orbit.target);
      if (zoom) away.multiplyScalar(zoom);
      else {
        const flat = Math.hypot(away.x, away.y);
        const up = Math.min(1.5, Math.max(-1.5, Math.atan2(away.z, flat) + 0.1 * -turn[1]));
        const around = Math.atan2(away.y, away.x) + 0.1 * -turn[0];
        const size = away.length();
        away.set(size * Math.cos(up) * Math.cos(around), size * Math.cos(up) * Math.sin(around), size * Math.sin(up));
      }
      this.camera.position.copy(this.orbit.target).add(away);
      this.orbit.update();
    }

    resize() {
      const { clientWidth: width, clientHeight: height } = find("stage");
      if (!width || !height) return;
      this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));
      this.renderer.setSize(width, height);
      this.camera.aspect = width / height;
      this.camera.updateProjectionMatrix();
      this.draw();
    }

    draw() {
      this.renderer.render(this.scene, this.camera);
    }
  }

  // Lets places of a body be red. The shader does it, for corners of a mesh may lie far apart.
  const spotted = (material) => {
    const spots = { value: new Array(4 * MOST_SPOTS).fill(0) };
    material.userData = { spots };
    material.onBeforeCompile = (shader) => {
      shader.uniforms.spots = spots;
      shader.uniforms.spotColour = { value: new THREE.Color(RED) };
      shader.vertexShader = shader.vertexShader
        .replace("#include <common>", "#include <common>\nvarying vec3 vPlace;")
        .replace("#include <begin_vertex>", "#include <begin_vertex>\nvPlace = position;");
      shader.fragmentShader = shader.fragmentShader
        .replace("#include <common>", `#include <common>\nvarying vec3 vPlace;\nuniform vec4 spots[${MOST_SPOTS}];\nuniform vec3 spotColour;`)
        .replace(
          "#include <color_fragment>",
          `#include <color_fragment>
          for (int i = 0; i < ${MOST_SPOTS}; i++) {
            float size = spots[i].w;
            float near = size > 0.0 ? 1.0 - smoothstep(0.6 * size, size, distance(vPlace, spots[i].xyz)) : 0.0;
            diffuseColor.rgb = mix(diffuseColor.rgb, spotColour, near);
          }`,
        );
    };
  };

  // Places in the frame of the body: x, y, z and depth, in m; the deepest ones where there are many.
  const mark = (material, places) => {
    const deepest = [...places].sort((a, b) => b[3] - a[3]);
    const shown = deepest.slice(0, MOST_SPOTS).flatMap(([x, y, z, depth]) => [x, y, z, 0.004 + 1.5 * depth]);
    material.userData.spots.value = [...shown, ...new Array(4 * MOST_SPOTS - shown.length).fill(0)];
  };

  const place = (group, pose) => {
    group.position.set(pose[0], pose[1], pose[2]);
    group.quaternion.set(pose[4], pose[5], pose[6], pose[3]).normalize();
  };

  // States along the approach, paced by the largest joint motion; the squeeze, which moves little, has a share of its own.
  const paced = (states, squeezes) => {
    const path = [{ at: 0, state: states[0] }];
    const graspAt = states.length - (squeezes ? 2 : 1);
    for (let i = 1; i < states.length; i += 1) {
      const moved = Math.max(...states[i].slice(0, -7).map((q, k) => Math.abs(q - states[i - 1][k])));
      path.push({ at: path[i - 1].at + Math.max(moved, 1e-3), state: states[i] });
    }
    path[graspAt].isGrasp = true;
    if (squeezes) path[graspAt + 1].at = path[graspAt].at + Math.max(1e-3, 0.4 * path[graspAt].at);
    return path;
  };

  const mixed = (from, to, w) => {
    const n = from.length - 4;
    const state = from.slice(0, n).map((value, k) => value + w * (to[k] - value));
    const [a, b] = [from, to].map(([...row]) => new THREE.Quaternion(row[n + 1], row[n + 2], row[n + 3], row[n]));
    const q = a.slerp(b, w);
    return [...state, q.w, q.x, q.y, q.z];
  };

  // To within what the slider can tell apart.
  const stage = (from, to, w) => {
    const [begins, ends] = [w < 0.005, w > 0.995];
    if (from.isGrasp) return begins ? "the grasp" : ends ? "squeezed" : `squeezing, ${Math.round(100 * w)} %`;
    if (to.isGrasp && ends) return "the grasp";
    return from.at === 0 && begins ? "fingers open" : "closing";
  };

  const words = (trial, at) => {
    const rows = trial.slips;
    let slip = rows.length ? rows[0][1] : null;
    for (const [time, value] of rows) if (time <= at + 1e-6) slip = value;
    return `${at.toFixed(2)} s${slip === null ? "" : `, slip ${slip.toFixed(2)} mm`}`;
  };

  const cone = (point, out, friction) => {
    const height = 0.02;
    const geometry = new THREE.ConeGeometry(height * friction, height, 32, 1, true);
    geometry.translate(0, -0.5 * height, 0); // the tip at the origin, open along -y
    const look = { color: 0x3f7fd0, transparent: true, opacity: 0.35, side: THREE.DoubleSide, depthTest: false, depthWrite: false };
    const mesh = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial(look));
    mesh.quaternion.setFromUnitVectors(new THREE.Vector3(0, -1, 0), out);
    mesh.position.copy(point);
    mesh.renderOrder = 1;
    mesh.userData.layer = "cones";
    return mesh;
  };

  // An arrow of some thickness, in front of all bodies: most of what it shows lies inside of them.
  const arrow = (from, along, length, colour, thick = 0.0011) => {
    const head = Math.min(0.35 * length, 8 * thick);
    const look = new THREE.MeshBasicMaterial({ color: colour, depthTest: false, transparent: true });
    const shaft = new THREE.Mesh(new THREE.CylinderGeometry(thick, thick, length - head, 12), look);
    shaft.position.y = 0.5 * (length - head);
    const tip = new THREE.Mesh(new THREE.ConeGeometry(2.6 * thick, head, 16), look);
    tip.position.y = length - 0.5 * head;
    const group = new THREE.Group();
    group.add(shaft, tip);
    for (const mesh of group.children) mesh.renderOrder = 2;
    group.position.copy(from);
    group.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), along.clone().normalize());
    return group;
  };

  // An arrow that ends where the force acts.
  const force = (point, vector, largest) => {
    const length = Math.max(1e-3, (ARROW_M * Math.hypot(...vector)) / largest);
    const along = new THREE.Vector3(...vector).normalize();
    const group = arrow(point.clone().addScaledVector(along, -length), along, length, RED);
    group.userData.layer = "forces";
    return group;
  };

  const label = (text, at, colour, dark) => {
    const canvas = document.createElement("canvas");
    canvas.width = 256;
    canvas.height = 64;
    const pen = canvas.getContext("2d");
    pen.font = "600 44px system-ui, sans-serif";
    pen.textBaseline = "middle";
    pen.lineWidth = 8;
    pen.strokeStyle = dark ? "#1d2024" : "#ffffff";
    pen.strokeText(text, 8, 32);
    pen.fillStyle = `#${new THREE.Color(colour).getHexString()}`;
    pen.fillText(text, 8, 32);
    const material = new THREE.SpriteMaterial({ map: new THREE.CanvasTexture(canvas), depthTest: false });
    const sprite = new THREE.Sprite(material);
    sprite.renderOrder = 3;
    sprite.center.set(0, 0.5);
    sprite.scale.set(0.048, 0.012, 1);
    sprite.position.copy(at);
    return sprite;
  };

  const begin = async (id) => {
    const shown = start();
    await shown.ready;
    if (id) shown.choose(id);
    return shown;
  };
  const doing = (act) => (event) => begin().then((shown) => act(shown, event));
  find("start").addEventListener("click", () => begin());
  controls.show.addEventListener("change", doing((shown) => shown.choose(controls.show.value)));
  controls.course.addEventListener("change", doing((shown) => shown.follow(Number(controls.course.value))));
  controls.play.addEventListener("click", doing((shown) => shown.play()));
  controls.time.addEventListener(
    "input",
    doing((shown) => {
      shown.stop();
      shown.seek(Number(controls.time.value) / 1000);
    }),
  );
  for (const box of figure.querySelectorAll("[data-layer]")) box.addEventListener("change", doing((shown) => shown.layers()));
  for (const button of figure.querySelectorAll("[data-side]")) {
    button.addEventListener("click", doing((shown) => shown.look(...button.dataset.side.split(",").map(Number))));
  }
  for (const button of document.querySelectorAll("[data-view]")) {
    button.hidden = false;
    button.addEventListener("click", () => {
      begin(button.dataset.view);
      figure.scrollIntoView({ block: "start" });
      controls.show.focus({ preventScroll: true });
    });
  }
  // The view starts by itself once it comes into sight, after all the rest of the page.
  addEventListener("load", () => {
    new IntersectionObserver((entries, observer) => {
      if (!entries.some((entry) => entry.isIntersecting)) return;
      observer.disconnect();
      begin();
    }).observe(figure);
  });
})();
