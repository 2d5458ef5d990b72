// The page of a sweep: curves with their errors, contact maps of its rows, and the rows.

const N_COLOURS = 10;

/** Dashes of lines beyond the colours. */
const DASHES = [undefined, "9 4", "2 4", "12 3 2 3"];

function lineStyle(i) {
  return { colour: `var(--curve-${i % N_COLOURS})`, dashed: DASHES[Math.floor(i / N_COLOURS) % DASHES.length] };
}

/** One chart: each seed a thin line, the mean over seeds of equal loads a thick one with its errors. */
function sweepChart(title, { scenes }, x, y, more = []) {
  const series = scenes.flatMap(({ name, seeds, mean }, i) => {
    const style = lineStyle(i);
    const pick = (rows) => rows.map((row) => [row[x.key], row[y.key]]);
    const several = seeds.length > 1;
    const thin = several ? seeds.map((rows) => ({ name: "", points: pick(rows), ...style, faint: true })) : [];
    // The text below the charts says that lines of scenes are means.
    const label = several && scenes.length === 1 ? `mean of ${seeds.length} surfaces` : name;
    if (mean.length === 0) return [...thin, { name, points: [], ...style }];
    const bars = mean.map((row) => [row[x.key], row[y.key], row[`${x.key}_error`], row[`${y.key}_error`]]);
    return [
      ...thin, { name: label, points: pick(mean), ...style },
      { name: "", points: bars, ...style, kind: "bars" }, { name: "", points: pick(mean), ...style, kind: "dots" },
    ];
  });
  const chart = new Chart({ x: { ...x }, y: { ...y }, series: [...more, ...series], switches: ["x", "y"] });
  return make("figure", {}, make("figcaption", {}, title), chart.element);
}

/** Persson's area against the pressure; a line for each scene unless all have the same. */
function theorySeries({ persson }) {
  return persson.map(({ scene, points }, i) => ({
    name: i === 0 ? "Persson's theory" : "", points, dashed: "2 3",
    colour: persson.length > 1 ? lineStyle(scene).colour : "var(--ink)",
  }));
}

