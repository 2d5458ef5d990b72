// Sections through both bodies: the rigid rough surface at its penetration, and the elastic surface above it.

const AXES = { x: { other: "y", across: 0, along: 1 }, y: { other: "x", across: 1, along: 0 } };

/** The section along `axis` through the place `part` of the other coordinate, from the pixels of the maps. */
function sectionOfPixels(axis, part, { heights, gap, pressure }, { sides, level }) {
  const n = axis === "x" ? gap.nx : gap.ny;
  const at = (field, along) => (axis === "x" ? field.at(along, part) : field.at(part, along));
  const points = Array.from({ length: n }, (_, i) => {
    const along = (i + 0.5) / n;
    const rigid = at(heights, along) + level;
    return [along * sides[AXES[axis].across], rigid, rigid + at(gap, along)];
  });
  const contact = points.map((_, i) => at(pressure, (i + 0.5) / n) > 0);
  return { axis, at: (part - Math.floor(part)) * sides[AXES[axis].along], points, contact };
}

/** The chart of a section, with the elastic body above and the rigid body below. */
function bodyChart({ axis, points, contact }, side) {
  const values = points.flatMap(([, rigid, elastic]) => [rigid, elastic]);
  const [low, high] = [values.reduce((a, b) => Math.min(a, b)), values.reduce((a, b) => Math.max(a, b))];
  const room = 0.06 * (high - low) || 1e-9;
  const rigid = points.map(([x, z]) => [x, z]);
  return {
    x: { label: axis, unit: "m", from: 0, to: side },
    y: { label: "height", unit: "m", from: low - room, to: high + room },
    series: [
      { name: "", points: rigid, colour: "var(--quiet)", kind: "fill" },
      { name: "rigid rough surface", points: rigid, colour: "var(--ink)" },
      { name: "elastic surface", points: points.map(([x, , z]) => [x, z]), colour: "var(--blue)" },
      { name: "contact", points: rigid.filter((_, i) => contact[i]), colour: "var(--red)", kind: "dots" },
    ],
  };
}

/** One section, with a slider for its place. */
function bodySection(exact, fields, place, view) {
  const { axis } = exact;
  const [side, length] = [place.sides[AXES[axis].across], place.sides[AXES[axis].along]];
  const n = axis === "x" ? fields.gap.ny : fields.gap.nx;
  const caption = make("figcaption", {});
  const chart = new Chart(bodyChart(exact, side));
  const slider = make("input", { type: "range", min: 0, max: n - 1, value: Math.floor((exact.at / length) * n), "aria-label": `place of the section along ${axis}` });
  const show = (section, where) => {
    caption.textContent = `Along ${axis} at ${AXES[axis].other} = ${si(section.at, "m")}${where}`;
    chart.update(bodyChart(section, side));
  };
  const through = (part) => show(sectionOfPixels(axis, part, fields, place), "");
  const peak = () => {
    slider.value = Math.floor((exact.at / length) * n);
    show(exact, ", through the maximum pressure");
  };
  slider.addEventListener("input", () => through((Number(slider.value) + 0.5) / n));
  let held = false;
  view.listeners.push(() => {
    if (!view.pinned && !held) return;
    held = view.pinned;
    if (!held) { peak(); return; }
    const part = view.cursor[AXES[axis].along];
    slider.value = Math.floor((part - Math.floor(part)) * n);
    through(part);
  });
  peak();
  const controls = make("div", { class: "controls" }, make("label", {}, `${AXES[axis].other} `, slider), make("button", { onclick: peak }, "maximum pressure"));
  return make("figure", {}, caption, chart.element, controls);
}

/** Sections along x and y. Those through the maximum pressure are exact; the others are of the pixels of the maps. */
function bodySections(surface, fields, view, sides) {
  const place = { sides, level: surface.lowest + surface.shift };
  const charts = surface.sections.map((exact) => bodySection(exact, fields, place, view));
  const note = "Heights are from the undeformed elastic surface, and enlarged against x and y. The first sections go through the maximum "
    + "pressure, with at most 1000 points where the gap is smallest. A slider, or a click in a map, chooses other sections, of the pixels "
    + "of the maps." + (surface.of_blocks ? " Heights are means over blocks (output_grid), and touched blocks are called contact." : "");
  return make("section", {}, make("h2", {}, "Section through both bodies"), make("div", { class: "columns wide" }, ...charts), make("p", { class: "quiet" }, note));
}

/** Both bodies of the contact of a profile. */
function bodyOfLine(section, side) {
  const note = "Heights are from the undeformed elastic surface, and enlarged against x. At most 1000 points are shown, where the gap is smallest.";
  return make("section", {}, make("h2", {}, "Both bodies"), make("div", { class: "columns wide" }, new Chart(bodyChart(section, side)).element, make("div", {})), make("p", { class: "quiet" }, note));
}
