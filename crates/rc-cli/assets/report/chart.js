// Line charts as SVG, with linear or logarithmic axes that can be switched, and a reading at the pointer.

const CHART = { width: 600, height: 330, left: 104, right: 14, top: 10, bottom: 46 };

/** What a logarithmic axis shows, over its largest value: below is rounding. */
const SMALLEST_PART = 1e-7;

/** An axis over the values that it has to show, in their prefixed unit. */
class Axis {
  constructor({ label, unit = "", log = false, from, to }, values, start, end) {
    const usable = values.filter((value) => Number.isFinite(value) && (!log || value > 0));
    // Not Math.min(...usable): a call has no room for the arguments of a long sweep.
    let low = from ?? usable.reduce((least, value) => Math.min(least, value), log ? Infinity : 0);
    let high = to ?? usable.reduce((greatest, value) => Math.max(greatest, value), -Infinity);
    if (!Number.isFinite(low) || !Number.isFinite(high) || !(high > low)) {
      const middle = Number.isFinite(high) && high > 0 ? high : 1;
      [low, high] = log ? [middle / 3, middle * 3] : [0, 1.5 * middle];
    } else if (to === undefined) {
      high = log ? high * 1.3 : high + 0.05 * (high - low);
      if (log && from === undefined) low = Math.max(low / 1.3, high * SMALLEST_PART);
    }
    Object.assign(this, { low, high, log, start, end, unit });
    this.scale = scaleOf(Math.max(Math.abs(low), Math.abs(high)), unit);
    // Over decades each mark has a prefix of its own.
    this.label = unit && !log ? `${label} (${this.scale.unit})` : label;
  }

  place(value) {
    const part = this.log
      ? Math.log(value / this.low) / Math.log(this.high / this.low)
      : (value - this.low) / (this.high - this.low);
    return this.start + part * (this.end - this.start);
  }

  valueAt(place) {
    const part = (place - this.start) / (this.end - this.start);
    return this.log ? this.low * (this.high / this.low) ** part : this.low + part * (this.high - this.low);
  }

  ticks(n) {
    if (this.log) return logTicks(this.low, this.high).map((value) => [value, si(value, this.unit)]);
    const { factor } = this.scale;
    return linearTicks(this.low / factor, this.high / factor, n).map((value) => [value * factor, digits(value)]);
  }
}

let charts = 0;

/** Length of a line in a legend: two periods of the longest dashes. */
const SWATCH = 38;

/** The dashes of a series, in its curve and in legends. */
function dashes({ dashed }) {
  return dashed ? { "stroke-dasharray": dashed === true ? "6 4" : dashed } : {};
}

/**
 * A chart of `series` ({ name, points, colour, kind: "line" | "steps" | "dots" | "fill" | "bars", dashed, faint }) on axes `x`
 * and `y` ({ label, unit, log, from, to }). Points of bars are [x, y, error of x, error of y]; `dashed` may be the lengths of
 * dashes. `switches` names the axes that get a button for their logarithm.
 */
class Chart {
  constructor({ x, y, series, switches = [] }) {
    charts += 1;
    Object.assign(this, { x, y, series, id: `clip-${charts}` });
    this.svg = shape("svg", { viewBox: `0 0 ${CHART.width} ${CHART.height}`, role: "img" });
    this.svg.addEventListener("pointermove", (event) => this.read(event));
    this.svg.addEventListener("pointerleave", () => { this.reading.textContent = ""; });
    this.reading = make("span", { class: "quiet" });
    const button = (axis) => make("button", {
      "aria-pressed": Boolean(this[axis].log),
      onclick: (event) => {
        this[axis].log = !this[axis].log;
        event.target.setAttribute("aria-pressed", this[axis].log);
        this.redraw();
      },
    }, `log ${axis}`);
    const controls = make("div", { class: "controls" }, ...switches.map(button), chartDownloads(this), this.reading);
    this.legend = make("div", { class: "legend" });
    this.element = make("div", { class: "chart" }, this.legend, this.svg, controls);
    this.redraw();
  }

  /** Other series, and axes where they are given. */
  update({ series, x = this.x, y = this.y }) {
    Object.assign(this, { series, x, y });
    this.redraw();
  }

