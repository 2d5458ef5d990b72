// The page of a mean over realisations: means with error bars, and what each level has.

function figure(title, options) {
  return make("figure", {}, make("figcaption", {}, title), new Chart(options).element);
}

/** Means against the load; each error bar is a line of its own. */
function meanChart({ means, load, quantity }) {
  const colour = "var(--series-0)";
  const bar = ({ load: x, mean, error }) => ({ name: "", points: [[x, mean - error], [x, mean + error]], colour });
  const points = means.map((one) => [one.load, one.mean]);
  const lines = [{ name: "", points, colour, faint: true }, { name: "", points, colour, kind: "dots" }];
  return figure("Mean with its error, against the load",
    { x: { ...load }, y: { ...quantity }, series: [...lines, ...means.map(bar)], switches: ["x", "y"] });
}

/** What each level has, against its grid. */
function levelChart(title, { means }, key, label) {
  const series = means.map((one, i) => ({
    name: means.length > 1 && means.length <= 8 ? one.name : "",
    points: one.grids.map((grid, level) => [grid, one[key][level]]),
    colour: `var(--series-${i % 5})`,
  }));
  const dots = series.map((one) => ({ ...one, name: "", kind: "dots" }));
  const x = { label: "finer grid of the level: elements per side", log: true };
  return figure(title, { x, y: { label, log: true }, series: [...series, ...dots] });
}

function meanPage(data) {
  const levels = data.means.flatMap(({ name, levels }) => [
    make("h3", {}, `${data.load.label} ${name}`),
    make("div", { class: "scroll" }, table(levels, data.level_heads)),
  ]);
  return [
    make("h2", {}, "Means"),
    make("div", { class: "scroll" }, table(data.rows, data.heads)),
    make("div", { class: "columns wide" },
      ...(data.means.length > 1 ? [meanChart(data)] : []),
      levelChart("Variance of the levels", data, "variances", `variance (${data.quantity.unit ? `${data.quantity.unit}²` : "1"})`),
      levelChart("Cost of a realisation", data, "costs", "elements times applications")),
    make("p", { class: "quiet" }, data.note),
    make("h2", {}, "Levels"),
    ...levels,
  ];
}
