/** Time, elbow and everything that follows from them: the posture on the stage and the marks in the charts. */
class Player {
  constructor(root, scene, kinematics, charts) {
    Object.assign(this, { root, scene, kinematics, charts });
    this.find = (selector) => root.querySelector(selector);
    this.k = 0;
    this.swung = null;
    this.playing = false;
    this.shown = scene.motions.slice(1).map(() => false);
    this.view = new ArmScene(this.find(".scene"), scene, kinematics);
  }

  async start() {
    this.buildGauges();
    this.buildGhosts();
    this.connect();
    await this.view.draw().catch((error) => this.fail(error));
    this.show();
  }

  fail(error) {
    this.view = null;
    this.find(".scene").textContent = `This browser cannot draw in three dimensions (${error.message || error}).`;
  }

  // What is shown now.

  get solved() {
    return rowOf(this.scene.motions[0].q, this.k, this.kinematics.dof);
  }

  get reference() {
    return this.scene.reference ? rowOf(this.scene.reference, this.k, 3) : undefined;
  }

  get posture() {
    if (this.swung === null) return this.solved;
    return this.kinematics.posture(this.swung, this.solved, this.reference);
  }

  get psi() {
    return this.kinematics.canSwivel ? this.kinematics.swivel(this.posture, this.reference) : null;
  }

  // What the reader does.

  setSample(k) {
    const last = this.scene.time.length - 1;
    this.k = Math.max(0, Math.min(last, Math.round(k)));
    this.swung = null;
    this.show();
  }

  setTime(time) {
    this.setSample(this.sampleAt(time));
  }

