// The page of one solved contact.

const RELIEF_NOTE = "The heights of the rigid surface, enlarged. Contact has the colours of the map of the pressure. Drag, or press the arrow keys, to turn it.";

/** The maps, and the sections through their cursor. */
function mapsAndSections({ sides, pressure, gap, contact, slip, of_elements: ofElements, peak, averaged }, surface, direction) {
  const fields = { pressure: new EmbeddedField(pressure), gap: new EmbeddedField(gap), contact: new EmbeddedField(contact) };
  if (surface) fields.heights = new EmbeddedField(surface.heights);
  const view = new SharedView(peak, Math.min(1, 8 / Math.max(pressure.nx, pressure.ny)));
  const map = (title, name, colours, unit) => new FieldMap({
    title, field: fields[name], colours, view, sides, ends: (low, high) => [low > 0 ? si(low, unit, 4) : "0", si(high, unit, 4)], reading: (value) => si(value, unit),
  });
  const touching = ofElements ? "contact" : "touched";
  const contactMap = new FieldMap({
    title: ofElements ? "Contact" : "Touched", field: fields.contact, colours: contact.colours, view, sides, ends: () => ["gap", touching], movable: false,
    reading: (value) => (value === 0 ? "gap" : value === 1 ? touching : `${digits(100 * value, 3)} % ${touching}`),
  });
  contactMap.arrow = direction;
  const maps = [contactMap, map("Pressure", "pressure", pressure.colours, "Pa"), map("Gap", "gap", gap.colours, "m")];
  if (slip) {
    const [field, shear] = slip;
    const slipMap = new FieldMap({
      title: "Stick and slip", field: new EmbeddedField(field), colours: field.colours, view, sides, ends: () => ["gap, slip", "stick"], movable: false,
      reading: (value) => (value === 0 ? "gap" : value < 0.7 ? "slip" : "stick"),
    });
    slipMap.arrow = shear;
    maps.push(slipMap);
  }
  const place = make("span", {});
  const sections = sectionCharts(fields, view, sides);
  const along = (text, axis) => make("button", {
    "aria-pressed": axis === "x",
    onclick: (event) => {
      for (const other of event.target.parentNode.querySelectorAll("[aria-pressed]")) other.setAttribute("aria-pressed", other === event.target);
      sections.axis = axis;
      sections.refresh();
    },
  }, text);
  const controls = make("div", { class: "controls" },
    make("button", { onclick: () => view.zoom(0.5) }, "zoom in"), make("button", { onclick: () => view.zoom(2) }, "zoom out"),
    make("button", { onclick: () => view.reset() }, "whole cell"),
    make("span", {}, along("section along x", "x"), " ", along("along y", "y")), place);
  view.listeners.push(() => {
    const wrapped = view.cursor.map((part, axis) => si((part - Math.floor(part)) * sides[axis], "m"));
    place.textContent = `x = ${wrapped[0]}, y = ${wrapped[1]}${view.pinned ? " (held; click to release)" : ""}`;
  });
  view.change();
  const sheared = slip ? "The arrow is the direction of the shear; dark contact sticks, lighter contact slips. " : "";
  const slides = direction ? "The arrow is the direction in which the surface slides. " : "";
  const help = "The wheel zooms, and dragging moves. A click holds the cursor, arrow keys move it, + and − zoom. ";
  return [
    make("h2", {}, "Maps"),
    make("div", { class: "columns" }, ...maps.map((one) => one.element)),
    controls,
    make("p", { class: "quiet" }, slides + sheared + help + averaged),
    make("h2", {}, "Section through the cursor"),
    make("div", { class: "columns wide" }, sections.pressure.element, sections.gap.element),
    ...(surface && surface.sections.length > 0 ? [bodySections(surface, fields, view, sides)] : []),
    ...(surface ? [reliefView({ heights: fields.heights, sides, pressure: fields.pressure, colours: pressure.colours }, RELIEF_NOTE), ...surfaceParts(surface, fields.heights)] : []),
  ];
}

/** Pressure and gap of the contact of a profile, with both bodies. */
function lineCharts({ sides, pressure, gap, peak, averaged }, surface) {
  const fields = { pressure: new EmbeddedField(pressure), gap: new EmbeddedField(gap) };
  if (surface) fields.heights = new EmbeddedField(surface.heights);
  const view = new SharedView(peak, Math.min(1, 8 / pressure.nx));
  const sections = sectionCharts(fields, view, sides);
  const controls = make("div", { class: "controls" },
    make("button", { onclick: () => view.zoom(0.5) }, "zoom in on the maximum pressure"), make("button", { onclick: () => view.zoom(2) }, "zoom out"),
    make("button", { onclick: () => view.reset() }, "whole cell"));
  return [
    make("h2", {}, "Pressure and gap along the profile"),
    make("div", { class: "columns wide" }, sections.pressure.element, sections.gap.element),
    controls,
    make("p", { class: "quiet" }, averaged),
    ...(surface && surface.sections.length > 0 ? [bodyOfLine(surface.sections[0], sides[0])] : []),
    ...(surface ? surfaceParts(surface, fields.heights) : []),
  ];
}

