// The page of a surface without a contact.

/** The height map. */
function heightMap({ sides, heights, span, lowest, note }) {
  const field = new EmbeddedField(heights);
  const view = new SharedView([0.5, 0.5], Math.min(1, 8 / Math.max(heights.nx, heights.ny)));
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
  view.change();
  return make("section", {}, make("h2", {}, "Heights"), map.element, controls, make("p", { class: "quiet" }, note));
}

/** The spectrum with its power law. */
function spectrumChart({ spectrum, law }) {
  const series = [{ name: "radial mean", points: spectrum, colour: "var(--blue)" }];
  if (law) series.push({ name: law[1], points: law[0], colour: "var(--red)", dashed: true });
  const chart = new Chart({ x: { label: "wavenumber q (rad/m)", log: true }, y: { label: "C(q) (m⁴)", log: true }, series });
  return make("section", {}, make("h2", {}, "Power spectral density"), chart.element);
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

function surfacePage(data) {
  const half = (...children) => make("div", { class: "columns wide" }, ...children);
  const numbers = make("section", {}, make("h2", {}, "Statistics"), table(data.lines), make("h2", {}, "ISO 25178-2, no filter"), table(data.parameters));
  return [
    half(heightMap(data), numbers),
    half(...[data.spectrum.length > 1 && spectrumChart(data), heightDistribution(data)].filter(Boolean)),
  ];
}