/** Charts against a speed or a time, which are logarithmic if the values have constant ratios. */
function chartsAgainst(data) {
  const [what, unit] = { speed: ["speed", "m/s"], time: ["time", "s"] }[data.against];
  const x = { key: what, label: what, unit, log: data.geometric };
  const has = ({ key }) => data.scenes.some(({ seeds }) => seeds.some((rows) => rows.some((row) => key in row)));
  const quantities = [
    { key: "friction", label: "friction coefficient" },
    { key: "area", label: "contact area A/A0" },
    { key: "loss-tangent", label: "maximum loss tangent of the waves" },
    { key: "gap", label: "mean gap", unit: "m" },
    { key: "penetration", label: "penetration Δ", unit: "m" },
    { key: "conductance", label: "conductance per conductivity (1/m)" },
    { key: "gas", label: "mean of 1/(gap + jump distance) (1/m)" },
    { key: "permeance", label: "permeance (m³), mean of x and y", log: true },
  ];
  const title = (label) => `${label[0].toUpperCase()}${label.slice(1)} against ${what}`;
  return quantities.filter(has).map((y) => sweepChart(title(y.label.split(/[,(]/)[0].trim()), data, x, y));
}

function sweepCharts(data) {
  if (data.against !== "pressure") return chartsAgainst(data);
  const log = data.geometric;
  const pressure = { key: "pressure", label: "mean pressure", unit: "Pa", log };
  const area = { key: "area", label: "contact area A/A0", log };
  const penetration = { key: "penetration", label: "penetration Δ", unit: "m", log };
  const gap = { key: "gap", label: "mean gap", unit: "m" };
  const stiffness = { key: "stiffness", label: "stiffness", unit: "Pa/m", log: true };
  const conductance = { key: "conductance", label: "conductance per conductivity (1/m)", log: true };
  const ofBodies = { key: "of_bodies", label: "conductance (W/(m² K) or S/m²)", log: true };
  const gas = { key: "gas", label: "mean of 1/(gap + jump distance) (1/m)", log: true };
  const permeance = { key: "permeance", label: "permeance (m³), mean of x and y", log: true };
  const friction = { key: "friction", label: "friction coefficient" };
  const logPressure = { ...pressure, log: true };
  const has = ({ key }) => data.scenes.some(({ seeds }) => seeds.some((rows) => rows.some((row) => key in row)));
  return [
    sweepChart("Contact area against load", data, pressure, area, theorySeries(data)),
    sweepChart("Load against penetration", data, penetration, pressure),
    sweepChart("Load against mean gap", data, gap, logPressure),
    sweepChart("Stiffness against load", data, logPressure, stiffness),
    ...(has(ofBodies) ? [sweepChart("Conductance of the bodies against load", data, logPressure, ofBodies)] : []),
    ...(has(conductance) && !has(ofBodies) ? [sweepChart("Contact conductance against load", data, logPressure, conductance)] : []),
    ...(has(gas) ? [sweepChart("Conductance of the gas against load", data, logPressure, gas)] : []),
    ...(has(friction) ? [sweepChart("Friction against load", data, pressure, friction)] : []),
    ...(has(permeance) ? [
      sweepChart("Leakage against load", data, logPressure, permeance),
      sweepChart("Leakage against contact area", data, { ...area, log: false }, permeance),
    ] : []),
  ];
}

/** Contact and pressure of one surface, a frame for each load. */
class FrameMaps {
  constructor({ sides, frames }, greatest, onSelect) {
    Object.assign(this, { frames, onSelect, fields: [] });
    const { pressure, contact } = this.at(0);
    const view = new SharedView([0.5, 0.5], 1 / 64);
    const percent = (value) => `${digits(100 * value, 3)} %`;
    this.contact = new FieldMap({
      title: "Contact", field: contact, colours: frames[0].contact.colours, span: [0, 1], view, sides,
      reading: percent, ends: () => ["gap", "contact"], movable: false,
    });
    this.pressure = new FieldMap({
      title: "Pressure", field: pressure, colours: frames[0].pressure.colours, span: [0, greatest], view, sides,
      reading: (value) => si(value, "Pa"), ends: (low, high) => [si(low, "Pa"), si(high, "Pa")],
    });
    this.strip = make("div", { class: "strip" }, ...frames.map((_, i) => this.thumbnail(i)));
    this.element = make("div", {}, make("div", { class: "columns wide" }, this.contact.element, this.pressure.element), this.strip);
  }

  /** The fields of frame `i`, which are decoded once. */
  at(i) {
    const { pressure, contact } = this.frames[i];
    this.fields[i] ??= { pressure: new EmbeddedField(pressure), contact: new EmbeddedField(contact) };
    return this.fields[i];
  }

  /** A small map of the pressure, which shows its frame at a click. */
  thumbnail(i) {
    const { pressure } = this.at(i);
    this.pressure.show(pressure);
    const canvas = make("canvas", { width: pressure.nx, height: pressure.ny });
    canvas.style.aspectRatio = 1 / this.pressure.shape;
    canvas.getContext("2d").drawImage(this.pressure.bitmap, 0, 0);
    return make("button", { onclick: () => this.onSelect(i), "aria-label": this.frames[i].label }, canvas, this.frames[i].load);
  }

  show(i) {
    this.contact.show(this.at(i).contact);
    this.pressure.show(this.at(i).pressure);
    [...this.strip.children].forEach((button, k) => button.setAttribute("aria-pressed", k === i));
  }
}

/** The maps with a slider over the loads, and a choice of the surface. */
function sweepFrames({ greatest, surfaces }, against) {
  const slider = document.createRange().createContextualFragment('<input type="range" min="0" value="0" step="1">').firstChild;
  slider.setAttribute("aria-label", against);
  const label = make("output", { class: "load" });
  const place = make("div");
  const choice = make("select", { "aria-label": "surface" }, ...surfaces.map(({ name }, i) => make("option", { value: i }, name)));
  let maps = null;
  const show = () => {
    maps.show(Number(slider.value));
    label.textContent = maps.frames[slider.value].label;
  };
  const select = (i) => { slider.value = i; show(); };
  const choose = () => {
    const surface = surfaces[choice.value];
    slider.max = surface.frames.length - 1;
    slider.value = Math.min(slider.value, slider.max);
    maps = new FrameMaps(surface, greatest, select);
    place.replaceChildren(maps.element);
    show();
  };
  slider.addEventListener("input", show);
  choice.addEventListener("change", choose);
  choose();
  const which = surfaces.length > 1 ? [make("label", {}, "surface ", choice)] : [];
  return [make("div", { class: "controls frames" }, ...which, make("label", { class: "loads" }, `${against} `, slider), label), place];
}

function sweepPage(data) {
  return [
    make("h2", {}, "Curves"),
    make("div", { class: "columns wide" }, ...sweepCharts(data)),
    ...data.sealing.map((line) => make("p", {}, line)),
    make("p", { class: "quiet" }, data.note),
    make("h2", {}, data.against === "pressure" ? "Contact under each load" : `Contact at each ${data.against}`),
    ...(data.frames ? sweepFrames(data.frames, data.against === "pressure" ? "load" : data.against) : []),
    make("p", { class: "quiet" }, data.frames_note),
    ...(data.means ? [make("h2", {}, "Means over the surfaces, with standard errors"), make("div", { class: "scroll" }, table(data.means.rows, data.means.heads))] : []),
    make("h2", {}, "Rows"),
    make("div", { class: "scroll" }, table(data.rows, data.heads)),
  ];
}