/** Pressure and gap along a line through the cursor, over the visible part of the cell. */
function sectionCharts(fields, view, sides) {
  const charts = { axis: "x" };
  const side = () => sides[charts.axis === "x" ? 0 : 1];
  const points = (field, axis) => {
    const n = axis === "x" ? field.nx : field.ny;
    const start = axis === "x" ? view.x : view.y;
    const first = Math.ceil(start * n - 0.5);
    const count = Math.max(2, Math.round(view.size * n));
    return Array.from({ length: count }, (_, i) => {
      const part = (first + i + 0.5) / n;
      return [part * side(), axis === "x" ? field.at(part, view.cursor[1]) : field.at(view.cursor[0], part)];
    });
  };
  const options = (name, unit, colour) => {
    const start = charts.axis === "x" ? view.x : view.y;
    return {
      x: { label: charts.axis, unit: "m", from: start * side(), to: (start + view.size) * side() },
      y: { label: name, unit, from: fields[name].low },
      series: [{ name: "", points: points(fields[name], charts.axis), colour }],
    };
  };
  charts.pressure = new Chart(options("pressure", "Pa", "var(--red)"));
  charts.gap = new Chart(options("gap", "m", "var(--blue)"));
  charts.refresh = () => {
    charts.pressure.update(options("pressure", "Pa", "var(--red)"));
    charts.gap.update(options("gap", "m", "var(--blue)"));
  };
  view.listeners.push(charts.refresh);
  return charts;
}

/** P(σ) with the fit of Eq. 7. */
function stressDistribution({ values: stress, density, fit, notes }) {
  const { factor, unit } = scaleOf(stress[stress.length - 1], "Pa");
  // In full contact, what there is to see is far from zero.
  const full = stress[0] > 0.5 * stress[stress.length - 1];
  const points = (of) => stress.map((s, i) => [s, of[i] * factor]);
  const series = [{ name: "solved", points: points(density), colour: "var(--blue)" }];
  if (fit) series.push({ name: "Persson's form, fitted", points: points(fit), colour: "var(--red)", dashed: true });
  const chart = new Chart({
    x: { label: "stress σ", unit: "Pa", from: full ? stress[0] : undefined }, y: { label: `P(σ) (1/${unit})` }, series, switches: ["x", "y"],
  });
  return make("section", {}, make("h2", {}, "Stress distribution"), chart.element, ...notes.map((text) => make("p", { class: "quiet" }, text)));
}

/** Contact spots by size. */
function contactSpots({ rows, diameters, counts, size, note }) {
  const steps = diameters.map((edge, i) => [edge, i < counts.length ? counts[i] : 0]);
  const chart = new Chart({
    x: { label: size, unit: "m", log: true, from: diameters[0], to: diameters[diameters.length - 1] },
    y: { label: "spots", from: 0 },
    series: [{ name: "", points: [[diameters[0], 0], ...steps], colour: "var(--blue)", kind: "steps" }],
  });
  return make("section", {}, make("h2", {}, "Contact spots"), chart.element, table(rows), make("p", { class: "quiet" }, note));
}

/** The certificate: each error beside what it may be. */
function certificate({ rows, note }) {
  const line = ({ name, value, limit, holds }) => [name, value, limit, [holds === false ? "bad" : "good", { true: "holds", false: "exceeded" }[holds] || ""]];
  return make("section", {}, make("h2", {}, "Certificate"), make("div", { class: "scroll" }, table(rows.map(line), ["", "error", "limit", ""])), make("p", { class: "quiet" }, note));
}

/** The picture of the flow through the gap. */
function leakagePicture({ png, note }) {
  const picture = make("img", { src: `data:image/png;base64,${png}`, alt: "flow through the gap", style: "max-width: 100%" });
  return make("section", {}, make("h2", {}, "Leakage"), picture, make("p", { class: "quiet" }, note));
}

function resultPage(data) {
  const half = (...children) => make("div", { class: "columns wide" }, ...children);
  return [
    ...(data.kappa ? [make("p", {}, data.kappa)] : []),
    ...(data.maps.line ? lineCharts : mapsAndSections)(data.maps, data.surface, data.direction),
    ...(data.no_surface ? [make("p", { class: "quiet" }, `The surface is not shown: ${data.no_surface}`)] : []),
    half(...[data.stress && stressDistribution(data.stress), data.spots && contactSpots(data.spots)].filter(Boolean)),
    ...[data.leakage && half(leakagePicture(data.leakage))].filter(Boolean),
    half(certificate(data.certificate), make("section", {}, make("h2", {}, "Result"), table(data.lines))),
  ];
}