  sampleAt(time) {
    const { time: stamps } = this.scene;
    let [low, high] = [0, stamps.length - 1];
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (stamps[middle] <= time) low = middle;
      else high = middle;
    }
    return time - stamps[low] < stamps[high] - time ? low : high;
  }

  swing(psi) {
    if (!this.kinematics.canSwivel) return;
    this.swung = psi === null ? null : Math.atan2(Math.sin(psi), Math.cos(psi));
    this.show();
  }

  play() {
    if (this.playing) return;
    this.playing = true;
    const { time } = this.scene;
    if (this.k === time.length - 1) this.k = 0;
    this.swung = null;
    let [from, began] = [time[this.k], null];
    const step = (now) => {
      if (!this.playing) return;
      if (began === null) began = now;
      const speed = Number(this.find(".speed select").value);
      const at = from + ((now - began) / 1000) * speed;
      if (this.speed !== speed) [this.speed, from, began] = [speed, time[this.k], now];
      this.k = this.sampleAt(Math.min(at, time[time.length - 1]));
      this.show();
      if (at >= time[time.length - 1]) this.pause();
      else requestAnimationFrame(step);
    };
    this.speed = Number(this.find(".speed select").value);
    requestAnimationFrame(step);
    this.labelPlay();
  }

  pause() {
    this.playing = false;
    this.labelPlay();
    this.show();
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  labelPlay() {
    const button = this.find(".play");
    button.textContent = this.playing ? "❚❚ Pause" : "▶ Play";
    button.setAttribute("aria-pressed", String(this.playing));
  }

  connect() {
    const [time, psi] = [this.find(".time"), this.find(".psi")];
    time.max = this.scene.time.length - 1;
    time.addEventListener("input", () => {
      this.playing = false;
      this.labelPlay();
      this.setSample(Number(time.value));
    });
    psi.addEventListener("input", () => {
      this.playing = false;
      this.labelPlay();
      this.swing(radians(Number(psi.value)));
    });
    if (this.kinematics.step) psi.step = degrees(this.kinematics.step);
    this.find(".play").addEventListener("click", () => this.toggle());
    this.find(".back").addEventListener("click", () => this.swing(null));
    this.find(".row.swivel").hidden = !this.kinematics.canSwivel;
    this.find(".no-swivel").hidden = this.kinematics.canSwivel;
    for (const button of this.root.querySelectorAll("[data-view]")) {
      const name = button.dataset.view;
      if (name !== "start") button.textContent = this.scene.views[name];
      button.addEventListener("click", () => this.view && this.view.look(name));
    }
    this.find(".scene").addEventListener("keydown", (event) => this.key(event));
  }

  key(event) {
    const steps = {
      " ": () => this.toggle(),
      ArrowLeft: () => this.setSample(this.k - 1),
      ArrowRight: () => this.setSample(this.k + 1),
      ArrowUp: () => this.swing(this.psi + radians(2)),
      ArrowDown: () => this.swing(this.psi - radians(2)),
      a: () => this.view && this.view.turn(-0.15),
      d: () => this.view && this.view.turn(0.15),
    };
    if (!(event.key in steps) || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    steps[event.key]();
  }

  buildGauges() {
    const { lower, upper } = this.kinematics;
    this.gauges = this.scene.jointTitles.map((title, j) => {
      const { symbol, factor } = this.scene.units[j];
      const gauge = element("div", "gauge");
      const name = element("div", "name");
      const value = element("b");
      name.append(element("span", "", title), value);
      const bar = element("div", "bar");
      const needle = element("i");
      bar.append(needle);
      const ends = element("div", "ends");
      ends.append(
        element("span", "", fixed(factor * lower[j], 0) + symbol),
        element("span", "", fixed(factor * upper[j], 0) + symbol)
      );
      gauge.append(name, bar, ends);
      this.find(".gauges").append(gauge);
      return { gauge, value, needle };
    });
  }

  buildGhosts() {
    const place = this.find(".ghosts");
    place.hidden = !this.shown.length;
    this.scene.motions.slice(1).forEach((motion, i) => {
      const label = element("label");
      const box = element("input");
      box.type = "checkbox";
      box.addEventListener("change", () => {
        this.shown[i] = box.checked;
        if (this.view) this.view.showGhost(i, box.checked);
        this.show();
      });
      const mark = element("span", "", " ▬ ");
      mark.style.color = motion.style.color;
      label.append(box, mark, motion.name);
      place.append(label);
    });
  }

  // What follows.

  text(j, q) {
    const { symbol, factor } = this.scene.units[j];
    return `${this.scene.jointTitles[j]}: ${fixed(factor * q[j], 1)}${symbol}`;
  }

  show() {
    const q = this.posture;
    const blocked = this.kinematics.blocked(q);
    const texts = q.map((_, j) => this.text(j, q));
    if (this.view) this.view.show(q, this.k, blocked, texts, this.shown);
    this.showGauges(q, new Set(blocked.map((each) => each.joint)));
    this.showControls(blocked);
    this.charts.mark({
      time: this.scene.time[this.k],
      psi: this.psi === null ? NaN : degrees(this.psi),
      blocked: blocked.length > 0,
    });
  }

  showGauges(q, out) {
    const { lower, upper } = this.kinematics;
    this.gauges.forEach(({ gauge, value, needle }, j) => {
      const { symbol, factor } = this.scene.units[j];
      const share = (q[j] - lower[j]) / Math.max(upper[j] - lower[j], 1e-12);
      needle.style.left = `${100 * Math.max(0, Math.min(1, share))}%`;
      value.textContent = fixed(factor * q[j], 1) + symbol;
      gauge.classList.toggle("out", out.has(j));
    });
  }

  showControls(blocked) {
    const { time } = this.scene;
    const now = `${time[this.k].toFixed(2)} s of ${time[time.length - 1].toFixed(2)} s`;
    const slider = this.find(".time");
    slider.value = this.k;
    slider.setAttribute("aria-valuetext", now);
    this.find(".time-now").textContent = now;
    this.find(".status").textContent = blocked
      .map(({ joint, missing, limit }) => {
        const { symbol, factor } = this.scene.units[joint];
        const side = limit === "upper" ? "above its upper" : "below its lower";
        return `${this.scene.jointTitles[joint]} is ${fixed(factor * missing, 1)}${symbol} ${side} limit.`;
      })
      .join(" ");
    if (this.kinematics.canSwivel) this.showSwivel(blocked);
  }

  showSwivel(blocked) {
    const slider = this.find(".psi");
    const angle = fixed(degrees(this.psi), 1);
    const words = `${angle}° ${this.swung === null ? "(solved)" : "(by hand)"}`;
    if (document.activeElement !== slider || this.swung === null) slider.value = angle;
    slider.setAttribute("aria-valuetext", blocked.length ? `${words}, outside a range of motion` : words);
    this.find(".psi-now").textContent = words;
    this.find(".back").disabled = this.swung === null;
    if (!this.playing || !this.kinematics.step) this.paintStrip();
  }

  /** Blue where the elbow can be at this instant, red where a joint would leave its range. */
  paintStrip() {
    if (this.painted === this.k) return;
    this.painted = this.k;
    const along = this.kinematics.blockedAlong(this.solved, 180, this.reference);
    const stops = along.map(({ blocked }, i) => {
      const color = blocked.length ? "#A50F15" : "#A9CDE8";
      return `${color} ${(i / 1.8).toFixed(2)}% ${((i + 1) / 1.8).toFixed(2)}%`;
    });
    this.find(".strip").style.background = `linear-gradient(to right, ${stops.join(",")})`;
  }

  /** What a program that reads the page may want to know; SI units. */
  state() {
    const q = this.posture;
    return {
      sample: this.k,
      time: this.scene.time[this.k],
      playing: this.playing,
      swivel: this.psi,
      solved: this.swung === null,
      q,
      joints: this.kinematics.joints(q),
      hand: this.kinematics.hand(q),
      blocked: this.kinematics.blocked(q),
      kind: this.kinematics.kind,
    };
  }
}
