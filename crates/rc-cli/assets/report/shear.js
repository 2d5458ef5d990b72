// The page of shear curves.

function shearPage({ curves, heads, rows, note }) {
  const series = (key, pick = (point) => point) => curves.map((curve, i) => ({ name: curve.name, points: curve[key].map(pick), ...lineStyle(i) }));
  const bars = curves.map(({ shear }, i) => ({ name: "", points: shear.map(([d, tau, error]) => [d, tau, error, 0]), ...lineStyle(i), kind: "bars" }));
  const chart = (title, axes, lines, switches = ["x", "y"]) => make("figure", {}, make("figcaption", {}, title), new Chart({ ...axes, series: lines, switches }).element);
  const part = (log) => ({ label: "shear over that of sliding", log, ...(log ? {} : { from: 0, to: 1 }) });
  const displacement = { label: "displacement", unit: "m" };
  const shear = { label: "shear per nominal area", unit: "Pa" };
  const loops = series("hysteresis");
  const largest = (i) => loops.flatMap(({ points }) => points).reduce((most, point) => Math.max(most, Math.abs(point[i])), 0) * 1.05;
  const around = (axis, i) => ({ ...axis, from: -largest(i), to: largest(i) });
  return [
    make("h2", {}, "Curves"),
    make("div", { class: "columns wide" },
      chart("Shear against displacement", { x: displacement, y: shear }, [...bars, ...series("shear", ([d, tau]) => [d, tau])]),
      chart("Loop of a cycle", { x: around(displacement, 0), y: around(shear, 1) }, loops, []),
      chart("Part of the contact that slips", { x: part(false), y: { label: "slip area over contact area", from: 0, to: 1 } }, series("slip")),
      chart("Loss factor against amplitude", { x: part(true), y: { label: "loss factor", log: true } }, series("loss")),
      chart("Loss of a cycle against amplitude", { x: part(true), y: { label: "loss per nominal area (J/m²)", log: true } }, series("energy"))),
    make("h2", {}, "Table"),
    make("div", { class: "scroll" }, table(rows, heads)),
    make("p", { class: "quiet" }, note),
  ];
}
