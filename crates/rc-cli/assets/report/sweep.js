// The page of a sweep: curves over its rows.

/** One chart: each seed a thin line, the mean over seeds of equal loads a thick one. */
function sweepChart(title, { scenes }, x, y, switches) {
  const series = scenes.flatMap(({ name, seeds, mean }, i) => {
    const colour = `var(--series-${i % 5})`;
    const pick = (rows) => rows.map((row) => [row[x.key], row[y.key]]);
    const several = seeds.length > 1;
    const thin = several ? seeds.map((rows) => ({ name: "", points: pick(rows), colour, faint: true })) : [];
    const label = several ? `${name ? `${name}: ` : ""}mean of ${seeds.length} surfaces` : name;
    if (mean.length === 0) return [...thin, { name, points: [], colour }];
    return [...thin, { name: label, points: pick(mean), colour }, { name: "", points: pick(mean), colour, kind: "dots" }];
  });
  const chart = new Chart({ x: { ...x }, y: { ...y }, series, switches });
  return make("figure", {}, make("figcaption", {}, title), chart.element);
}

function sweepPage(data) {
  const pressure = { key: "pressure", label: "mean pressure", unit: "Pa" };
  const area = { key: "area", label: "contact area A/A0" };
  const penetration = { key: "penetration", label: "penetration Δ", unit: "m" };
  const gap = { key: "gap", label: "mean gap", unit: "m" };
  const stiffness = { key: "stiffness", label: "stiffness", unit: "Pa/m" };
  const conductance = { key: "conductance", label: "conductance per conductivity (1/m)" };
  const ofBodies = { key: "of_bodies", label: "conductance (unit of the conductivity per m)" };
  const permeance = { key: "permeance", label: "permeance (m³), mean of x and y" };
  const both = ["x", "y"];
  const has = (key) => data.scenes.some(({ seeds }) => seeds.some((rows) => rows.some((row) => row[key] !== null)));
  const more = [
    has("of_bodies") && sweepChart("Conductance of the bodies against load", data, { ...pressure, log: true }, { ...ofBodies, log: true }, both),
    has("conductance") && !has("of_bodies") && sweepChart("Contact conductance against load", data, { ...pressure, log: true }, { ...conductance, log: true }, both),
    has("permeance") && sweepChart("Leakage against contact area", data, area, { ...permeance, log: true }, both),
  ].filter(Boolean);
  return [
    make("h2", {}, "Curves"),
    make("div", { class: "columns wide" },
      sweepChart("Contact area against load", data, pressure, area, both),
      sweepChart("Load against penetration", data, penetration, pressure, both),
      sweepChart("Load against mean gap", data, gap, { ...pressure, log: true }, both),
      sweepChart("Stiffness against load", data, { ...pressure, log: true }, { ...stiffness, log: true }, both), ...more),
    ...(data.percolation ? [make("p", {}, data.percolation)] : []),
    make("p", { class: "quiet" }, data.note),
    make("h2", {}, "Rows"),
    make("div", { class: "scroll" }, table(data.rows, data.heads)),
  ];
}
