/** The arm in space: turned with the mouse or the keyboard, joints named under the mouse. */
const ARM_COLOR = "#0072B2";
const BLOCKED_COLOR = "#A50F15";
const SAME_POINT = 1e-6;

class ArmScene {
  constructor(place, scene, kinematics) {
    this.place = place;
    this.scene = scene;
    this.kinematics = kinematics;
    const start = kinematics.joints(rowOf(scene.motions[0].q, 0, kinematics.dof));
    this.groups = ArmScene.groupsOf(start);
    this.ghosts = scene.motions.slice(1);
  }

  /** Indices of points that lie at the same place: a shoulder is three joints. */
  static groupsOf(points) {
    const groups = [];
    points.forEach((point, i) => {
      const last = groups.length ? points[groups[groups.length - 1][0]] : null;
      const same = last && Math.hypot(...point.map((value, a) => value - last[a])) < SAME_POINT;
      if (same) groups[groups.length - 1].push(i);
      else groups.push([i]);
    });
    return groups;
  }

  /** Directions of the person, in millimetres: three arrays of coordinates. */
  coordinates(points) {
    const rows = [0, 3, 6].map((i) => this.scene.view.slice(i, i + 3));
    return rows.map((row) => points.map((p) => 1000 * (row[0] * p[0] + row[1] * p[1] + row[2] * p[2])));
  }

  trace(points, style, more) {
    const [x, y, z] = this.coordinates(points);
    return { type: "scatter3d", mode: "lines", x, y, z, line: style, hoverinfo: "name", ...more };
  }

  /** Points of a motion that is only drawn, at sample k. */
  static ghostPoints(ghost, k) {
    return Array.from({ length: ghost.count }, (_, i) => rowOf(ghost.points, k * ghost.count + i, 3));
  }

  pointsOf(q) {
    const points = this.kinematics.joints(q);
    return this.groups.map((group) => points[group[0]]);
  }

  /** Names of shoulder, elbow, wrist and hand, where the arm has them; of joints that are out of their range. */
  labels(out = new Set()) {
    const { landmarks } = this.kinematics;
    return this.groups.map((group) => {
      const blocking = group.filter((i) => out.has(i)).map((i) => this.scene.jointTitles[i]);
      if (blocking.length) return `<b>${blocking.join(", ")}</b>`;
      return Object.keys(landmarks).find((name) => group.includes(landmarks[name])) || "";
    });
  }

  async draw() {
    const { scene, kinematics } = this;
    const count = scene.time.length;
    const every = Array.from({ length: count }, (_, k) =>
      kinematics.joints(rowOf(scene.motions[0].q, k, kinematics.dof))
    );
    const traces = [];
    if (scene.path) {
      const asked = Array.from({ length: count }, (_, k) => rowOf(scene.path, k, 3));
      traces.push(this.trace(asked, { color: "#D55E00", width: 3, dash: "dash" }, { name: "path asked for" }));
    }
    traces.push(this.trace(every.map((p) => p[kinematics.dof]), { color: ARM_COLOR, width: 5 }, { name: "path of the hand" }));
    if ("elbow" in kinematics.landmarks) {
      const elbow = every.map((p) => p[kinematics.landmarks.elbow]);
      traces.push(this.trace(elbow, { color: "#009E73", width: 3 }, { name: "path of the elbow" }));
    }
    if (scene.body) traces.push(this.trace(this.body(every[0]), { color: "#B0B0B0", width: 6 }, { name: "body, for orientation", hoverinfo: "skip" }));
    this.firstGhost = traces.length;
    for (const ghost of this.ghosts) {
      const points = ArmScene.ghostPoints(ghost, 0);
      const style = { color: ghost.style.color, width: 5 };
      traces.push(this.trace(points, style, { name: ghost.name, visible: false, opacity: 0.75, mode: "lines+markers", marker: { size: 3, color: ghost.style.color } }));
    }
    this.arm = traces.length;
    const points = this.pointsOf(rowOf(scene.motions[0].q, 0, kinematics.dof));
    traces.push(
      this.trace(points, { color: ARM_COLOR, width: 14 }, {
        mode: "lines+markers+text",
        name: "arm",
        showlegend: false,
        text: this.labels(),
        textposition: "top center",
        textfont: { size: 12, color: "#1A1A1A" },
        marker: { size: 7, color: ARM_COLOR, line: { color: "white", width: 1 } },
        hovertemplate: "%{hovertext}<extra></extra>",
      })
    );
    await Plotly.newPlot(this.place, traces, this.layout(traces, this.swung()), {
      responsive: true,
      displaylogo: false,
      displayModeBar: false,
    });
  }

