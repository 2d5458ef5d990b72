// The page of a surface without a contact.

/** The height map. */
function heightMap({ sides, heights, span, lowest, note, mirrored, is_left: isLeft }, field = new EmbeddedField(heights)) {
  const view = new SharedView(mirrored ? [0.25, 0.25] : [0.5, 0.5], Math.min(1, 8 / Math.max(heights.nx, heights.ny)));
  const height = (value) => si(value + lowest, "m");
  const map = new FieldMap({
    title: "Height", field, colours: heights.colours, span, view, sides, reading: height, ends: (low, high) => [height(low), height(high)],
  });
  const place = make("span", {});
  const controls = make("div", { class: "controls" },
    make("button", { onclick: () => view.zoom(0.5) }, "zoom in"), make("button", { onclick: () => view.zoom(2) }, "zoom out"),
    make("button", { onclick: () => view.reset() }, "whole cell"), place);
  view.listeners.push(() => {
    const wrapped = view.cursor.map((part, axis) => si((part - Math.floor(part)) * sides[axis], "m"));
    place.textContent = `x = ${wrapped[0]}, y = ${wrapped[1]}`;
  });
  const measured = () => { Object.assign(view, { x: 0, y: 0, size: 0.5 }); view.change(); };
  if (mirrored) controls.prepend(make("button", { onclick: measured }, "measured quarter"));
  if (mirrored) measured();
  view.change();
  return make("section", {}, make("h2", {}, isLeft ? "Heights of the unloaded surface" : "Heights of the surface"), map.element, controls, make("p", { class: "quiet" }, note));
}

/** The heights of a profile, and its measured half if the rest is its mirror image. */
function profileChart({ sides, note, mirrored, lowest }, field) {
  const points = Array.from({ length: field.nx }, (_, i) => [((i + 0.5) / field.nx) * sides[0], field.at((i + 0.5) / field.nx, 0.5) + lowest]);
  const shown = (part) => ({
    x: { label: "x", unit: "m", from: 0, to: part * sides[0] }, y: { label: "height", unit: "m", from: Math.min(...points.map(([, z]) => z)) },
    series: [{ name: "", points: points.filter(([x]) => x <= part * sides[0]), colour: "var(--blue)" }],
  });
  const chart = new Chart(shown(mirrored ? 0.5 : 1));
  const button = (text, part) => make("button", { onclick: () => chart.update(shown(part)) }, text);
  const controls = mirrored ? [make("div", { class: "controls" }, button("measured half", 0.5), button("whole cell", 1))] : [];
  return make("section", {}, make("h2", {}, "Heights of the profile"), chart.element, ...controls, make("p", { class: "quiet" }, note));
}

/** The spectrum with its power law. */
function spectrumChart({ spectrum, law }) {
  const series = [{ name: "radial mean", points: spectrum, colour: "var(--blue)" }];
  if (law) series.push({ name: law[1], points: law[0], colour: "var(--red)", dashed: true });
  const chart = new Chart({ x: { label: "wavenumber q (rad/m)", log: true }, y: { label: "C(q) (m⁴)", log: true }, series });
  return make("section", {}, make("h2", {}, "Power spectral density (spectrum)"), chart.element);
}

/** The distribution of heights. */
function heightDistribution({ distribution }) {
  const { factor, unit } = scaleOf(Math.max(...distribution.map(([height]) => Math.abs(height))), "m");
  const points = distribution.map(([height, density]) => [height, density * factor]);
  const chart = new Chart({
    x: { label: "height about the mean", unit: "m", from: points[0][0] }, y: { label: `density (1/${unit})`, from: 0 },
    series: [{ name: "", points, colour: "var(--blue)" }],
  });
  return make("section", {}, make("h2", {}, "Distribution of heights"), chart.element);
}

/** The material ratio curve with the line of its core. */
function materialRatio({ material_ratio: curve, core, line }) {
  const chart = new Chart({
    x: { label: "material ratio", from: 0, to: 1 }, y: { label: "height about the mean", unit: "m", from: curve[curve.length - 1][1], to: curve[0][1] },
    series: [
      { name: "material ratio curve", points: curve, colour: "var(--blue)" },
      { name: `line of the core (${line ? "Pk" : "Sk"})`, points: core, colour: "var(--red)", dashed: true },
    ],
  });
  return make("section", {}, make("h2", {}, "Material ratio"), chart.element);
}

/** Map, statistics and charts of a surface. */
function surfaceParts(data, field) {
  const half = (...children) => make("div", { class: "columns wide" }, ...children);
  const numbers = make("section", {}, make("h2", {}, "Statistics"), table(data.lines), make("h2", {}, data.line ? "ISO 21920-2, no filter" : "ISO 25178-2, no filter"), table(data.parameters));
  return [
    half((data.line ? profileChart : heightMap)(data, field), numbers),
    half(...[data.spectrum.length > 1 && spectrumChart(data), heightDistribution(data), data.material_ratio.length > 1 && materialRatio(data)].filter(Boolean)),
  ];
}

function surfacePage(data) {
  const field = new EmbeddedField(data.heights);
  const note = "Drag, or press the arrow keys, to turn it. Heights are enlarged.";
  if (data.line) return surfaceParts(data, field);
  return [...surfaceParts(data, field), reliefView({ heights: field, sides: data.sides, colours: data.heights.colours }, note)];
}