  redraw() {
    const logs = [this.x.log, this.y.log];
    // Nothing is drawn at a zero of a logarithmic axis, and a bar that reaches zero ends at its border.
    const isShown = (point) => logs.every((log, i) => !log || point[i] > 0);
    const low = (point, i) => Math.max(point[i] - point[i + 2], logs[i] ? 0.5 * point[i] : -Infinity);
    const ends = (point, i) => [low(point, i), point[i], point[i] + point[i + 2]];
    const of = (i) => this.series.flatMap(({ kind, points }) => points.filter(isShown).flatMap((point) => (kind === "bars" ? ends(point, i) : point[i])));
    const { width, height, left, right, top, bottom } = CHART;
    this.across = new Axis(this.x, of(0), left, width - right);
    this.up = new Axis(this.y, of(1), height - bottom, top);
    this.svg.setAttribute("aria-label", `${this.up.label} against ${this.across.label}`);
    const frame = { x: left, y: top, width: width - left - right, height: height - top - bottom };
    const clip = shape("clipPath", { id: this.id }, shape("rect", frame));
    const lines = shape("g", { "clip-path": `url(#${this.id})` }, ...this.series.map((one) => this.curve(one)));
    this.svg.replaceChildren(clip, ...this.marks(), lines, shape("rect", { ...frame, class: "frame" }));
    const entry = (one) => {
      const line = shape("line", { x1: 0, x2: SWATCH, y1: 3, y2: 3, stroke: one.colour, "stroke-width": 2, ...dashes(one) });
      return make("span", {}, shape("svg", { viewBox: `0 0 ${SWATCH} 6`, width: SWATCH, height: 6 }, line), one.name);
    };
    this.legend.replaceChildren(...this.series.filter((one) => one.name).map(entry));
  }

  marks() {
    const { width, height, left, right, top, bottom } = CHART;
    const text = (x, y, anchor, content, more = {}) => shape("text", { x, y, "text-anchor": anchor, ...more }, content);
    const middle = { x: (left + width - right) / 2, y: (top + height - bottom) / 2 };
    const across = this.across.ticks(6).flatMap(([value, label]) => {
      const x = this.across.place(value);
      return [shape("line", { x1: x, x2: x, y1: top, y2: height - bottom, class: "grid" }), text(x, height - bottom + 17, "middle", label)];
    });
    const up = this.up.ticks(5).flatMap(([value, label]) => {
      const y = this.up.place(value);
      return [shape("line", { x1: left, x2: width - right, y1: y, y2: y, class: "grid" }), text(left - 7, y + 4, "end", label)];
    });
    const turned = { transform: `rotate(-90 10 ${middle.y})` };
    return [...across, ...up, text(middle.x, height - 8, "middle", this.across.label), text(10, middle.y, "middle", this.up.label, turned)];
  }

  curve({ points, colour, kind = "line", dashed, faint }) {
    if (kind === "bars") return this.bars(points, colour);
    const known = (point) => point.every(Number.isFinite);
    const place = ([x, y]) => [this.across.place(x), this.up.place(y)];
    const shown = points.map((point) => (known(point) && known(place(point)) ? place(point) : null));
    if (kind === "dots") {
      return shape("g", { fill: colour }, ...shown.filter(Boolean).map(([cx, cy]) => shape("circle", { cx, cy, r: 3 })));
    }
    if (kind === "fill") {
      const outline = shown.filter(Boolean);
      if (outline.length === 0) return shape("g");
      const down = [[outline[outline.length - 1][0], this.up.start], [outline[0][0], this.up.start]];
      const corner = (point) => point.map((value) => value.toFixed(1)).join(" ");
      return shape("path", { d: `M${[...outline, ...down].map(corner).join("L")}Z`, fill: colour, class: "filled" });
    }
    let pen = "M";
    const path = shown.map((point) => {
      if (!point) { pen = "M"; return ""; }
      const [x, y] = point.map((value) => value.toFixed(1));
      const step = pen + (kind === "steps" && pen === "L" ? `${x} ${this.last}L${x} ${y}` : `${x} ${y}`);
      [pen, this.last] = ["L", y];
      return step;
    });
    return shape("path", { d: path.join(""), stroke: colour, class: faint ? "series faint" : "series", ...dashes({ dashed }) });
  }

  /** Error bars with caps; an end below a logarithmic axis is below the frame. */
  bars(points, colour) {
    const ends = (axis, value, error) => [value - error, value + error].map((end) => axis.place(axis.log ? Math.max(end, 0.1 * axis.low) : end));
    const one = ([x, y, ofX, ofY]) => {
      const [px, py] = [this.across.place(x), this.up.place(y)];
      const [[left, right], [low, high]] = [ends(this.across, x, ofX), ends(this.up, y, ofY)];
      const vertical = ofY > 0 ? `M${px} ${low}V${high}M${px - 4} ${low}h8M${px - 4} ${high}h8` : "";
      return vertical + (ofX > 0 && right - left > 1 ? `M${left} ${py}H${right}M${left} ${py - 4}v8M${right} ${py - 4}v8` : "");
    };
    const shown = points.filter((point) => point.every(Number.isFinite) && Number.isFinite(this.across.place(point[0])) && Number.isFinite(this.up.place(point[1])));
    return shape("path", { d: shown.map(one).join(""), stroke: colour, class: "series bars" });
  }

  read(event) {
    const box = this.svg.getBoundingClientRect();
    const x = ((event.clientX - box.left) / box.width) * CHART.width;
    const y = ((event.clientY - box.top) / box.height) * CHART.height;
    const { left, right, top, bottom, width, height } = CHART;
    const inside = x >= left && x <= width - right && y >= top && y <= height - bottom;
    const show = (axis, place) => si(axis.valueAt(place), axis.unit, 3);
    this.reading.textContent = inside ? `${show(this.across, x)}, ${show(this.up, y)}` : "";
  }
}