  /** Where the elbow can get to, at some samples: room that the picture must have. */
  swung() {
    const { kinematics, scene } = this;
    if (!kinematics.canSwivel) return [];
    const every = Math.max(1, Math.floor(scene.time.length / 12));
    const points = [];
    for (let k = 0; k < scene.time.length; k += every) {
      const q = rowOf(scene.motions[0].q, k, kinematics.dof);
      for (let i = -4; i < 4; ++i) points.push(...kinematics.joints(kinematics.posture((i * Math.PI) / 4, q)));
    }
    return points;
  }

  body(points) {
    const shoulder = points[this.kinematics.landmarks.shoulder || 0];
    return this.scene.body.map((p) => p.map((value, a) => value + shoulder[a]));
  }

  layout(traces, more) {
    const extra = this.coordinates(more);
    const ranges = ["x", "y", "z"].map((axis, a) => {
      let [low, high] = [Infinity, -Infinity];
      for (const trace of traces) {
        for (const value of trace[axis]) [low, high] = [Math.min(low, value), Math.max(high, value)];
      }
      for (const value of extra[a]) [low, high] = [Math.min(low, value), Math.max(high, value)];
      const room = a === 2 ? 20 : 40;
      return [low - room, high + room];
    });
    const longest = Math.max(...ranges.map(([low, high]) => high - low));
    const axis = (a) => ({
      title: { text: this.scene.axes[a], font: { size: 11 } },
      range: ranges[a],
      showbackground: false,
      gridcolor: "#E2E2E2",
      zeroline: false,
      showspikes: false,
      tickfont: { size: 9, color: "#707070" },
      nticks: 6,
    });
    const ratio = (a) => (1.6 * (ranges[a][1] - ranges[a][0])) / longest;
    return {
      margin: { l: 0, r: 0, t: 0, b: 0 },
      showlegend: true,
      legend: { x: 0, y: 1, bgcolor: "rgba(255,255,255,0.7)", font: { size: 11 } },
      uirevision: "keep",
      hoverlabel: { align: "left" },
      scene: {
        xaxis: axis(0),
        yaxis: axis(1),
        zaxis: axis(2),
        aspectmode: "manual",
        aspectratio: { x: ratio(0), y: ratio(1), z: ratio(2) },
        camera: this.camera("start"),
      },
    };
  }

  /** Where the picture is taken from. */
  camera(name) {
    const front = this.scene.front;
    const eye = {
      start: { x: 1.45 * front, y: 1.25, z: 0.45 },
      front: { x: 2.1 * front, y: 0, z: 0.1 },
      side: { x: 0, y: 2.1, z: 0.1 },
      top: { x: -0.01 * front, y: 0, z: 2.2 },
    }[name];
    return { eye, up: { x: 0, y: 0, z: 1 }, center: { x: 0, y: 0, z: -0.13 }, projection: { type: "orthographic" } };
  }

  look(name) {
    return Plotly.relayout(this.place, { "scene.camera": this.camera(name) });
  }

  /** Turn the view about the upright axis. */
  turn(angle) {
    const { eye, ...rest } = this.place._fullLayout.scene.camera;
    const [c, s] = [Math.cos(angle), Math.sin(angle)];
    const turned = { x: c * eye.x - s * eye.y, y: s * eye.x + c * eye.y, z: eye.z };
    return Plotly.relayout(this.place, { "scene.camera": { ...rest, eye: turned } });
  }

  /** Draw a posture, and the other motions that are shown at sample k. */
  show(q, k, blocked, texts, shown) {
    const color = blocked.length ? BLOCKED_COLOR : ARM_COLOR;
    const out = new Set(blocked.map((each) => each.joint));
    const update = { x: [], y: [], z: [], text: [], hovertext: [], "line.color": [], "marker.color": [], "marker.symbol": [] };
    const indices = [];
    const add = (index, points, text, hovertext, line, marker, symbol) => {
      const [x, y, z] = this.coordinates(points);
      const values = { x, y, z, text, hovertext, "line.color": line, "marker.color": marker, "marker.symbol": symbol };
      for (const key of Object.keys(update)) update[key].push(values[key]);
      indices.push(index);
    };
    this.ghosts.forEach((ghost, i) => {
      if (!shown[i]) return;
      const points = ArmScene.ghostPoints(ghost, k);
      const look = ghost.style.color;
      add(this.firstGhost + i, points, null, null, look, look, points.map(() => "circle"));
    });
    const names = this.groups.map((group) =>
      group.map((i) => (i < this.kinematics.dof ? texts[i] : "Hand")).join("<br>")
    );
    const marks = this.groups.map((group) => (group.some((i) => out.has(i)) ? "diamond" : "circle"));
    add(this.arm, this.pointsOf(q), this.labels(out), names, color, color, marks);
    return Plotly.restyle(this.place, update, indices);
  }

  showGhost(i, visible) {
    return Plotly.restyle(this.place, { visible }, [this.firstGhost + i]);
  }
}
