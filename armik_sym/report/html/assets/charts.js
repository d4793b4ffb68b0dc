// Names along the edges of the map need more room than this, in px.
const NARROW = 520;

/** The charts of a chapter: drawn when it is first shown, with a line at the present time. */
class Charts {
  constructor(root, figures, onPick) {
    this.plots = [...root.querySelectorAll(".plot")];
    this.figures = figures;
    this.onPick = onPick;
    this.now = null;
  }

  async draw() {
    for (const plot of this.plots) {
      const { data, layout, timed, role } = this.figures[plot.id];
      const config = {
        responsive: true,
        displaylogo: false,
        modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d"],
        toImageButtonOptions: { format: "svg", filename: plot.id },
      };
      const narrow = role === "map" && plot.clientWidth < NARROW;
      const annotations = narrow ? layout.annotations.filter((each) => each.xref === "paper") : layout.annotations;
      await Plotly.newPlot(plot, data, { ...layout, annotations, autosize: true }, config);
      if (timed) this.follow(plot, role);
      // Lets the page answer between two charts.
      await new Promise((next) => setTimeout(next, 0));
    }
  }

  follow(plot, role) {
    plot.append(element("div", "cursor"));
    if (role === "map") plot.append(element("div", "dot"));
    plot.on("plotly_afterplot", () => this.place(plot));
    plot.addEventListener("click", (event) => {
      const at = this.pointOf(plot, event);
      if (at) this.onPick(at.x, role === "map" ? at.y : null);
    });
    this.place(plot);
  }

  /** Time and height under the mouse, or null beside the axes. */
  pointOf(plot, event) {
    const { xaxis, yaxis } = plot._fullLayout;
    const box = plot.getBoundingClientRect();
    const x = event.clientX - box.left - xaxis._offset;
    const y = event.clientY - box.top - yaxis._offset;
    if (x < 0 || x > xaxis._length || y < 0 || y > yaxis._length) return null;
    return { x: xaxis.p2d(x), y: yaxis.p2d(y) };
  }

  /** Mark a time in all charts, and a swivel angle in the map. */
  mark(now) {
    this.now = now;
    for (const plot of this.plots) this.place(plot);
  }

  place(plot) {
    const cursor = plot.querySelector(":scope > .cursor");
    if (!cursor || !this.now || !plot._fullLayout) return;
    const { xaxis, yaxis } = plot._fullLayout;
    const x = xaxis.d2p(this.now.time);
    cursor.hidden = x < 0 || x > xaxis._length;
    cursor.style.left = `${xaxis._offset + x}px`;
    cursor.style.top = `${yaxis._offset}px`;
    cursor.style.height = `${yaxis._length}px`;
    const dot = plot.querySelector(":scope > .dot");
    if (dot) this.placeDot(dot, xaxis, yaxis, x);
  }

  placeDot(dot, xaxis, yaxis, x) {
    const { psi, blocked } = this.now;
    const [low, high] = yaxis.range;
    const turned = [psi, psi - 360, psi + 360].find((angle) => angle >= low && angle <= high);
    dot.hidden = turned === undefined || x < 0 || x > xaxis._length;
    if (dot.hidden) return;
    dot.classList.toggle("out", blocked);
    dot.style.left = `${xaxis._offset + x}px`;
    dot.style.top = `${yaxis._offset + yaxis.d2p(turned)}px`;
  }

  /** Charts as wide as a sheet of paper has room for, or as wide as the window again. */
  async fit(paper) {
    for (const plot of this.plots) {
      if (!plot._fullLayout) continue;
      const wide = plot.parentElement.classList.contains("wide") ? 680 : 330;
      Plotly.relayout(plot, paper ? { autosize: false, width: wide } : { autosize: true, width: null });
    }
  }
}
