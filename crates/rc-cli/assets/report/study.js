// The page of a study: how much each result depends on the treatment of the map.

/** A result against the load, with the error of the mesh and the range of the treatments. */
function rangeChart({ result, unit, points }) {
  const colour = "var(--series-0)";
  const pick = (key) => points.map((point) => [point.pressure, point[key]]);
  const bar = ({ pressure, value, error }) => ({ name: "", points: [[pressure, value - error], [pressure, value + error]], colour });
  const series = [
    { name: "treatment_low, treatment_high", points: pick("low"), colour: "var(--series-1)", dashed: true },
    { name: "", points: pick("high"), colour: "var(--series-1)", dashed: true },
    { name: "as prepared, with the mesh bar", points: pick("value"), colour },
    { name: "", points: pick("value"), colour, kind: "dots" },
    ...["low", "high"].map((key) => ({ name: "", points: pick(key), colour: "var(--series-1)", kind: "dots" })),
    ...points.map(bar),
  ];
  const chart = new Chart({ x: { label: "mean pressure", unit: "Pa", log: true }, y: { label: result, unit }, series, switches: ["x", "y"] });
  return make("figure", {}, make("figcaption", {}, result), chart.element);
}

/** The contact under the largest load, for the treatments with the extreme areas. */
function contactPictures(pictures) {
  if (pictures.length === 0) return [];
  const figure = ({ png, note }) => make("figure", {}, make("img", { src: `data:image/png;base64,${png}`, alt: `Contact, ${note}`, style: "width: 100%" }), make("figcaption", {}, note));
  return [make("h2", {}, "Contact under the largest load"), make("div", { class: "columns" }, ...pictures.map(figure))];
}

function studyPage(data) {
  const loads = data.loads.flatMap(({ name, rows }) => [
    make("h3", {}, `mean pressure ${name}`),
    make("div", { class: "scroll" }, table(rows, data.heads)),
  ]);
  return [
    make("h2", {}, "Ranges"),
    ...loads,
    ...contactPictures(data.pictures),
    make("div", { class: "columns wide" }, ...data.charts.map(rangeChart)),
    make("p", { class: "quiet" }, data.note),
    make("h2", {}, "Rows"),
    make("div", { class: "scroll" }, table(data.rows, data.row_heads)),
  ];
}
